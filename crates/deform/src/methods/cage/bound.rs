//! The bound cage: its motion by handles and by hand, frame by frame.

use glam::{DVec3, Mat3};

use super::by_hand::ByHand;
use super::conformal::Conformal;
use super::green_steps::Progressed;
use crate::SolveError;
use crate::handles::Motion;
use crate::handles::controls::Controls;
use crate::handles::finite::Finite;
use crate::method::{BoundMethod, Stepped};
use crate::space::field::LinearField;

/// The bound method.
#[derive(Debug)]
pub(super) struct BoundCage {
    pub field: Field,
    pub controls: Controls,
    pub solved_count: usize,
    pub warnings: Vec<String>,
}

/// The map from the cage to the points.
#[derive(Debug)]
pub(super) enum Field {
    /// A linear field, with the moves by hand if the cage was brought.
    Linear(Box<LinearField>, Option<Box<ByHand>>),
    Conformal(Box<Conformal>),
}

impl BoundMethod for BoundCage {
    fn step(&mut self, motions: &[Motion], displacements: &mut [DVec3]) -> Result<Stepped, SolveError> {
        let finite = match &mut self.field {
            Field::Linear(field, by_hand) => {
                let finite = field.frame(motions, displacements);
                match (by_hand, self.controls.corrected()) {
                    (Some(by_hand), Some(moves)) => {
                        by_hand.add(moves, displacements);
                        Finite::Unknown
                    }
                    _ => finite,
                }
            }
            Field::Conformal(conformal) => {
                let state = conformal.step(&self.controls, motions, displacements);
                return Ok(Stepped {
                    converged: state == Progressed::Converged,
                    stalled: state == Progressed::Stalled,
                    energy: conformal.energy(),
                    finite: Finite::Unknown,
                });
            }
        };
        Ok(Stepped::at_once(0.0, finite))
    }

    fn rest(&mut self) {
        if let Field::Conformal(conformal) = &mut self.field {
            conformal.rest();
        }
    }

    fn jacobians(&self, motions: &[Motion], out: &mut [Mat3]) -> bool {
        match &self.field {
            Field::Linear(field, by_hand) => {
                field.jacobians(motions, out);
                if let (Some(by_hand), Some(moves)) = (by_hand, self.controls.corrected()) {
                    by_hand.add_jacobians(moves, out);
                }
                true
            }
            Field::Conformal(conformal) => conformal.jacobians(&self.controls, motions, out),
        }
    }

    fn controls(&self) -> Option<&Controls> {
        Some(&self.controls)
    }

    fn controls_mut(&mut self) -> Option<&mut Controls> {
        Some(&mut self.controls)
    }

    fn control_positions(&self, motions: &[Motion]) -> Vec<DVec3> {
        match &self.field {
            Field::Linear(..) => self.controls.positions(motions),
            Field::Conformal(conformal) => conformal.control_positions(&self.controls, motions),
        }
    }

    /// Twenty thousand multiplications take about as long as a vertex of a cheap step.
    fn step_cost(&self) -> usize {
        match &self.field {
            Field::Linear(..) => self.solved_count,
            Field::Conformal(conformal) => self.solved_count + conformal.work() / 20_000,
        }
    }

    fn warnings(&self) -> Vec<String> {
        self.warnings.clone()
    }

    fn solved_count(&self) -> usize {
        self.solved_count
    }
}
