//! Rigid cells as one of the methods.

use glam::{DMat3, DVec3, Mat3};

use super::SpacePrimo;
use super::coupling::joined;
use super::octree::{CELL, Octree};
use super::weights::weigh;
use crate::budget::bytes_of;
use crate::handles::Motion;
use crate::handles::finite::Finite;
use crate::handles::turns::Followed;
use crate::method::{BindInput, BoundMethod, DeformMethod, MethodDeclaration, Stepped};
use crate::methods::primo::bodies::Bodies;
use crate::needs::{ConstraintKind, Needs, Solve};
use crate::space::blend::{Affine, Blend, Share};
use crate::space::neighbours::Neighbours;
use crate::sparse::system_error::SystemError;
use crate::{BindError, Picture, SolveError};

pub(crate) const DECLARATION: MethodDeclaration = MethodDeclaration {
    name: "space-primo",
    title: "Rubber block",
    paper: "rigid cells",
    when_to_use: "Bends the space around the shape like rubber, step by step: for even bends and twists of closed \
                  shapes, and of loose or broken pieces.",
    keywords: "space primo rigid cells octree botsch rubber solid nonlinear points soup",
    picture: Picture::Cells,
    slider: None,
    options: SpacePrimo::OPTIONS,
    attachments: &[],
    heeds: &[ConstraintKind::SoftHandles, ConstraintKind::Stiffness],
    default: || SpacePrimo::default().into(),
    first_choice: || SpacePrimo::default().into(),
};

/// The reach over which the cells' errors are blended out, in sides of the small cells.
const REACH: f64 = 2.0;

/// The bound method.
#[derive(Debug)]
pub(super) struct BoundCells {
    pub bodies: Bodies,
    /// The cells' middles.
    world_centres: Vec<DVec3>,
    blend: Blend,
    /// The cells' motions in the last step.
    affine: Vec<Affine>,
}

impl DeformMethod for SpacePrimo {
    fn declaration(&self) -> &'static MethodDeclaration {
        &DECLARATION
    }

    /// The cells give way where they twist most.
    fn follows_turns(&self) -> Option<Followed> {
        Some(Followed::by_necks(120.0))
    }

    fn needs(&self) -> Needs {
        Needs::Points
    }

    fn solve(&self) -> Solve {
        Solve::Iterative {
            max_iterations: self.max_iterations,
        }
    }

    fn row_bytes(&self) -> usize {
        // Up to about twenty shares of cells and those of the handles nearby, twice during their collection.
        300 + 60 * size_of::<Share>()
    }

    fn handle_row_bytes(&self) -> usize {
        0
    }

    fn bind(&self, input: &BindInput<'_>) -> Result<Box<dyn BoundMethod>, BindError> {
        Ok(Box::new(bound(self, input)?))
    }
}

/// Cuts space into cells, joins them, factors, and weighs every vertex.
pub(super) fn bound(options: &SpacePrimo, input: &BindInput<'_>) -> Result<BoundCells, BindError> {
    let free_count = input.partition.solved.len();
    let over = |limit| BindError::budget(free_count, limit);
    let mut octree = Octree::of(input, options.cells as usize).map_err(over)?;
    let of_cells = bytes_of(octree.cells.len(), CELL);
    let budget = input.partition.budget.without(of_cells).map_err(over)?;
    input.cancel.check()?;
    input.progress.set(0.3);
    let world_origin = input.handles.first().map_or(DVec3::ZERO, |handle| handle.world_centre);
    let joints = joined(&mut octree, input, world_origin)?;
    let is_held = (0..joints.count()).any(|cell| {
        let mut sides = joints.sides(cell).iter();
        sides.any(|side| side.other as usize == joints.count())
    });
    input.progress.set(0.4);
    let bodies = Bodies::of(
        joints,
        input.handles,
        world_origin,
        |_| !is_held,
        options.tolerance,
        budget,
        input.cancel,
    );
    let bodies =
        bodies.map_err(|error| SystemError::of_definite(error).into_bind_error(input.problem.topology, free_count))?;
    input.progress.set(0.7);
    let world_centres: Vec<DVec3> = (0..octree.cells.len()).map(|cell| octree.world_centre(cell)).collect();
    let tree = Neighbours::of(&world_centres);
    let blend = Blend::bind(input, REACH * octree.grid.world_side, |place| {
        weigh(&octree, &tree, place)
    })?;
    input.progress.set(1.0);
    let mut bound = BoundCells {
        bodies,
        world_centres,
        blend,
        affine: Vec::new(),
    };
    bound.affine = bound.motions();
    Ok(bound)
}

impl BoundCells {
    /// The cells' motions at the present pose.
    fn motions(&self) -> Vec<Affine> {
        let pose = self.bodies.shown();
        let cells = self.world_centres.iter().enumerate();
        cells
            .map(|(cell, &world_centre)| Affine {
                world_centre,
                linear: pose.turns[cell] - DMat3::IDENTITY,
                shift: pose.shifts[cell],
            })
            .collect()
    }
}

impl BoundMethod for BoundCells {
    fn step(&mut self, motions: &[Motion], displacements: &mut [DVec3]) -> Result<Stepped, SolveError> {
        // The pool is entered once: otherwise each of the many short loops would wait for it.
        rayon::scope(|_| {
            self.bodies.advance(motions);
            self.affine = self.motions();
            self.blend.frame(&self.affine, motions, displacements);
        });
        let (converged, energy) = self.bodies.outcome();
        Ok(Stepped {
            converged,
            stalled: self.bodies.has_stalled(),
            energy,
            finite: Finite::Unknown,
        })
    }

    fn rest(&mut self) {
        self.bodies.rest();
    }

    fn jacobians(&self, motions: &[Motion], out: &mut [Mat3]) -> bool {
        self.blend.jacobians(&self.affine, motions, out);
        true
    }

    fn solved_count(&self) -> usize {
        self.blend.row_count()
    }

    fn factor_len(&self) -> usize {
        self.bodies.factor_len()
    }

    fn step_cost(&self) -> usize {
        self.blend.row_count() + 5 * self.world_centres.len()
    }
}
