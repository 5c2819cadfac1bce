//! The transformations that best fit the motion of the vertices' rings from rest to a shape [BS08, section 3.2.5],
//! eight at a time.

use glam::{DMat3, DQuat, DVec3};
use pliant_mesh::vectors;
use pulp::{Simd, WithSimd};
use rayon::prelude::*;

use super::LocalScale;
use super::moments::Moments;
use super::rings::Rings;
use super::similarity::Similarity;
use crate::Laplacian;
use crate::numerical::lane_fits::Fits;
use crate::numerical::lanes::LANES;
use crate::numerical::rows::CHUNK;

/// The data for estimating transformations.
#[derive(Clone, Copy)]
pub(super) struct Estimate<'a> {
    pub laplacian: &'a Laplacian,
    pub rings: &'a Rings,
    pub scale: LocalScale,
    /// Rest positions and displacements of the local vertices.
    pub rest: &'a [DVec3],
    pub field: &'a [[f64; 3]],
    /// Fits of the nearest rings, at whose turns the search for rotations may begin.
    pub similarities: Option<&'a [Similarity]>,
    /// L p of the local vertices.
    pub curvature: &'a [DVec3],
}

impl Estimate<'_> {
    /// Fills `changes` with (T − I) L p: zero to the last bit if a ring keeps its place or is moved as a whole.
    pub fn transform(self, changes: &mut [DVec3]) {
        let arch = vectors();
        changes.par_chunks_mut(CHUNK).enumerate().for_each(|(chunk, changes)| {
            arch.dispatch(Pass {
                estimate: self,
                first: chunk * CHUNK,
                changes,
            });
        });
    }

    /// A guess at the rotation around a vertex, whose ring has these moments: the better one of its fit's and a
    /// neighbour's. Linear fits are poor for large turns.
    #[inline(always)]
    fn guess(&self, local: usize, moments: &Moments, beside: DQuat) -> DQuat {
        let own = match self.similarities {
            None => DQuat::IDENTITY,
            Some(similarities) if self.rings.are_nearest() => similarities[local].fit(moments).rotation_guess(),
            Some(similarities) => {
                let nearest = Moments::of(local, self.laplacian.neighbours(local), self.rest, self.field);
                similarities[local].fit(&nearest).rotation_guess()
            }
        };
        if moments.alignment(beside) > moments.alignment(own) {
            beside
        } else {
            own
        }
    }
}

/// Estimates for the local vertices from `first` on, compiled for the machine's vectors.
struct Pass<'a> {
    estimate: Estimate<'a>,
    first: usize,
    changes: &'a mut [DVec3],
}

impl WithSimd for Pass<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Self {
            estimate,
            first,
            changes,
        } = self;
        let mut fits = Fits::default();
        // Vertices with consecutive numbers are near each other.
        let mut beside = DQuat::IDENTITY;
        for start in (0..changes.len()).step_by(LANES) {
            let count = LANES.min(changes.len() - start);
            let mut all = [Moments::ZERO; LANES];
            for lane in 0..count {
                let local = first + start + lane;
                let around = estimate.rings.around(estimate.laplacian, local);
                let moments = Moments::of(local, around, estimate.rest, estimate.field);
                let columns = moments.change.to_cols_array_2d();
                for (lanes, value) in fits.change.as_flattened_mut().iter_mut().zip(columns.as_flattened()) {
                    lanes.0[lane] = *value;
                }
                for (lanes, value) in fits.rest.iter_mut().zip(moments.rest) {
                    lanes.0[lane] = value;
                }
                let guess = estimate.guess(local, &moments, beside).to_array();
                for (lanes, value) in fits.rotation.iter_mut().zip(guess) {
                    lanes.0[lane] = value;
                }
                all[lane] = moments;
            }
            fits.fit(simd, count);
            fits.finish(simd);
            beside = DQuat::from_array(fits.rotation.map(|lanes| lanes.0[count - 1]));
            for lane in 0..count {
                let (moments, local) = (&all[lane], first + start + lane);
                let curvature = estimate.curvature[local];
                let change = &mut changes[start + lane];
                *change = DVec3::ZERO;
                if moments.change == DMat3::ZERO {
                    continue;
                }
                for (column, part) in fits.turn.iter().zip(curvature.to_array()) {
                    *change += DVec3::from_array(column.each_ref().map(|lanes| lanes.0[lane])) * part;
                }
                let square = moments.square();
                if estimate.scale == LocalScale::Free && square > 0.0 {
                    // tr(Rᵀ S) / Σ |e|² less 1.
                    let growth = (2.0 * fits.inner.0[lane] + moments.along()) / square;
                    *change += (*change + curvature) * growth;
                }
            }
        }
    }
}
