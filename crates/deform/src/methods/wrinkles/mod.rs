//! Wrinkles learnt from examples [BLB+08]: the bi-Laplacian bends the surface smoothly, and each vertex adds the
//! examples' detail for the strain of the smooth surface there.
//!
//! 1. *Coarse shape.* The bi-Laplacian gives it from the handles. For an example, the vertices of its handles are at
//!    their positions in the example, and fixed vertices rest, because they never move.
//! 2. *Detail.* The difference between an example and its coarse shape, in local frames of the coarse shape. Bickel et
//!    al. keep the gradients of triangles and solve a Poisson system in each frame; displacements in frames need no
//!    solve, and differ only where a detail is large compared with the coarse shape's radius of curvature.
//! 3. *Strain.* The coarse shape is described by the relative changes of the lengths of edges between a few samples of
//!    the surface (`strain`). The strain at a vertex is that of the nearest edges.
//! 4. *Interpolation.* The detail of a vertex is a radial function of its strain (`learnt`).
//!
//! Without examples it is the bi-Laplacian itself.

mod declaration;
mod learnt;
mod options;
mod strain;

use glam::{DMat3, DVec3};
use pliant_mesh::SurfaceVertex;
use rayon::prelude::*;

pub(crate) use self::declaration::DECLARATION;
pub use self::options::Wrinkles;

use self::learnt::Learnt;
use self::strain::Strain;
use crate::budget::bytes_of;
use crate::handles::Motion;
use crate::method::BindInput;
use crate::methods::bilaplacian::detail::frames::RingFrames;
use crate::methods::bilaplacian::solver::BilaplacianSolver;
use crate::numerical::rows::CHUNK;
use crate::region::patch::Patch;
use crate::{BindError, Examples, Role, SolveError};

/// The bound method with examples.
#[derive(Debug)]
pub(crate) struct Wrinkled {
    /// Its bases are in f64, because the strain is a difference of lengths.
    bending: BilaplacianSolver<f64>,
    patch: Patch,
    frames: RingFrames,
    strain: Strain,
    learnt: Learnt,
    /// The weight of each example's detail.
    weights: Vec<f64>,
    /// The names of examples whose details no strain can restore.
    unlearnt: Vec<String>,
    /// The strain and the local vertices of the last frame.
    changes: Vec<f64>,
    posed: Vec<DVec3>,
}

/// Bytes of a solved vertex in the tables of the patch, its frames and its edges.
const ROW: usize = 320;

impl Wrinkled {
    /// Binds the bi-Laplacian, bends it like each example, and learns the difference.
    ///
    /// # Errors
    /// The bi-Laplacian's errors.
    pub fn bind(options: &Wrinkles, examples: &Examples, input: &BindInput<'_>) -> Result<Self, BindError> {
        let &BindInput {
            problem,
            partition,
            cancel,
            progress,
            ..
        } = input;
        let solved = &partition.solved;
        let bending = BilaplacianSolver::<f64>::bind(&options.bending(), input)?;
        let count = examples.shapes.len();
        let tables = bytes_of(solved.len(), ROW + count * Learnt::ROW);
        let factor = bytes_of(bending.factor_len(), size_of::<f64>());
        let left = partition.budget.without(factor).and_then(|left| left.without(tables));
        left.map_err(|limit| BindError::budget(solved.len(), limit))?;
        let positions = &problem.surface.positions;
        let patch = Patch::of(problem, solved, |vertex| positions[vertex]);
        let frames = RingFrames::of(&patch, &problem.surface.triangles, problem.topology);
        cancel.check()?;
        let strain = Strain::of(problem, &patch, options.samples as usize);
        progress.set(0.8);
        let mut learnt = Learnt::new(count, solved.len(), &strain);
        let mut posed = Vec::new();
        for (number, example) in examples.shapes.iter().enumerate() {
            cancel.check()?;
            let own = problem.roles.iter().zip(&*example.displacements);
            let held = |(role, displacement): (&Role, &DVec3)| match role {
                Role::Fixed => DVec3::ZERO,
                Role::Free | Role::Handle(_) => *displacement,
            };
            let mut coarse: Vec<DVec3> = own.map(held).collect();
            let bent = bending.back_substitute(&mut coarse);
            bent.map_err(|error| inaccurate(error, input))?;
            patch.pose(&coarse, &mut posed);
            let detail = |row: usize| {
                let vertex = solved[row] as usize;
                let beyond = example.displacements[vertex] - coarse[vertex];
                frame(&frames, &patch, row, &posed).transpose() * beyond
            };
            let details: Vec<DVec3> = (0..solved.len())
                .into_par_iter()
                .with_min_len(CHUNK)
                .map(detail)
                .collect();
            let mut changes = Vec::new();
            strain.measure(&coarse, &mut changes);
            learnt.add(number, &strain, &changes, details);
        }
        let unlearnt = examples
            .shapes
            .iter()
            .zip(learnt.are_learnt(patch.size))
            .filter(|(_, is_learnt)| !is_learnt)
            .map(|(example, _)| example.name.clone())
            .collect();
        progress.set(1.0);
        let mut wrinkled = Self {
            bending,
            patch,
            frames,
            strain,
            learnt,
            weights: Vec::new(),
            unlearnt,
            changes: Vec::new(),
            posed,
        };
        wrinkled.give(&examples.weights);
        Ok(wrinkled)
    }

    /// Sets the weight of each example's detail; 1 without a weight.
    pub fn give(&mut self, weights: &[Option<f64>]) {
        let weights: Vec<f64> = weights.iter().map(|weight| weight.unwrap_or(1.0)).collect();
        if self.weights != weights {
            self.learnt.weigh(&weights, &self.strain);
            self.weights = weights;
        }
    }

    /// Adds the details to the coarse shape's displacements.
    fn wrinkle(&mut self, displacements: &mut [DVec3]) {
        self.strain.measure(displacements, &mut self.changes);
        self.patch.pose(displacements, &mut self.posed);
        let Self {
            patch,
            frames,
            strain,
            learnt,
            changes,
            posed,
            ..
        } = &*self;
        patch.write(displacements, |row, local| {
            let coarse = posed[local] - patch.rest[local];
            match learnt.detail(row, strain, changes) {
                DVec3::ZERO => coarse,
                detail => coarse + frame(frames, patch, row, posed) * detail,
            }
        });
    }

    /// The coarse shape's displacements with the details: one frame.
    fn frame(&mut self, motions: &[Motion], displacements: &mut [DVec3]) {
        self.bending.frame(motions, displacements);
        self.wrinkle(displacements);
    }

    /// Like [`Wrinkled::frame`], with the factor instead of the bases; returns the energy of the coarse shape.
    fn frame_by_back_substitution(
        &mut self,
        motions: &[Motion],
        displacements: &mut [DVec3],
    ) -> Result<f64, SolveError> {
        self.bending.frame_by_back_substitution(motions, displacements)?;
        let energy = match self.bending.is_affine() {
            true => self.bending.energy(motions),
            false => self.bending.energy_of(motions, displacements),
        };
        self.wrinkle(displacements);
        Ok(energy)
    }
}

/// A row's frame on the coarse shape. A vertex without one has the axes of space.
#[inline]
fn frame(frames: &RingFrames, patch: &Patch, row: usize, posed: &[DVec3]) -> DMat3 {
    frames.frame(patch, row, posed).unwrap_or(DMat3::IDENTITY)
}

/// The refusal if an example's coarse shape stays too inaccurate.
fn inaccurate(error: SolveError, input: &BindInput<'_>) -> BindError {
    let vertex = input.partition.solved.first().copied().unwrap_or_default();
    let error = match error {
        SolveError::Inaccurate { error } => error,
        _ => f64::NAN,
    };
    BindError::Inaccurate {
        component: input.problem.topology.component(SurfaceVertex(vertex)),
        vertex,
        error,
    }
}
