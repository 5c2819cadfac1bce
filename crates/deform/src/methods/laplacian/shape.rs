//! A frame of Laplacian editing: estimate the transformations, transform L p, solve.

use glam::{DMat3, DVec3};
use rayon::prelude::*;

use super::estimate::Estimate;
use super::moments::Moments;
use super::similarity::Fitted;
use super::{Implicit, LaplacianSolver, LocalScale, Scratch, Transforms};
use crate::SolveError;
use crate::handles::polar::{Blend, Polar, polars_of};
use crate::handles::{Handle, Motion};
use crate::numerical::rows::CHUNK;

impl LaplacianSolver {
    /// Moves the handles in the options' steps: at each the transformations are estimated from a first shape, and the
    /// shape is solved with them.
    pub(super) fn shape(&self, motions: &[Motion], scratch: &mut Scratch) -> Result<(), SolveError> {
        scratch.load.fill([0.0; 3]);
        scratch.changes.fill(DVec3::ZERO);
        let steps = match self.options.transforms {
            Transforms::None => 1,
            Transforms::Implicit | Transforms::InitialGuess => self.options.steps,
        };
        for step in 1..=steps {
            let part = self.part_of_the_way(motions, f64::from(step) / f64::from(steps));
            self.system.prescribe(&part, &mut scratch.field);
            let first = self.implicit.as_ref().filter(|_| step == 1);
            if let Some(implicit) = first {
                implicit.bases.evaluate(&part, &mut scratch.field);
                if self.is_settled_by_bases() {
                    self.change_by(&mut scratch.changes, |local| {
                        self.fitted(implicit, local, &scratch.field).change()
                    });
                    return Ok(());
                }
            } else if self.rings.is_some() {
                // The transformations are those of the last step: at the first one, none.
                self.system.solve(&scratch.load, &mut scratch.field)?;
            }
            if let Some(implicit) = first
                && self.options.scale == LocalScale::Free
                && self.rings.is_none()
            {
                self.change_by(&mut scratch.changes, |local| {
                    self.fitted(implicit, local, &scratch.field).change()
                });
            } else if first.is_some() && self.options.scale == LocalScale::Normalised {
                self.rescale(scratch);
            } else if let Some(rings) = &self.rings {
                let estimate = Estimate {
                    laplacian: self.laplacian(),
                    rings,
                    scale: self.options.scale,
                    rest: &self.rest,
                    field: &scratch.field,
                    similarities: first.map(|implicit| &*implicit.similarities),
                    curvature: &self.curvature,
                };
                estimate.transform(&mut scratch.changes);
            }
            let Scratch { field, changes, .. } = &mut *scratch;
            self.parts.turn(&part, &self.handles, &self.curvature, field, changes);
            self.set_load(scratch);
            self.system.solve(&scratch.load, &mut scratch.field)?;
        }
        Ok(())
    }

    /// Shares of the motions: their turns and stretches, as [`Blend`] scales them, and their shifts.
    fn part_of_the_way(&self, motions: &[Motion], share: f64) -> Vec<Motion> {
        if share >= 1.0 {
            return motions.to_vec();
        }
        let part = |((handle, polar), motion): ((&Handle, Polar), &Motion)| {
            let blend = Blend::of(&[polar], std::iter::once(share));
            let [x, y, z] = DVec3::AXES.map(|axis| blend.change(axis) * handle.radius);
            Motion {
                linear: DMat3::from_cols(x, y, z),
                shift: motion.shift * share,
                turn_rad: motion.turn_rad.map(|turn| turn * share),
            }
        };
        self.handles
            .iter()
            .zip(polars_of(&self.polars, &self.handles, motions))
            .zip(motions)
            .map(part)
            .collect()
    }

    /// Returns true if the bases' shape is the last one: it solves for implicit transformations that keep their scale,
    /// if no part turns as a whole.
    pub(super) fn is_settled_by_bases(&self) -> bool {
        let keeps_scale = self.options.scale == LocalScale::Free && self.options.steps == 1;
        self.implicit.is_some() && keeps_scale && self.parts.is_empty()
    }

    /// The similarity that fits a field around a vertex.
    pub(super) fn fitted(&self, implicit: &Implicit, local: usize, field: &[[f64; 3]]) -> Fitted {
        let nearest = self.laplacian().neighbours(local);
        implicit.similarities[local].fit(&Moments::of(local, nearest, &self.rest, field))
    }

    /// Fills `changes` with the differences that make each L p as long as at rest, in its direction in the first shape
    /// p':
    /// |L p| (L p') / |L p'| − L p [SCL+04, section 3.3].
    fn rescale(&self, scratch: &mut Scratch) {
        let laplacian = self.laplacian();
        let Scratch { field, changes, .. } = scratch;
        changes
            .par_iter_mut()
            .with_min_len(CHUNK)
            .zip(&self.curvature)
            .enumerate()
            .for_each(|(local, (own, &curvature))| {
                let bend = DVec3::from_array(laplacian.row(local, field));
                *own = match (curvature + bend).try_normalize() {
                    Some(direction) if laplacian.is_full(local) && bend != DVec3::ZERO => {
                        direction * curvature.length() - curvature
                    }
                    _ => DVec3::ZERO,
                };
            });
    }

    /// Fills `changes` with (T − I) L p, with a function for T − I at a local vertex.
    pub(super) fn change_by(&self, changes: &mut [DVec3], change: impl Fn(usize) -> DMat3 + Sync) {
        let laplacian = self.laplacian();
        changes
            .par_iter_mut()
            .with_min_len(CHUNK)
            .zip(&self.curvature)
            .enumerate()
            .for_each(|(local, (own, &curvature))| {
                if laplacian.is_full(local) {
                    *own = change(local) * curvature;
                }
            });
    }

    /// L s M⁻¹ (T − I) L p, by differences.
    fn set_load(&self, scratch: &mut Scratch) {
        let laplacian = self.laplacian();
        let Scratch {
            changes, stress, load, ..
        } = scratch;
        stress
            .par_iter_mut()
            .with_min_len(CHUNK)
            .zip(&*changes)
            .enumerate()
            .for_each(|(local, (own, change))| *own = (*change * self.density(local)).to_array());
        load.par_iter_mut()
            .with_min_len(CHUNK)
            .zip(self.system.columns())
            .for_each(|(own, &local)| *own = laplacian.row(local as usize, stress));
    }
}
