//! Declares rotation-invariant coordinates as one of the methods.

use std::sync::Arc;

use glam::DVec3;

use super::{Frames, FramesSolver};
use crate::descent::rule::State;
use crate::handles::finite::Finite;
use crate::handles::offsets::Offsets;
use crate::handles::turns::Followed;
use crate::handles::{Motion, only_moved};
use crate::method::{BindInput, BoundMethod, DeformMethod, FactoredSystem, MethodDeclaration, Stepped};
use crate::needs::{ConstraintKind, Needs, Solve};
use crate::{BindError, Picture, Remedy, SolveError, Warning};

pub(crate) const DECLARATION: MethodDeclaration = MethodDeclaration {
    name: "frames",
    title: "Even turns",
    paper: "rotation-invariant coordinates",
    when_to_use: "Solves for the surface's turns and then for its positions, in one step: for turns of several \
                  handles by less than half a turn. A handle that is only moved turns nothing unless `iterations` are \
                  added.",
    keywords: "frames rotation-invariant coordinates local frames linear",
    picture: Picture::Frames,
    slider: None,
    options: Frames::OPTIONS,
    attachments: &[],
    heeds: &[ConstraintKind::SoftHandles, ConstraintKind::Stiffness],
    default: || Frames::default().into(),
    first_choice: || Frames::default().into(),
};

/// In radians: a turn by this much is nearly half a turn, where the blend of two frames has no rotation.
const LARGE_RAD: f64 = 2.97;

impl DeformMethod for Frames {
    fn declaration(&self) -> &'static MethodDeclaration {
        &DECLARATION
    }

    /// Edges join the frames, and the mean of two frames that are half a turn apart has no length.
    fn follows_turns(&self) -> Option<Followed> {
        // With iterations it descends as ARAP over rims does.
        Some(match self.iterations {
            0 => Followed::by_limbs(140.0),
            _ => Followed::by_folds_and_necks(95.0, 140.0),
        })
    }

    fn needs(&self) -> Needs {
        Needs::Surface {
            reach: 1,
            ordering_power: Some(1),
        }
    }

    fn solve(&self) -> Solve {
        match self.iterations {
            0 => Solve::Direct,
            iterations => Solve::Iterative {
                max_iterations: 1 + iterations,
            },
        }
    }

    fn takes_places(&self) -> bool {
        true
    }

    fn bind(&self, input: &BindInput<'_>) -> Result<Box<dyn BoundMethod>, BindError> {
        Ok(Box::new(FramesSolver::bind(self, input)?))
    }
}

impl BoundMethod for FramesSolver {
    fn step(&mut self, motions: &[Motion], displacements: &mut [DVec3]) -> Result<Stepped, SolveError> {
        let state = self.advance(motions, displacements)?;
        Ok(Stepped {
            converged: state == State::Converged,
            stalled: state == State::Stalled,
            energy: self.shape.energy,
            finite: Finite::Unknown,
        })
    }

    fn set_offsets(&mut self, offsets: &Arc<Offsets>) {
        self.system.set_offsets(offsets);
        self.has_other_offsets = true;
    }

    fn rest(&mut self) {
        FramesSolver::rest(self);
    }

    fn energy_of(&self, motions: &[Motion], displacements: &[DVec3]) -> Option<f64> {
        Some(FramesSolver::energy_of(self, motions, displacements))
    }

    fn system(&self) -> Option<&dyn FactoredSystem> {
        Some(&self.system)
    }

    fn solved_count(&self) -> usize {
        self.system.columns().len()
    }

    fn blind_to(&self, motions: &[Motion]) -> Vec<Warning> {
        let turns = self.polars(motions).into_iter().map(|polar| polar.turn_rad.length());
        let mut sentences: Vec<Warning> = (0..)
            .zip(turns)
            .filter(|(_, turn)| *turn > LARGE_RAD)
            .map(|(handle, turn): (usize, f64)| {
                let degrees = turn.to_degrees();
                let others = Remedy::FollowingTurns(degrees.ceil() as u16);
                Warning::of_handle(handle, |handle| {
                    format!(
                        "{handle} turns by {degrees:.0}°, but `frames` follows less than half a turn: take {others}, \
                         which can follow it"
                    )
                })
            })
            .collect();
        if self.options.iterations == 0 {
            sentences.extend(only_moved("`frames`", motions, self.is_held));
        }
        sentences
    }
}
