//! The choice of a thin plate's factor: its own, or the Laplacian's if its own would not fit the budget.

use pliant_mesh::{Cancel, Topology};

use crate::BindError;
use crate::budget::{Budget, ORDERING_ROW, bytes_of, plate_bytes};
use crate::method::BindInput;
use crate::sparse::system_error::SystemError;
use crate::sparse::{Elimination, Ordering};

/// The order of elimination given to the binding, and the source of another one.
pub(crate) struct EliminationPlan<'a> {
    ordering: &'a Ordering,
    topology: &'a Topology,
    solved: &'a [u32],
    /// True if the factor of the Laplacian can replace the method's own.
    takes_first_power: bool,
}

impl<'a> EliminationPlan<'a> {
    /// The plan of a binding's input.
    ///
    /// # Errors
    /// There is no ordering of the method's power, or of power 1 in its place, or it is another mesh's.
    pub fn of(input: &BindInput<'a>) -> Result<Self, BindError> {
        let takes_first_power = input.takes_first_power;
        let ordering = match input.ordering_of(1) {
            Ok(first) if takes_first_power => first,
            _ => input.ordering()?,
        };
        Ok(Self {
            takes_first_power,
            ordering,
            topology: input.problem.topology,
            solved: &input.partition.solved,
        })
    }

    /// The order for the matrix of this power, if the ordering is for it and the factor can be expected to fit.
    pub fn direct(&self, power: u32, budget: Budget) -> Option<Elimination> {
        let is_its_own = self.ordering.power() >= power;
        // If there is an alternative, the ordering decides. Otherwise the factor is tried unless it cannot fit.
        let estimate = plate_bytes(self.solved.len()) / if self.takes_first_power { 1 } else { 2 };
        let is_too_large = power == 2 && estimate > budget.bytes;
        (is_its_own && !is_too_large).then(|| self.ordering.elimination(self.solved))
    }

    /// The order for the Laplacian.
    ///
    /// # Errors
    /// [`SystemError::Budget`], [`SystemError::Cancelled`].
    pub fn of_laplacian(&self, budget: Budget, cancel: &Cancel) -> Result<Elimination, SystemError> {
        if self.ordering.known_of_laplacian().is_none() {
            let bytes = bytes_of(self.topology.vertex_count(), ORDERING_ROW);
            budget.without(bytes).map_err(SystemError::Budget)?;
        }
        let ordering = self.ordering.of_laplacian(self.topology, cancel);
        ordering
            .map(|ordering| ordering.elimination(self.solved))
            .map_err(|_| SystemError::Cancelled)
    }
}
