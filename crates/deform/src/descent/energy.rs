//! One step that lowers an energy.

use super::rule::Lowered;
use crate::numerical::line_search::Trial;

/// The most lengths that a line search tries.
const TRIALS: u32 = 12;

/// An energy at its present shape, with the means to lower it.
pub(crate) trait Energy {
    /// The energy of the present shape.
    fn value(&self) -> f64;

    /// Finds a direction uphill at the present shape, from the gradient and the remembered steps. Returns the energy's
    /// slope against it, which is negative if it leads down.
    fn aim(&mut self) -> f64;

    /// Makes the trial shape the present one, moved by this length against the direction. Returns its energy.
    fn try_length(&mut self, length: f64) -> f64;

    /// Makes the trial shape of this length the present one, and remembers the step.
    fn accept(&mut self, length: f64);

    /// Forgets the remembered steps. Returns whether there were some.
    fn forget(&mut self) -> bool;
}

/// Takes a step that lowers the energy, if there is one: if no length against the direction does, the remembered steps
/// are forgotten and the plain direction is tried.
pub(crate) fn lower(energy: &mut impl Energy) -> Lowered {
    let before = energy.value();
    loop {
        let slope = energy.aim();
        let is_lower = slope < 0.0 && search(energy, before, slope);
        if is_lower || !energy.forget() {
            return Lowered {
                promised: -0.5 * slope,
                gained: before - energy.value(),
            };
        }
    }
}

/// Moves against the direction, by its whole length if that lowers the energy enough. Returns whether any length did.
fn search(energy: &mut impl Energy, before: f64, slope: f64) -> bool {
    let mut length = 1.0;
    for _ in 0..TRIALS {
        let trial = Trial {
            length,
            before,
            after: energy.try_length(length),
            slope,
        };
        if trial.is_sufficient() {
            energy.accept(length);
            return true;
        }
        length = trial.next_length();
    }
    false
}
