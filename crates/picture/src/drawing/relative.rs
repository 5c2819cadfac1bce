//! The positions of the surface's vertices relative to the drawing's centre.
//!
//! Their unit is a power of two near the drawing's size, so that the square of a triangle's area is representable in
//! single precision for any unit of the file.

use glam::DVec3;
use pliant_mesh::{Model, Vector3};
use rayon::prelude::*;

/// The number of vertices for one task.
const CHUNK: usize = 4096;

/// Triangles whose sides are all shorter than this share of the drawing's diagonal are fine: after rounding to single
/// precision, the errors of their normals would be visible (0.03° at this size, and more for smaller ones).
const FINE: f64 = 1e-4;

/// The share of triangles that may be fine before normals are computed in double precision.
const MOST_FINE: f64 = 0.01;

/// The frame of positions.
#[derive(Clone, Copy, Debug)]
pub struct Relative {
    /// The centre of the file's bounding box.
    pub centre: DVec3,
    /// In world units.
    unit: f64,
    /// True if so many triangles are so small that normals need double precision.
    pub is_fine: bool,
}

impl Relative {
    /// The frame that fits the file's shape.
    pub fn of(model: &Model) -> Self {
        let (centre, diagonal) = model
            .bounds()
            .map_or((DVec3::ZERO, 1.0), |bounds| (bounds.centre(), bounds.diagonal()));
        let surface = &model.surface;
        let shortest = FINE * diagonal;
        let is_small = |&triangle: &usize| {
            let [a, b, c] = surface.corners(triangle);
            a.distance(b).max(b.distance(c)).max(c.distance(a)) < shortest
        };
        let count = surface.triangles.len();
        let fine = (0..count).into_par_iter().with_min_len(CHUNK).filter(is_small).count();
        Self {
            centre,
            unit: diagonal.log2().round().clamp(-126.0, 126.0).exp2(),
            is_fine: fine as f64 > MOST_FINE * count as f64,
        }
    }

    /// Each vertex at its rest position (`rest`, in world units) plus its displacement, into `out`.
    pub fn positions<V: Vector3>(
        &self,
        rest: &[DVec3],
        displacement: impl Fn(usize) -> DVec3 + Sync,
        out: &mut Vec<V>,
    ) {
        let scale = self.unit.recip();
        rest.par_iter()
            .enumerate()
            .with_min_len(CHUNK)
            .map(|(vertex, rest)| V::rounded((*rest + displacement(vertex) - self.centre) * scale))
            .collect_into_vec(out);
    }

    /// One of [`Relative::positions`] in world units, relative to the centre.
    #[inline]
    pub fn in_world_units(&self, position: impl Vector3) -> [f32; 3] {
        (position.single() * self.unit as f32).to_array()
    }
}
