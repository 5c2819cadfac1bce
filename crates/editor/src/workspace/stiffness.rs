//! Actions on painted stiffness as a whole: set, clear, blur, sharpen, grow, shrink.
//!
//! Stiffness spans six decades, so it is blurred in its logarithm. Rigid vertices stay rigid, and count as the stiffest
//! for their neighbours.

use pliant_mesh::{Model, SurfaceVertex};
use rayon::prelude::*;

use super::state::Workspace;
use crate::STIFFNESS_RANGE;

/// An action on the whole field.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Hash)]
pub enum StiffnessChange {
    /// Moves every vertex' value towards its neighbours'.
    Blur,
    /// Moves every vertex' value away from its neighbours'.
    Sharpen,
    /// Grows the painted part by the vertices around it.
    Grow,
    /// Shrinks the painted part by the vertices at its border.
    Shrink,
}

/// The number of blurs of vertices and their neighbours in one action.
const ROUNDS: usize = 4;

/// Changes the whole field in one step.
pub(crate) fn change_stiffness(workspace: &mut Workspace, change: StiffnessChange) {
    let (Some(model), Some(field)) = (workspace.model().cloned(), workspace.document.stiffness()) else {
        return;
    };
    let changed: Vec<f64> = match change {
        StiffnessChange::Blur => blurred(&model, field),
        StiffnessChange::Sharpen => {
            let sharp = |(own, soft): (&f64, f64)| if own.is_finite() { own * (own / soft) } else { *own };
            field.iter().zip(blurred(&model, field)).map(sharp).collect()
        }
        StiffnessChange::Grow => by_neighbours(&model, field, |own, other| other.ln().abs() > own.ln().abs()),
        StiffnessChange::Shrink => by_neighbours(&model, field, |own, other| other.ln().abs() < own.ln().abs()),
    };
    let in_range = |value: f64| match value {
        f64::INFINITY => value,
        _ => value.clamp(*STIFFNESS_RANGE.start(), *STIFFNESS_RANGE.end()),
    };
    let access = &workspace.vertex_access;
    let put = changed.iter().zip(field).enumerate();
    let put = put.map(|(vertex, (value, own))| {
        if access.may_be_painted(vertex) {
            in_range(*value)
        } else {
            *own
        }
    });
    let field = put.collect();
    put_stiffness(
        workspace,
        match change {
            StiffnessChange::Blur => "Blur stiffness",
            StiffnessChange::Sharpen => "Sharpen stiffness",
            StiffnessChange::Grow => "Grow stiffness",
            StiffnessChange::Shrink => "Shrink stiffness",
        },
        field,
    );
}

/// The field with every vertex halfway towards the mean of its neighbours, several times.
fn blurred(model: &Model, field: &[f64]) -> Vec<f64> {
    let most = STIFFNESS_RANGE.end().ln();
    let mut field: Vec<f64> = field.iter().map(|stiffness| stiffness.ln()).collect();
    for _ in 0..ROUNDS {
        let next = |vertex: usize| {
            let own = field[vertex];
            let neighbours = model.topology.neighbours(SurfaceVertex(vertex as u32));
            if neighbours.is_empty() || own == f64::INFINITY {
                return own;
            }
            let sum: f64 = neighbours.iter().map(|other| field[other.index()].min(most)).sum();
            0.5 * (own + sum / neighbours.len() as f64)
        };
        field = (0..field.len()).into_par_iter().map(next).collect();
    }
    field.into_iter().map(f64::exp).collect()
}

/// The field in which every vertex has the best value among its own and its neighbours'.
fn by_neighbours(model: &Model, field: &[f64], is_better: impl Fn(f64, f64) -> bool + Sync) -> Vec<f64> {
    let best = |vertex: usize| {
        let neighbours = model.topology.neighbours(SurfaceVertex(vertex as u32)).iter();
        let others = neighbours.map(|other| field[other.index()]);
        others.fold(
            field[vertex],
            |own, other| if is_better(own, other) { other } else { own },
        )
    };
    (0..field.len()).into_par_iter().map(best).collect()
}

/// Sets the stiffness of every vertex.
pub(crate) fn set_stiffness(workspace: &mut Workspace, field: Vec<f64>) {
    let count = workspace.document.paint().len();
    let is_allowed = |stiffness: &&f64| STIFFNESS_RANGE.contains(*stiffness) || **stiffness == f64::INFINITY;
    let bad = field.iter().find(|stiffness| !is_allowed(stiffness));
    if field.len() != count {
        workspace.refuse(format!(
            "The stiffness has {} values for {count} vertices: give one for each.",
            field.len()
        ));
    } else if let Some(bad) = bad {
        let (low, high) = (STIFFNESS_RANGE.start(), STIFFNESS_RANGE.end());
        workspace.refuse(format!(
            "The stiffness {bad} is out of range: paint {low} to {high}, or rigid."
        ));
    } else {
        put_stiffness(workspace, "Change stiffness", field);
    }
}

fn put_stiffness(workspace: &mut Workspace, name: &str, field: Vec<f64>) {
    let field = field.iter().any(|&stiffness| stiffness != 1.0).then_some(field);
    workspace.change(name, |document| {
        if document.stiffness() != field.as_deref() {
            document.unsettle_if_displaced();
            document.set_stiffness(field);
        }
    });
}

/// Makes the stiffness of the whole surface even.
pub(crate) fn clear_stiffness(workspace: &mut Workspace) {
    workspace.change("Clear stiffness", |document| {
        document.unsettle_if_displaced();
        document.set_stiffness(None);
    });
}
