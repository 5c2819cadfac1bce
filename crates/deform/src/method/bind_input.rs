//! The input of a method's binding.

use pliant_mesh::{Cancel, Progress};

use crate::handles::Handle;
use crate::region::boundary_problem::BoundaryProblem;
use crate::region::partition::Partition;
use crate::sparse::refactorisation::Refactorisation;
use crate::{Attachment, BindError, Needs, Ordering};

/// The input of a method's binding. The problem is checked already.
#[derive(Clone, Copy)]
pub(crate) struct BindInput<'a> {
    pub problem: &'a BoundaryProblem<'a>,
    /// The method's domain.
    pub needs: Needs,
    /// See [`super::DeformMethod::takes_first_power`].
    pub takes_first_power: bool,
    /// The partition into solved and prescribed vertices.
    pub partition: &'a Partition<'a>,
    pub handles: &'a [Handle],
    /// The attachments that were brought, checked by [`super::DeformMethod::check_attachment`].
    pub attachment: Option<&'a Attachment>,
    /// The ordering that [`Needs`] requires.
    pub ordering: Option<&'a Ordering>,
    /// The parts of the factor that are kept or reused, if possible.
    pub refactorisation: Refactorisation<'a>,
    pub progress: &'a Progress,
    pub cancel: &'a Cancel,
}

impl<'a> BindInput<'a> {
    /// The ordering of the method's power.
    ///
    /// # Errors
    /// There is none, or it is for another mesh or power.
    pub fn ordering(&self) -> Result<&'a Ordering, BindError> {
        self.ordering_of(self.needs.ordering_power().unwrap_or(1))
    }

    /// The ordering, which must be of this power.
    ///
    /// # Errors
    /// Those of [`BindInput::ordering`].
    pub fn ordering_of(&self, expected_power: u32) -> Result<&'a Ordering, BindError> {
        let ordering = self.ordering.ok_or(BindError::NoOrdering { expected_power })?;
        let expected = self.problem.surface.positions.len();
        let (found, found_power) = (ordering.vertex_count(), ordering.power());
        if (found, found_power) == (expected, expected_power) {
            Ok(ordering)
        } else {
            Err(BindError::Ordering {
                found,
                found_power,
                expected,
                expected_power,
            })
        }
    }
}
