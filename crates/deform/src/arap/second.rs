//! The second descent of a drag's end, from rest: see [`crate::descent::rival`].

use super::end::End;
use super::lead::{First, LedSolver};
use super::shape::{Guesses, Shape};
use crate::descent::rival::{NEAR, Rival, Twice, is_far};
use crate::descent::rule::State;
use crate::handles::Motion;

impl LedSolver {
    /// Prepares for motions that may differ from the last step's.
    pub(super) fn expect(&mut self, motions: &[Motion]) {
        let solver = &self.solver;
        if !solver.has_other_offsets && solver.motions == motions {
            return;
        }
        let goes_on = !solver.motions.iter().all(Motion::is_rest);
        let is_far = is_far(&solver.handles, motions, solver.unit);
        if let Some(first) = self.rival.aim(goes_on, is_far) {
            self.put_back(first);
        }
    }

    /// The shape to show: the first descent's end until the second has ended.
    pub(super) fn shown(&self) -> &Shape {
        self.rival.first().map_or(&self.solver.current, |first| &first.shape)
    }
}

impl Twice for LedSolver {
    type End = First;

    fn rival(&mut self) -> &mut Rival<First> {
        &mut self.rival
    }

    fn has_ended(&self) -> bool {
        self.solver.state != State::Descending
    }

    fn energy(&self) -> f64 {
        self.solver.current.energy
    }

    fn energy_at(first: &First) -> f64 {
        first.shape.energy
    }

    fn end(&self) -> First {
        First {
            shape: self.solver.current.clone(),
            state: self.solver.state,
        }
    }

    fn begin_again(&mut self) {
        self.hurry_corrections();
        self.solver.start_from_rest();
    }

    fn is_near(&self, first: &First) -> bool {
        let limit = (NEAR * self.solver.unit).powi(2);
        let pairs = self.solver.current.displacements.iter().zip(&first.shape.displacements);
        pairs
            .map(|(now, first)| (0..3).map(|k| (now[k] - first[k]).powi(2)).sum::<f64>())
            .all(|square| square < limit)
    }

    fn put_back(&mut self, First { shape, state }: First) {
        let solver = &mut self.solver;
        solver.history.clear();
        solver.history.drop_pending();
        let energy = shape.energy;
        solver.current = shape;
        // The scratch memory is that of another shape.
        solver
            .cells
            .evaluate(&mut solver.current, Guesses::Own, &mut solver.scratch);
        solver.current.add_gradient_of(&solver.springs);
        solver.current.energy = energy;
        solver.end = End::Known;
        solver.state = state;
    }
}
