//! The second descent of a drag's end, from rest: see [`crate::descent::rival`].

use super::bodies::{Bodies, First, State};
use crate::descent::rival::{NEAR, Rival, Twice};
use crate::descent::rule;
use crate::handles::Motion;
use crate::handles::blend::HandleFrame;

impl Twice for Bodies {
    type End = First;

    fn handles(&self) -> &[HandleFrame] {
        &self.handles
    }

    /// The diagonal of the box around the bodies' centres.
    fn size(&self) -> f64 {
        pliant_mesh::bounding_box(&self.joints.centres).map_or(0.0, |bounds| bounds.diagonal())
    }

    fn goes_on(&self) -> bool {
        !self.motions.iter().all(Motion::is_rest)
    }

    fn rival(&mut self) -> &mut Rival<First> {
        &mut self.rival
    }

    fn has_ended(&self) -> bool {
        matches!(self.state, State::Steps(rule::State::Converged | rule::State::Stalled))
    }

    fn energy(&self) -> f64 {
        self.current.energy
    }

    fn energy_at(first: &First) -> f64 {
        first.pose.energy
    }

    fn end(&self) -> First {
        First {
            pose: self.current.clone(),
            state: self.state,
        }
    }

    fn begin_again(&mut self) {
        self.start_from_rest();
    }

    fn is_near(&self, first: &First) -> bool {
        let limit = NEAR * self.size();
        let mut pairs = self.current.shifts.iter().zip(&first.pose.shifts);
        pairs.all(|(now, first)| now.distance(*first) < limit)
    }

    fn put_back(&mut self, First { pose, state }: First) {
        self.memory.clear();
        self.current = pose;
        self.state = state;
    }
}
