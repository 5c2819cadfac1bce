//! The progress of a descent, and its knowledge between two steps.

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

/// The knowledge at the end of the last step.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) enum End {
    /// The gradient.
    #[default]
    Known,
    /// The length of the step against `direction`, without the gradient; `trial` is the shape before the step.
    Stepped(f64),
    /// Nothing.
    Unknown,
}
