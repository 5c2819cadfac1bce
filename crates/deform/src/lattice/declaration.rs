//! The lattice as one of the methods.

use glam::{DVec3, Mat3};

use super::Lattice;
use super::fit::{fit_bytes, fitted, soft_unit};
use super::grid::Grid;
use crate::handles::Motion;
use crate::method::{
    BindInput, BoundMethod, ConstraintKind, DeformMethod, HandleFit, MethodDeclaration, Needs, Solve, Stepped,
};
use crate::space::affine::AffineParts;
use crate::space::falloff::Falloff;
use crate::space::field::{Coefficients, FIELD_ROW, LinearField, SpaceMap, moving};
use crate::space::fit_samples::{RegionBox, samples};
use crate::{BindError, SolveError};

pub(crate) const DECLARATION: MethodDeclaration = MethodDeclaration {
    name: "lattice",
    title: "Lattice",
    when_to_use: "Bends a box around the surface by a coarse lattice: for broad, soft bends and stretches of anything, \
                  loose pieces included. It fits the handles as well as the lattice can, not exactly.",
    keywords: "lattice ffd free-form deformation box spline space",
    options: Lattice::OPTIONS,
    heeds: &[ConstraintKind::SoftHandles],
    default: || Lattice::default().into(),
    first_choice: || Lattice::default().into(),
};

/// The most samples of a handle, or of what is fixed.
const SAMPLES: usize = 20_000;

/// The bound method.
#[derive(Debug)]
struct BoundLattice {
    field: LinearField,
    solved_count: usize,
}

/// The field of the control points' displacements.
struct LatticeMap<'a> {
    grid: &'a Grid,
    /// Row-major: one entry a control point and handle.
    controls: &'a [[f64; 4]],
    handle_count: usize,
}

impl SpaceMap for LatticeMap<'_> {
    fn coefficients(&self, world_points: &[DVec3], out: &mut [Coefficients]) {
        let count = self.handle_count;
        for (&point, out) in world_points.iter().zip(out.chunks_exact_mut(count)) {
            self.grid.weights(point, |control, weight, gradient| {
                let controls = &self.controls[control * count..][..count];
                for (out, control) in out.iter_mut().zip(controls) {
                    for k in 0..4 {
                        out.value[k] += weight * control[k];
                        out.gradient[k] += gradient * control[k];
                    }
                }
            });
        }
    }
}

impl DeformMethod for Lattice {
    fn declaration(&self) -> &'static MethodDeclaration {
        &DECLARATION
    }

    fn needs(&self) -> Needs {
        Needs::Points
    }

    fn solve(&self) -> Solve {
        Solve::Direct
    }

    fn handle_fit(&self) -> HandleFit {
        HandleFit::LeastSquares
    }

    fn handle_row_bytes(&self) -> usize {
        FIELD_ROW
    }

    fn bind(&self, input: &BindInput<'_>) -> Result<Box<dyn BoundMethod>, BindError> {
        let within = RegionBox::of(input);
        let grid = Grid::new(self, within);
        let solved_count = input.partition.solved.len();
        let bytes = fit_bytes(&grid, input.handles.len());
        let budget = input.partition.budget.without(bytes);
        budget.map_err(|limit| BindError::budget(solved_count, limit))?;
        let samples = samples(input, &within, soft_unit(&grid, self.norm), SAMPLES);
        let affine = AffineParts::fitted(&samples, input.handles, within.middle(), within.diagonal);
        input.progress.set(0.1);
        let controls = fitted(&grid, self.norm, &samples, input.handles, &affine, input.cancel)?;
        input.progress.set(0.5);
        let vertices = moving(HandleFit::LeastSquares, input);
        let falloff = Falloff::of(input.problem, &vertices, self.falloff * within.diagonal);
        let map = LatticeMap {
            grid: &grid,
            controls: &controls,
            handle_count: input.handles.len(),
        };
        let field = LinearField::bind(&map, &falloff, HandleFit::LeastSquares, input)?;
        input.progress.set(1.0);
        Ok(Box::new(BoundLattice { field, solved_count }))
    }
}

impl BoundMethod for BoundLattice {
    fn step(&mut self, motions: &[Motion], displacements: &mut [DVec3]) -> Result<Stepped, SolveError> {
        Ok(Stepped {
            converged: true,
            energy: 0.0,
            finite: self.field.frame(motions, displacements),
        })
    }

    fn jacobians(&self, motions: &[Motion], out: &mut [Mat3]) -> bool {
        self.field.jacobians(motions, out);
        true
    }

    fn solved_count(&self) -> usize {
        self.solved_count
    }
}
