//! The memory that bindings may use.

use pliant_deform::{Budget, Method};

/// A person's limit, and the source of the available memory at the beginning of a binding.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Allowance {
    most: Option<u64>,
    budget: fn(Option<u64>) -> Budget,
}

impl Allowance {
    /// The allowance of `budget`.
    pub(super) fn new(budget: fn(Option<u64>) -> Budget) -> Self {
        Self { most: None, budget }
    }

    /// In bytes; `None` without a person's limit.
    pub(super) fn most(self) -> Option<u64> {
        self.most
    }

    /// The same with another limit.
    pub(super) fn with_most(self, most: Option<u64>) -> Self {
        Self { most, ..self }
    }

    /// The budget of a binding that begins now.
    pub(super) fn budget(self) -> Budget {
        (self.budget)(self.most)
    }

    /// Whether the factor of a method would differ from that under `other` by a person's limit alone: the machine's
    /// free memory changes from moment to moment, and by the bindings themselves.
    pub(super) fn chooses_otherwise(self, other: Self, method: &Method, free_count: usize) -> bool {
        let power = |allowance: Self| method.ordering_power_within(free_count, Budget::of_most(allowance.most));
        power(self) != power(other)
    }
}
