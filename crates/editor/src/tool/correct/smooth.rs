//! A stroke that smooths or relaxes the shape.
//!
//! Smoothing goes forth and back by a low-pass filter [Tau95], so that bumps go and the volume stays. Relaxing goes
//! within the tangent plane alone.

use std::collections::BTreeMap;

use glam::{DVec2, DVec3};
use pliant_mesh::{Model, SurfaceVertex};

use super::brush::{Correction, CorrectionBrush};
use crate::document::Transaction;
use crate::input::{Button, Pointer};
use crate::jobs::Activity;
use crate::scene_view::Cursor;
use crate::tool::context::Context;
use crate::tool::gesture::{Gesture, Next};
use crate::tool::overlay::Lit;
use crate::view::View;
use crate::workspace::Workspace;

/// How far the way back is longer than the way forth: what is smoother than the filter's pass band neither shrinks nor
/// grows.
const BACK: f64 = 1.06;

/// How often one dab filters: once is hardly seen.
const ROUNDS: usize = 3;

/// A stroke that goes on.
#[derive(Debug)]
pub(super) struct SmoothShape {
    transaction: Transaction,
    brush: CorrectionBrush,
    last_px: DVec2,
}

impl SmoothShape {
    pub fn begin(context: &mut Context<'_>, pointer: Pointer, brush: CorrectionBrush) -> Self {
        let name = match brush.correction {
            Correction::Relax => "Relax shape",
            Correction::Smooth | Correction::Grab => "Smooth shape",
        };
        let mut stroke = Self {
            transaction: context.workspace.begin_stroke(name),
            brush,
            last_px: pointer.position_px,
        };
        stroke.dab(context, pointer.position_px);
        stroke
    }

    fn dab(&mut self, context: &mut Context<'_>, to_px: DVec2) {
        let strength = self.brush.strength * context.settings.pressure.unwrap_or(1.0);
        let mut met: BTreeMap<SurfaceVertex, f64> = BTreeMap::new();
        if let Some(picking) = context.workspace.picking(context.view) {
            let size = &context.settings.brush;
            let visit = |vertex, share: f64| {
                let firmness = strength * (1.0 - share * share).powi(2);
                let firmest = met.entry(vertex).or_insert(0.0);
                *firmest = firmest.max(firmness);
            };
            context.brush.stroke(&picking, self.last_px, to_px, size, visit);
        }
        self.last_px = to_px;
        let workspace = &mut *context.workspace;
        let mut met: Vec<(SurfaceVertex, f64)> = met.into_iter().collect();
        if let Some(sides) = workspace.both_sides() {
            met.extend(sides.opposite_with(&met));
            met.sort_by(|a, b| a.0.cmp(&b.0).then(b.1.total_cmp(&a.1)));
            met.dedup_by_key(|(vertex, _)| *vertex);
        }
        let Some(model) = workspace.model().cloned() else {
            return;
        };
        met.retain(|(vertex, _)| {
            workspace.vertex_access.may_be_painted(vertex.index()) && !model.topology.is_boundary_vertex(*vertex)
        });
        if met.is_empty() {
            return;
        }
        let rest = &model.surface.positions;
        let (correction, applied) = (self.brush.correction, workspace.document.rest().to_vec());
        workspace.document.correct(|shape| {
            let mut positions: BTreeMap<SurfaceVertex, DVec3> = BTreeMap::new();
            let at = |positions: &BTreeMap<SurfaceVertex, DVec3>, shape: &[DVec3], v: SurfaceVertex| {
                let seen = || rest[v.index()] + applied[v.index()] + shape[v.index()];
                positions.get(&v).copied().unwrap_or_else(seen)
            };
            let ways: &[f64] = match correction {
                Correction::Relax => &[1.0],
                Correction::Smooth | Correction::Grab => &[1.0, -BACK],
            };
            for way in ways.repeat(ROUNDS) {
                let stepped = met.iter().map(|&(vertex, firmness)| {
                    let own = at(&positions, shape, vertex);
                    let mean = mean_of_ring(&model, vertex, |v| at(&positions, shape, v));
                    let mut step = mean - own;
                    if correction == Correction::Relax {
                        let normal = normal_of_ring(&model, vertex, |v| at(&positions, shape, v));
                        step -= normal * normal.dot(step);
                    }
                    (vertex, own + step * (firmness * way))
                });
                let stepped: Vec<_> = stepped.collect();
                positions.extend(stepped);
            }
            for (vertex, position) in positions {
                shape[vertex.index()] = position - rest[vertex.index()] - applied[vertex.index()];
            }
        });
    }
}

/// The mean of a vertex' neighbours; every vertex of a triangle has some.
fn mean_of_ring(model: &Model, vertex: SurfaceVertex, position: impl Fn(SurfaceVertex) -> DVec3) -> DVec3 {
    let neighbours = model.topology.neighbours(vertex);
    if neighbours.is_empty() {
        return position(vertex);
    }
    neighbours.iter().map(|&v| position(v)).sum::<DVec3>() / neighbours.len() as f64
}

/// The normal of the triangles around a vertex, weighted by area; zero where they cancel.
fn normal_of_ring(model: &Model, vertex: SurfaceVertex, position: impl Fn(SurfaceVertex) -> DVec3) -> DVec3 {
    let triangles = &model.surface.triangles;
    let normal = |face: u32| {
        let [a, b, c] = triangles[face as usize].map(&position);
        (b - a).cross(c - a)
    };
    let faces = model.topology.faces(vertex, triangles);
    faces.map(normal).sum::<DVec3>().normalize_or_zero()
}

impl Gesture for SmoothShape {
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
        Some(match self.brush.correction {
            Correction::Relax => "Evening the triangles out: Esc takes it back".to_owned(),
            Correction::Smooth | Correction::Grab => "Smoothing the shape: Esc takes it back".to_owned(),
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
        context.workspace.commit(&self.transaction);
        Next::End
    }

    fn abort(&mut self, context: &mut Context<'_>) {
        context.workspace.abort(&self.transaction);
    }
}
