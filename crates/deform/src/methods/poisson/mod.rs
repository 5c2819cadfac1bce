//! Gradient-based editing [YZX+04, ZRKS05; BS08, sections 3.1.1 and 3.2.1 to 3.2.3]: the handles' rotations and
//! stretches are spread over the surface, each face's edges follow, and a Poisson system rejoins the faces.
//!
//! Parts: `propagation` gives each handle's weight at each vertex, `handles::polar` blends the handles' maps,
//! `operators::gradients` makes the right-hand side, and `systems::poisson_system` solves.

mod declaration;
mod options;
pub(crate) mod propagation;

use glam::DVec3;

pub(crate) use self::declaration::DECLARATION;
pub use self::options::{Poisson, Propagation};

use self::propagation::weights;
use crate::handles::polar::{Blend, Polar, polars_of};
use crate::handles::{Handle, Motion};
use crate::method::BindInput;
use crate::operators::gradients::{EdgeChanges, Gradients};
use crate::systems::plate_energy::PlateEnergy;
use crate::systems::poisson_system::PoissonSystem;
use crate::{BindError, SolveError};

/// The bound method.
#[derive(Debug)]
pub(crate) struct PoissonSolver {
    system: PoissonSystem,
    gradients: Gradients,
    /// Each handle's weight, from 0 to 1: one row for each local vertex.
    weights: Vec<f64>,
    handles: Vec<Handle>,
    /// The handles' maps at the last step. Turns continue from them, so that one beyond half a turn is kept.
    polars: Vec<Polar>,
    /// True if something is fixed.
    is_held: bool,
    scratch: Scratch,
}

/// Buffers kept from frame to frame, so that no frame allocates them.
#[derive(Clone, Debug, Default)]
struct Scratch {
    changes: Vec<EdgeChanges>,
    load: Vec<[f64; 3]>,
    field: Vec<[f64; 3]>,
}

impl PoissonSolver {
    /// Factors the Laplacian and propagates the handles' weights.
    pub fn bind(options: &Poisson, input: &BindInput<'_>) -> Result<Self, BindError> {
        let &BindInput { problem, progress, .. } = input;
        let system = PoissonSystem::bind(
            PlateEnergy::of_power(1),
            problem.stiffness,
            input.refactorisation,
            input,
        )?;
        progress.set(0.6);
        let weights = weights(options.propagation, &system, input)?;
        progress.set(0.9);
        let laplacian = &system.operator().laplacian;
        let gradients = Gradients::of(
            problem.surface,
            problem.topology,
            problem.stiffness,
            laplacian,
            system.columns(),
        );
        input.cancel.check()?;
        progress.set(1.0);
        let scratch = Scratch {
            field: system.field(),
            ..Scratch::default()
        };
        Ok(Self {
            system,
            gradients,
            weights,
            handles: input.handles.to_vec(),
            polars: vec![Polar::default(); input.handles.len()],
            is_held: input.partition.held.contains(&true),
            scratch,
        })
    }

    /// Solves for the motions; returns the energy.
    fn frame(&mut self, motions: &[Motion], displacements: &mut [DVec3]) -> Result<f64, SolveError> {
        self.polars = polars_of(&self.polars, &self.handles, motions);
        let mut scratch = std::mem::take(&mut self.scratch);
        let Self { system, gradients, .. } = &*self;
        self.change(&self.polars, &mut scratch.changes);
        gradients.divergence(&scratch.changes, system.membrane_stiffness(), &mut scratch.load);
        system.prescribe(motions, &mut scratch.field);
        let solved = system.solve(&scratch.load, &mut scratch.field);
        system.write(&scratch.field, displacements);
        let energy = self.energy(&scratch.changes, &scratch.field);
        self.scratch = scratch;
        solved.map(|()| energy)
    }

    /// Each face's edges under the blend of the maps by the mean weights of its corners.
    fn change(&self, polars: &[Polar], changes: &mut Vec<EdgeChanges>) {
        let count = polars.len();
        let of_face = |locals: &[u32; 3]| {
            let [a, b, c] = locals.map(|local| &self.weights[local as usize * count..][..count]);
            let mean = (0..count).map(|handle| (a[handle] + b[handle] + c[handle]) / 3.0);
            let blend = Blend::of(polars, mean);
            move |edge: DVec3| blend.change(edge)
        };
        self.gradients.change(|face| of_face(&face.locals), changes);
    }

    /// The energy of a field: the faces' and the springs', in units of the rest shape's.
    fn energy(&self, changes: &[EdgeChanges], field: &[[f64; 3]]) -> f64 {
        let scale = self.system.membrane_stiffness() * self.gradients.scale;
        let springs = self.system.spring_energy(field);
        self.gradients.energy(changes, field) + if scale > 0.0 { springs / scale } else { 0.0 }
    }

    /// Like [`PoissonSolver::energy`], for any displacements and these motions.
    fn energy_of(&self, motions: &[Motion], displacements: &[DVec3]) -> f64 {
        let mut changes = Vec::new();
        self.change(&polars_of(&self.polars, &self.handles, motions), &mut changes);
        self.energy(&changes, &self.system.read(motions, displacements))
    }

    /// A handle's weight at each surface vertex, 0 where it has none.
    fn weights_of(&self, handle: usize, weights: &mut [f64]) {
        let rows = self.weights.chunks_exact(self.handles.len());
        for (&vertex, row) in self.system.vertices().iter().zip(rows) {
            weights[vertex as usize] = row[handle];
        }
    }
}
