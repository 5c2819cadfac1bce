//! The second descent of a drag's end, from rest: see [`crate::descent::rival`].

use super::first::First;
use super::solver::Solver;
use crate::descent::rival::{NEAR, Rival, Twice};
use crate::handles::Motion;
use crate::handles::blend::HandleFrame;

impl Twice for Solver {
    type End = First;

    fn handles(&self) -> &[HandleFrame] {
        &self.handles
    }

    /// The diagonal of the box around the nodes.
    fn size(&self) -> f64 {
        pliant_mesh::bounding_box(&self.nodes).map_or(0.0, |bounds| bounds.diagonal())
    }

    fn goes_on(&self) -> bool {
        !self.motions.iter().all(Motion::is_rest)
    }

    fn rival(&mut self) -> &mut Rival<First> {
        &mut self.rival
    }

    fn has_ended(&self) -> bool {
        self.has_converged || self.has_stalled
    }

    fn energy(&self) -> f64 {
        self.value
    }

    fn energy_at(first: &First) -> f64 {
        first.value
    }

    fn end(&self) -> First {
        First {
            maps: self.maps.clone(),
            value: self.value,
            has_converged: self.has_converged,
            has_stalled: self.has_stalled,
        }
    }

    fn begin_again(&mut self) {
        let motions = self.motions.clone();
        self.back_to_rest();
        self.start(&motions);
    }

    fn is_near(&self, first: &First) -> bool {
        let limit = NEAR * self.size() / self.energy.world_unit;
        let mut pairs = self.maps.iter().zip(&first.maps);
        pairs.all(|(now, first)| now.shift.distance(first.shift) < limit)
    }

    fn put_back(&mut self, first: First) {
        (self.maps, self.value) = (first.maps, first.value);
        (self.has_converged, self.has_stalled) = (first.has_converged, first.has_stalled);
    }
}
