//! How much memory bindings may take.

use pliant_deform::{Budget, Method};

/// The most that a person allows, and what tells how much of it there is when a binding begins.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Allowance {
    most: Option<u64>,
    budget: fn(Option<u64>) -> Budget,
}

impl Allowance {
    /// As much as `budget` tells.
    pub(super) fn new(budget: fn(Option<u64>) -> Budget) -> Self {
        Self { most: None, budget }
    }

    /// In bytes; `None` where nobody has said.
    pub(super) fn most(self) -> Option<u64> {
        self.most
    }

    /// The same with another most.
    pub(super) fn with_most(self, most: Option<u64>) -> Self {
        Self { most, ..self }
    }

    /// What a binding that begins now may take.
    pub(super) fn budget(self) -> Budget {
        (self.budget)(self.most)
    }

    /// Whether a method would be bound with another factor than under `other`, as far as a person's word goes: what the
    /// machine has left changes from moment to moment, and by the bindings themselves.
    pub(super) fn chooses_otherwise(self, other: Self, method: &Method, free_count: usize) -> bool {
        let power = |allowance: Self| method.ordering_power_within(free_count, Budget::of_most(allowance.most));
        power(self) != power(other)
    }
}
