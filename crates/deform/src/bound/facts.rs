//! The facts of a binding beside its steps: weights, the base, derivatives, sizes and warnings.

use glam::{DVec3, Mat3};

use super::Bound;
use crate::needs::Solve;
use crate::{HandleBases, Warning};

impl Bound {
    /// A handle's weight at each surface vertex, from 0 to 1: the share of its turn and stretch that the surface takes
    /// on there. `None` if the method has no such weights, or no such handle.
    pub fn handle_weights(&self, handle: usize) -> Option<Vec<f64>> {
        let mut weights = vec![0.0; self.vertex_count];
        let Some(sections) = &self.sections else {
            return (handle < self.handles.len() && self.method.weights_of(handle, &mut weights)).then_some(weights);
        };
        let mut own = vec![0.0; self.vertex_count];
        let numbers = sections.handle_of.iter().enumerate();
        for (section, _) in numbers.filter(|(_, of)| **of == handle) {
            own.fill(0.0);
            if !self.method.weights_of(section, &mut own) {
                return None;
            }
            weights.iter_mut().zip(&own).for_each(|(sum, own)| *sum += own);
        }
        (handle < sections.handle_count()).then_some(weights)
    }

    /// Replaces the displacements of the last step by those that take the surface's vertices to the smooth base that
    /// was bent instead, if the method has one; before the first step, and if all handles rest, that is the base at
    /// rest. Vertices that are not solved keep their displacements. Returns whether the method has a base; only linear
    /// methods do.
    pub fn base(&self, displacements: &mut [DVec3]) -> bool {
        let bound = self.rigid.as_ref().map_or(self, |rigid| &rigid.bound);
        displacements.len() == self.vertex_count && bound.method.base(displacements)
    }

    /// The Jacobian J of the displacements at each surface vertex, in the last step; `None` if the method does not know
    /// its map's derivative. A normal there turns by the inverse transpose of I + J.
    pub fn jacobians(&self) -> Option<Vec<Mat3>> {
        let mut jacobians = Vec::new();
        self.jacobians_into(&mut jacobians).then_some(jacobians)
    }

    /// Like [`Bound::jacobians`], into a table that is kept from frame to frame. Returns whether the method knows them.
    pub fn jacobians_into(&self, jacobians: &mut Vec<Mat3>) -> bool {
        jacobians.resize(self.vertex_count, Mat3::ZERO);
        let are_known = match &self.rigid {
            Some(rigid) => rigid.bound.method.jacobians(&rigid.bound.motions, jacobians),
            None => self.method.jacobians(&self.motions, jacobians),
        };
        if self.is_at_rest() {
            jacobians.fill(Mat3::ZERO);
        }
        are_known
    }

    /// The handle bases, if a step is a product with them.
    pub fn handle_bases(&self) -> Option<&HandleBases> {
        self.method.handle_bases().filter(|_| self.rigid.is_none())
    }

    /// The way in which the method finds its shape.
    pub fn solve(&self) -> Solve {
        self.solve
    }

    /// Sentences for a person about components without a handle or a fixed vertex, repairs, present targets that the
    /// method can't follow, and the distance by which the last step misses handles that are only fitted.
    pub fn warnings(&self) -> &[Warning] {
        &self.warnings
    }

    /// The sentences about present targets that the method can't follow.
    pub fn blind_to(&self) -> &[Warning] {
        &self.warnings[self.binding_warnings..]
    }

    /// The number of the surface's vertices, which is the length of the displacements that [`Bound::step`] fills.
    pub fn vertex_count(&self) -> usize {
        self.vertex_count
    }

    /// The number of vertices with the role [`crate::Role::Free`].
    pub fn free_count(&self) -> usize {
        self.free_count
    }

    /// The number of solved vertices: those that a handle can reach.
    pub fn solved_count(&self) -> usize {
        self.method.solved_count()
    }

    /// The approximate cost of a step, in vertices of a method with cheap steps. Callers that show intermediate shapes
    /// take fewer steps between two of them if steps are expensive.
    pub fn step_cost(&self) -> usize {
        self.method.step_cost() + self.rigid.as_ref().map_or(0, |rigid| rigid.bound.step_cost())
    }

    /// The number of entries that the system's factor stores, 8 bytes each.
    pub fn factor_len(&self) -> usize {
        self.method.factor_len() + self.rigid.as_ref().map_or(0, |rigid| rigid.bound.factor_len())
    }

    /// [`crate::Problem::revision`] of the problem it was bound from.
    pub fn revision(&self) -> u64 {
        self.revision
    }
}
