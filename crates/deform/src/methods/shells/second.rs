//! The second descent of a drag's end, from rest: see [`crate::descent::rival`].

use super::ShellsSolver;
use super::first::First;
use super::shape::Shape;
use crate::descent::rival::{NEAR, Rival, Twice};
use crate::handles::blend::HandleFrame;

impl ShellsSolver {
    /// The shape to show: the first descent's end until the second has ended.
    pub(super) fn shown(&self) -> &Shape {
        self.rival.first().map_or(&self.current, |first| &first.shape)
    }
}

impl Twice for ShellsSolver {
    type End = First;

    fn handles(&self) -> &[HandleFrame] {
        &self.handles
    }

    /// The diagonal of the box around the solved part at rest.
    fn size(&self) -> f64 {
        pliant_mesh::bounding_box(&self.energy.elements.rest).map_or(0.0, |bounds| bounds.diagonal())
    }

    fn goes_on(&self) -> bool {
        !self.is_at_rest()
    }

    fn rival(&mut self) -> &mut Rival<First> {
        &mut self.rival
    }

    fn has_ended(&self) -> bool {
        self.has_converged || self.has_stalled
    }

    fn energy(&self) -> f64 {
        self.current.energy
    }

    fn energy_at(first: &First) -> f64 {
        first.shape.energy
    }

    fn end(&self) -> First {
        First {
            shape: self.current.clone(),
            has_converged: self.has_converged,
            has_stalled: self.has_stalled,
        }
    }

    fn begin_again(&mut self) {
        let motions = self.motions.clone();
        self.back_to_rest();
        // The weights that examples were given are approached now.
        self.has_other_weights = false;
        self.head_for(&motions);
    }

    fn is_near(&self, first: &First) -> bool {
        let limit = NEAR * self.size();
        let mut pairs = self.current.displacements.iter().zip(&first.shape.displacements);
        pairs.all(|(now, first)| now.distance(*first) < limit)
    }

    fn put_back(&mut self, first: First) {
        self.memory.clear();
        self.current = first.shape;
        (self.has_converged, self.has_stalled) = (first.has_converged, first.has_stalled);
        // A coarse level follows the shape by its gradient.
        self.energy.find_slopes(&self.current, &mut self.slopes);
        self.has_slopes = true;
    }
}
