//! The second descent of a drag's end, from rest: see [`crate::descent::rival`].

use super::end::End;
use super::lead::{First, LedSolver};
use super::shape::{Guesses, Shape};
use crate::descent::rival::{NEAR, Rival, Twice};
use crate::descent::rule::State;
use crate::handles::Motion;
use crate::handles::blend::HandleFrame;

impl LedSolver {
    /// The shape to show: the first descent's end until the second has ended.
    pub(super) fn shown(&self) -> &Shape {
        self.rival.first().map_or(&self.solver.current, |first| &first.shape)
    }
}

impl Twice for LedSolver {
    type End = First;

    fn handles(&self) -> &[HandleFrame] {
        &self.solver.handles
    }

    fn size(&self) -> f64 {
        self.solver.unit
    }

    fn goes_on(&self) -> bool {
        !self.solver.motions.iter().all(Motion::is_rest)
    }

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
