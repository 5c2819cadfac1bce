//! The lengths of ways by which rings are measured: plain ones, or those that count as longer across concave creases.
//!
//! Around an ear on a head, or a head on a thick neck, rings of plain distance leave the limb on one side while they are
//! still on it on the other. Across a crease a way counts as longer by the crease's angle times a share of the surface's
//! extent, so rings wait in the crease around the limb's root [HR84]. On smooth limbs that hinders more than it helps: a
//! hand's rings wait between its fingers.

use glam::DVec3;

use super::shape::Shape;
use crate::{SurfaceVertex, concavities};

/// The length by which a crease of one radian counts, as a share of the surface's extent.
const CREASE_SHARE: f64 = 0.05;

/// The length over which normals are smoothed, as the same share.
const SMOOTH_SHARE: f64 = 0.02;

/// The lengths of ways.
pub(super) struct Ways {
    /// By how many times ways at each vertex count as longer; empty if they do nowhere.
    stretch: Vec<f64>,
}

impl Ways {
    pub(super) fn plain() -> Self {
        Self { stretch: Vec::new() }
    }

    /// Ways on the component with this vertex that count as longer across creases.
    pub(super) fn across_creases(shape: &Shape<'_>, of: SurfaceVertex) -> Self {
        let vertices: Vec<SurfaceVertex> = shape.topology.vertices_of(shape.topology.component(of)).collect();
        let extent = extent(shape, &vertices);
        let scale = SMOOTH_SHARE * extent;
        let found = concavities(shape.triangles, shape.topology, shape.positions, &vertices, scale);
        let mut stretch = vec![1.0; shape.positions.len()];
        for (v, concavity) in vertices.iter().zip(found) {
            stretch[v.index()] += CREASE_SHARE * extent * concavity;
        }
        Self { stretch }
    }

    pub(super) fn stretch(&self, v: SurfaceVertex) -> f64 {
        self.stretch.get(v.index()).copied().unwrap_or(1.0)
    }
}

/// The diagonal of the box around some vertices.
pub(super) fn extent(shape: &Shape<'_>, vertices: &[SurfaceVertex]) -> f64 {
    let (mut least, mut most) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    for position in vertices.iter().map(|v| shape.positions[v.index()]) {
        (least, most) = (least.min(position), most.max(position));
    }
    least.distance(most)
}
