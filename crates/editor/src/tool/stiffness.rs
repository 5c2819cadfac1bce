//! A stroke of the stiffness brush: towards a value, towards the neighbours, rigid, or back to 1.
//!
//! Stiffness spans six decades, so everything is blended in its logarithm. Within one stroke only the firmest dab
//! changes a vertex: a second pass over the same place without letting go adds nothing, and a stroke does not depend on
//! the number of the pointer's events. Only smoothing accumulates.

use glam::DVec2;
use pliant_mesh::{SurfaceVertex, Topology};

use super::context::Context;
use super::stiffness_brush::{StiffnessAction, StiffnessBrush};
use super::stroke::{Stroke, StrokeGesture, firmest};
use crate::STIFFNESS_RANGE;
use crate::document::Document;
use crate::input::Pointer;
use crate::workspace::Workspace;

/// The stroke's action.
#[derive(Debug)]
pub(super) struct StiffnessStroke {
    brush: StiffnessBrush,
    /// The firmest dab on each vertex in this stroke.
    firmest: Vec<f32>,
}

impl StiffnessStroke {
    pub fn begin(context: &mut Context<'_>, pointer: Pointer) -> StrokeGesture<Self> {
        let mut brush = context.settings.stiffness_brush;
        if pointer.modifiers.ctrl {
            brush.action = StiffnessAction::Erase;
        } else if pointer.modifiers.shift {
            brush.action = StiffnessAction::Smooth;
        }
        if brush.action == StiffnessAction::Rigid {
            // A vertex is rigid or not: there is nothing between.
            (brush.strength, brush.falloff) = (1.0, 0.0);
        }
        let transaction = context.workspace.begin_stroke(match brush.action {
            StiffnessAction::Paint => "Paint stiffness",
            StiffnessAction::Rigid => "Paint rigid",
            StiffnessAction::Smooth => "Smooth stiffness",
            StiffnessAction::Erase => "Erase stiffness",
        });
        let stroke = Self {
            brush,
            firmest: vec![0.0; context.workspace.document.paint().len()],
        };
        StrokeGesture::begin(context, transaction, stroke, pointer)
    }
}

impl Stroke for StiffnessStroke {
    fn doing(&self, _: &Workspace) -> String {
        match self.brush.action {
            StiffnessAction::Rigid => "Painting rigid parts".to_owned(),
            _ => "Painting stiffness".to_owned(),
        }
    }

    fn dab(&mut self, context: &mut Context<'_>, before: &Document, way_px: [DVec2; 2]) {
        let pressure = match self.brush.action {
            StiffnessAction::Rigid => 1.0,
            _ => context.settings.pressure.unwrap_or(1.0),
        };
        let (brush, strength) = (self.brush, self.brush.strength * pressure);
        let met = firmest(context, way_px, |share| strength * brush.firmness(share));
        if met.is_empty() {
            return;
        }
        let workspace = &mut *context.workspace;
        // The present shape was made with another stiffness; it is kept, like in every stroke.
        workspace.document.keep_shape();
        if self.brush.action == StiffnessAction::Smooth {
            if let Some(model) = workspace.model().cloned() {
                workspace.document.stiffen(|field| smooth(met, field, &model.topology));
            }
            return;
        }
        let before = before.stiffness();
        let goal = match self.brush.action {
            StiffnessAction::Erase => 1.0,
            StiffnessAction::Rigid => f64::INFINITY,
            StiffnessAction::Paint | StiffnessAction::Smooth => self.brush.value,
        };
        let firmest = &mut self.firmest;
        workspace.document.stiffen(|field| {
            let mut changed = Vec::new();
            for (vertex, firmness) in met {
                let firmest = &mut firmest[vertex.index()];
                if firmness as f32 <= *firmest {
                    continue;
                }
                *firmest = firmness as f32;
                changed.push(vertex);
                let start = finite(before.map_or(1.0, |field| field[vertex.index()]));
                field[vertex.index()] = if firmness >= 1.0 {
                    goal
                } else {
                    in_range((start.ln() + (goal.ln() - start.ln()) * firmness).exp())
                };
            }
            changed
        });
    }

    fn finish(&mut self, workspace: &mut Workspace, before: &Document) {
        workspace.document.drop_plain_stiffness(before);
    }
}

/// Moves vertices' values towards the mean of their neighbours, by their firmness in the dab; returns them.
fn smooth(met: Vec<(SurfaceVertex, f64)>, field: &mut [f64], topology: &Topology) -> Vec<SurfaceVertex> {
    // Every new value comes from old ones, independent of the order of the vertices.
    let smoothed = met.iter().map(|&(vertex, firmness)| {
        if field[vertex.index()] == f64::INFINITY {
            return f64::INFINITY;
        }
        let own = field[vertex.index()].ln();
        let neighbours = topology.neighbours(vertex);
        let sum: f64 = neighbours.iter().map(|v| finite(field[v.index()]).ln()).sum();
        let mean = if neighbours.is_empty() {
            own
        } else {
            sum / neighbours.len() as f64
        };
        in_range((own + (mean - own) * firmness).exp())
    });
    let smoothed: Vec<f64> = smoothed.collect();
    for ((vertex, _), value) in met.iter().zip(smoothed) {
        field[vertex.index()] = value;
    }
    met.into_iter().map(|(vertex, _)| vertex).collect()
}

/// The value of a stiffness in a blend: rigid counts as the stiffest.
fn finite(value: f64) -> f64 {
    value.min(*STIFFNESS_RANGE.end())
}

fn in_range(value: f64) -> f64 {
    value.clamp(*STIFFNESS_RANGE.start(), *STIFFNESS_RANGE.end())
}
