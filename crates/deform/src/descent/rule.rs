//! The rule of convergence.

/// The progress towards the present targets.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum State {
    /// Not finished.
    Descending,
    /// Converged: at a minimum, to the tolerance.
    Converged,
    /// Stalled: no step was found that lowers the energy, though the quadratic model promises one.
    Stalled,
}

/// The decreases that a step promised and reached.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Lowered {
    /// The decrease that the quadratic model promised.
    pub promised: f64,
    /// The decrease of the energy; 0 if no length lowered it.
    pub gained: f64,
}

/// The decreases that count as none.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Rule {
    /// The share of the energy below which a decrease ends the descent.
    pub tolerance: f64,
    /// Energies below this are rounding.
    pub nothing: f64,
    /// A decrease by less than this share of the energy may be rounding.
    pub rounded: f64,
}

impl Rule {
    /// The state after a step to this energy.
    ///
    /// The shape has converged if the quadratic model promised little and the step gained little too. In exact
    /// arithmetic a plain step always descends: if even that fails and promised little, only rounding is left; if it
    /// promised more, the descent has stalled.
    pub fn state(&self, lowered: Lowered, energy: f64) -> State {
        if lowered.gained > 0.0 {
            return match self.is_little(lowered, energy) {
                true => State::Converged,
                false => State::Descending,
            };
        }
        let little = self.tolerance.max(self.rounded) * energy + self.nothing;
        if lowered.promised <= little {
            State::Converged
        } else {
            State::Stalled
        }
    }

    /// Whether a step promised and gained next to nothing.
    pub fn is_little(&self, lowered: Lowered, energy: f64) -> bool {
        let enough = self.tolerance * energy + self.nothing;
        lowered.promised <= enough && lowered.gained <= enough
    }
}

#[cfg(test)]
mod tests {
    use super::{Lowered, Rule, State};

    #[test]
    fn a_descent_ends_where_little_is_promised_and_gained_and_stalls_where_more_is_promised() {
        let rule = Rule {
            tolerance: 1e-6,
            nothing: 1e-20,
            rounded: 1e-4,
        };
        let after = |promised: f64, gained: f64| rule.state(Lowered { promised, gained }, 1.0);
        assert_eq!(after(1e-7, 1e-7), State::Converged);
        assert_eq!(after(1e-3, 1e-7), State::Descending);
        assert_eq!(after(1e-7, 1e-3), State::Descending);
        assert_eq!(after(1e-5, 0.0), State::Converged);
        assert_eq!(after(1e-3, 0.0), State::Stalled);
        assert_eq!(after(f64::NAN, 0.0), State::Stalled);
    }
}
