//! A stroke of the stiffness brush: towards a value, towards the neighbours, rigid, or back to 1.
//!
//! Stiffness spans six decades, so everything is blended in its logarithm. Within one stroke a vertex is changed as far
//! as by its firmest dab: going over the same place again without letting go adds nothing, and a stroke does not depend
//! on how many events the pointer sent. Only smoothing accumulates.

use glam::DVec2;
use pliant_mesh::{SurfaceVertex, Topology};

use super::context::Context;
use super::gesture::{Gesture, Next};
use super::overlay::Lit;
use super::stiffness_brush::{StiffnessAction, StiffnessBrush};
use crate::STIFFNESS_RANGE;
use crate::document::Transaction;
use crate::input::{Button, Pointer};
use crate::jobs::Activity;
use crate::scene_view::Cursor;
use crate::view::View;
use crate::workspace::Workspace;

/// A stroke that goes on.
#[derive(Debug)]
pub(crate) struct StiffnessStroke {
    transaction: Transaction,
    brush: StiffnessBrush,
    last_px: DVec2,
    /// The firmest that met each vertex in this stroke.
    firmest: Vec<f32>,
}

impl StiffnessStroke {
    pub(super) fn begin(context: &mut Context<'_>, pointer: Pointer) -> Self {
        let mut brush = context.settings.stiffness_brush;
        if pointer.modifiers.ctrl {
            brush.action = StiffnessAction::Erase;
        } else if pointer.modifiers.shift {
            brush.action = StiffnessAction::Smooth;
        }
        if brush.action == StiffnessAction::Rigid {
            // Rigid or not: there is nothing between.
            (brush.strength, brush.falloff) = (1.0, 0.0);
        }
        let transaction = context.workspace.begin_stroke(match brush.action {
            StiffnessAction::Paint => "Paint stiffness",
            StiffnessAction::Rigid => "Paint rigid",
            StiffnessAction::Smooth => "Smooth stiffness",
            StiffnessAction::Erase => "Erase stiffness",
        });
        let mut stroke = Self {
            transaction,
            brush,
            last_px: pointer.position_px,
            firmest: vec![0.0; context.workspace.document.paint().len()],
        };
        stroke.dab(context, pointer.position_px);
        stroke
    }

    fn dab(&mut self, context: &mut Context<'_>, to_px: DVec2) {
        let pressure = match self.brush.action {
            StiffnessAction::Rigid => 1.0,
            _ => context.settings.pressure.unwrap_or(1.0),
        };
        let strength = self.brush.strength * pressure;
        let mut met: Vec<(SurfaceVertex, f64)> = Vec::new();
        if let Some(picking) = context.workspace.picking(context.view) {
            let firmness = |share| strength * self.brush.firmness(share);
            let size = &context.settings.brush;
            context
                .brush
                .stroke(&picking, self.last_px, to_px, size, |vertex, share| {
                    met.push((vertex, firmness(share)));
                });
        }
        self.last_px = to_px;
        let workspace = &mut *context.workspace;
        if let Some(sides) = workspace.both_sides() {
            met.extend(sides.opposite_with(&met));
        }
        met.retain(|(vertex, _)| workspace.vertex_access.may_be_painted(vertex.index()));
        if met.is_empty() {
            return;
        }
        // The present shape was made with another stiffness; it is kept, as with every stroke.
        workspace.document.keep_shape();
        if self.brush.action == StiffnessAction::Smooth {
            if let Some(model) = workspace.model().cloned() {
                workspace.document.stiffen(|field| smooth(met, field, &model.topology));
            }
            return;
        }
        let before = self.transaction.before().stiffness();
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
}

impl Gesture for StiffnessStroke {
    fn activity(&self) -> Activity {
        Activity::Painting
    }

    fn cursor(&self) -> Cursor {
        Cursor::Brush
    }

    fn lit(&self) -> Lit {
        Lit::Ring
    }

    fn status(&self, _: &Workspace, _: &View) -> Option<String> {
        Some(match self.brush.action {
            StiffnessAction::Rigid => "Painting what moves as one body: Esc takes it back".to_owned(),
            _ => "Painting stiffness: Esc takes it back".to_owned(),
        })
    }

    fn moved(&mut self, context: &mut Context<'_>, pointer: Pointer) -> Next {
        self.dab(context, pointer.position_px);
        Next::Stay
    }

    fn released(&mut self, context: &mut Context<'_>, pointer: Pointer, button: Button) -> Next {
        if button != Button::Primary {
            return Next::Stay;
        }
        if pointer.position_px != self.last_px {
            self.dab(context, pointer.position_px);
        }
        let before = self.transaction.before();
        context.workspace.document.drop_plain_stiffness(before);
        context.workspace.commit(&self.transaction);
        Next::End
    }

    fn abort(&mut self, context: &mut Context<'_>) {
        context.workspace.abort(&self.transaction);
    }
}

/// Moves vertices' values towards the mean of their neighbours, by their firmness in the dab; returns them.
fn smooth(mut met: Vec<(SurfaceVertex, f64)>, field: &mut [f64], topology: &Topology) -> Vec<SurfaceVertex> {
    // Every new value comes from old ones, whatever the order of the vertices.
    met.sort_unstable_by(|a, b| a.0.cmp(&b.0).then(b.1.total_cmp(&a.1)));
    met.dedup_by_key(|(vertex, _)| *vertex);
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

/// What a stiffness counts as where it is blended: rigid as the stiffest.
fn finite(value: f64) -> f64 {
    value.min(*STIFFNESS_RANGE.end())
}

fn in_range(value: f64) -> f64 {
    value.clamp(*STIFFNESS_RANGE.start(), *STIFFNESS_RANGE.end())
}
