//! A stroke that smooths or relaxes the shape.
//!
//! Smoothing goes forth and back by a low-pass filter [Tau95], so that bumps vanish and the volume stays. Relaxing
//! moves vertices only within the tangent plane.

use std::collections::BTreeMap;

use glam::{DVec2, DVec3};
use pliant_mesh::{Model, SurfaceVertex};

use crate::document::Document;
use crate::input::Pointer;
use crate::tool::context::Context;
use crate::tool::correction_brush::{Correction, CorrectionBrush};
use crate::tool::stroke::{Stroke, StrokeGesture, firmest};
use crate::workspace::{Workspace, carry_corrections};

/// The excess of the step back over the step forth: shapes smoother than the filter's pass band neither shrink nor
/// grow.
const BACK: f64 = 1.06;

/// The number of filter passes of one dab: a single pass is hardly visible.
const ROUNDS: usize = 3;

/// The stroke's action.
#[derive(Debug)]
pub(super) struct SmoothShape(CorrectionBrush);

impl SmoothShape {
    pub fn begin(context: &mut Context<'_>, pointer: Pointer, brush: CorrectionBrush) -> StrokeGesture<Self> {
        let transaction = context.workspace.begin_stroke(match brush.correction {
            Correction::Relax => "Relax shape",
            Correction::Smooth | Correction::Grab => "Smooth shape",
        });
        StrokeGesture::begin(context, transaction, Self(brush), pointer)
    }
}

impl Stroke for SmoothShape {
    fn doing(&self, _: &Workspace) -> String {
        match self.0.correction {
            Correction::Relax => "Relaxing the shape".to_owned(),
            Correction::Smooth | Correction::Grab => "Smoothing the shape".to_owned(),
        }
    }

    fn finish(&mut self, workspace: &mut Workspace, before: &Document) {
        carry_corrections(workspace, before);
    }

    fn dab(&mut self, context: &mut Context<'_>, _: &Document, way_px: [DVec2; 2]) {
        let Some(model) = context.workspace.model().cloned() else {
            return;
        };
        let strength = self.0.strength * context.settings.pressure.unwrap_or(1.0);
        let mut met = firmest(context, way_px, |share| strength * (1.0 - share * share).powi(2));
        met.retain(|(vertex, _)| !model.topology.is_boundary_vertex(*vertex));
        if met.is_empty() {
            return;
        }
        let workspace = &mut *context.workspace;
        let rest = &model.surface.positions;
        let (correction, applied) = (self.0.correction, workspace.document.rest().to_vec());
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

/// The normal of the triangles around a vertex, weighted by area; zero if they cancel.
fn normal_of_ring(model: &Model, vertex: SurfaceVertex, position: impl Fn(SurfaceVertex) -> DVec3) -> DVec3 {
    let triangles = &model.surface.triangles;
    let normal = |face: u32| {
        let [a, b, c] = triangles[face as usize].map(&position);
        (b - a).cross(c - a)
    };
    let faces = model.topology.faces(vertex, triangles);
    faces.map(normal).sum::<DVec3>().normalize_or_zero()
}
