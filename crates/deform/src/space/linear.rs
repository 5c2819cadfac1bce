//! The bound form of methods whose map of space is linear in the handles' motions and meets the handles exactly.

use glam::{DVec3, Mat3};

use super::falloff::Falloff;
use super::field::{LinearField, SpaceMap};
use crate::handles::Motion;
use crate::method::{BindInput, BoundMethod, Stepped};
use crate::needs::HandleFit;
use crate::{BindError, SolveError};

/// A frame is a product with the map's coefficients.
#[derive(Debug)]
pub(crate) struct BoundLinear {
    field: LinearField,
    solved_count: usize,
    warnings: Vec<String>,
}

impl BoundLinear {
    /// Evaluates the map at every vertex that moves.
    ///
    /// # Errors
    /// Those of [`LinearField::bind`].
    pub fn bind(map: &impl SpaceMap, warnings: Vec<String>, input: &BindInput<'_>) -> Result<Self, BindError> {
        Ok(Self {
            field: LinearField::bind(map, &Falloff::default(), HandleFit::Exact, input)?,
            solved_count: input.partition.solved.len(),
            warnings,
        })
    }
}

impl BoundMethod for BoundLinear {
    fn step(&mut self, motions: &[Motion], displacements: &mut [DVec3]) -> Result<Stepped, SolveError> {
        Ok(Stepped::at_once(0.0, self.field.frame(motions, displacements)))
    }

    fn jacobians(&self, motions: &[Motion], out: &mut [Mat3]) -> bool {
        self.field.jacobians(motions, out);
        true
    }

    fn solved_count(&self) -> usize {
        self.solved_count
    }

    fn warnings(&self) -> Vec<String> {
        self.warnings.clone()
    }
}
