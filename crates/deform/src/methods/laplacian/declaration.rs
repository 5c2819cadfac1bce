//! Laplacian editing as one of the methods.

use glam::DVec3;

use super::{LaplacianEditing, LaplacianSolver, Transforms};
use crate::handles::Motion;
use crate::handles::finite::Finite;
use crate::handles::polar::{Polar, polars_of};
use crate::method::{BindInput, BoundMethod, DeformMethod, FactoredSystem, MethodDeclaration, Stepped};
use crate::needs::{ConstraintKind, Needs, Solve};
use crate::{BindError, Picture, Remedy, SolveError, Warning};

pub(crate) const DECLARATION: MethodDeclaration = MethodDeclaration {
    name: "laplacian",
    title: "Wide parts",
    paper: "Laplacian editing",
    when_to_use: "Turns details with the surface, in one step: for moves, and for turns of wide parts up to about \
                  90°. Limbs collapse from about 70° on, and beyond 90° the surface bulges and shrinks unless `steps` \
                  divides the motion.",
    keywords: "laplacian differential coordinates detail similarity implicit",
    picture: Picture::Spikes,
    slider: None,
    options: LaplacianEditing::OPTIONS,
    attachments: &[],
    heeds: &[
        ConstraintKind::SoftHandles,
        ConstraintKind::Continuity,
        ConstraintKind::Stiffness,
    ],
    default: || LaplacianEditing::default().into(),
    first_choice: || LaplacianEditing::default().into(),
};

impl DeformMethod for LaplacianEditing {
    fn declaration(&self) -> &'static MethodDeclaration {
        &DECLARATION
    }

    fn turns_by_moves(&self) -> bool {
        true
    }

    fn needs(&self) -> Needs {
        Needs::Surface {
            reach: 2,
            ordering_power: Some(2),
        }
    }

    fn has_continuity(&self) -> bool {
        true
    }

    fn solve(&self) -> Solve {
        Solve::Direct
    }

    fn row_bytes(&self) -> usize {
        // A ring of triangles has 6 vertices more than the one within it.
        let ring = self.ring as usize;
        let of_ring = 3 * ring * (ring + 1) * 2 * size_of::<u32>();
        match self.transforms {
            Transforms::Implicit if self.steps > 1 => 3000 + of_ring,
            Transforms::Implicit => 3000,
            Transforms::InitialGuess => 500 + of_ring,
            Transforms::None => 500,
        }
    }

    fn bind(&self, input: &BindInput<'_>) -> Result<Box<dyn BoundMethod>, BindError> {
        Ok(Box::new(LaplacianSolver::bind(self, input)?))
    }
}

/// The largest turn that the estimates follow, in radians: 90° with some tolerance.
const LARGE_RAD: f64 = 1.65;

/// The same without any transformation.
const SMALL_RAD: f64 = 0.2;

impl BoundMethod for LaplacianSolver {
    fn step(&mut self, motions: &[Motion], displacements: &mut [DVec3]) -> Result<Stepped, SolveError> {
        let energy = self.frame(motions, displacements)?;
        Ok(Stepped::at_once(energy, Finite::Unknown))
    }

    fn rest(&mut self) {
        self.polars.fill(Polar::default());
    }

    fn energy_of(&self, motions: &[Motion], displacements: &[DVec3]) -> Option<f64> {
        LaplacianSolver::energy_of(self, motions, displacements)
    }

    fn system(&self) -> Option<&dyn FactoredSystem> {
        Some(&self.system)
    }

    fn solved_count(&self) -> usize {
        self.system.columns().len()
    }

    /// A frame is a back-substitution or two, not a product.
    fn step_cost(&self) -> usize {
        8 * self.options.steps as usize * self.solved_count()
    }

    fn blind_to(&self, motions: &[Motion]) -> Vec<Warning> {
        let turns = polars_of(&self.polars, &self.handles, motions)
            .into_iter()
            .map(|polar| polar.turn_rad.length());
        let Some((handle, turn)) = (0..).zip(turns).max_by(|a: &(usize, f64), b| a.1.total_cmp(&b.1)) else {
            return Vec::new();
        };
        let degrees = turn.to_degrees();
        match self.options.transforms {
            Transforms::None if turn > SMALL_RAD => vec![Warning::of_handle(handle, |handle| {
                format!(
                    "`laplacian` turns no details if `transforms` is \"none\", but {handle} turns by {degrees:.0}°: \
                     take \"implicit\""
                )
            })],
            Transforms::Implicit | Transforms::InitialGuess if turn > LARGE_RAD * f64::from(self.options.steps) => {
                let steps = (turn / LARGE_RAD).ceil();
                let others = Remedy::FollowingTurns(degrees.ceil() as u16);
                vec![Warning::of_handle(handle, |handle| {
                    format!(
                        "{handle} turns by {degrees:.0}°, but `laplacian` follows about 90° a step: set `steps` to \
                         {steps:.0}, or take {others}"
                    )
                })]
            }
            _ => Vec::new(),
        }
    }
}
