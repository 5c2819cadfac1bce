//! The knowledge between two steps.

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
