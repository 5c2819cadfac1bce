//! Rotation-invariant coordinates [LSLC05; BS08, sections 3.1.3 and 3.2.4]: the method solves for local frames first
//! and for positions that fit them second.
//!
//! At rest the frames of neighbours differ by a connection, F_j = F_i C_ij. With F_i' = T_i F_i the least squares
//! Σ w_ij |F_j' − F_i' C_ij|² are Σ w_ij |T_j − T_i|²: the tangents of the frames cancel, and the system of 3n unknowns
//! reduces to the Laplacian, L T = 0 with the handles' T prescribed. So T is the sum of the handles' T by harmonic
//! weights, which binding solves for; T is then made a rotation again. The Laplacian has cotangent weights; with the
//! uniform weights of [LSLC05] the shape would depend on the triangles.
//!
//! Positions minimise an energy that sees each face's edges from its three corners c,
//!
//! E = ½ Σ_f ⅓ Σ_c Σ_(ij in f) w_ij |d_j − d_i − (T_c − I) e_ij|²,
//!
//! which gives a Poisson system with the mean of the three T. One factor serves both systems. Iterations lower the same
//! E, with the rotations of free vertices fitted to the positions [SA07, CPSS10], until it is least (`descent`).

mod declaration;
mod descent;
mod fitting;
mod options;
mod state;

use glam::{DMat3, DVec3};

pub(crate) use self::declaration::DECLARATION;
pub use self::options::Frames;

use self::fitting::{Frame, HandleFrame, blend, fit_to};
use self::state::{Descent, Shape};
use crate::descent::rule::State;
use crate::handles::polar::{Polar, polars_of};
use crate::handles::{Handle, Motion};
use crate::method::BindInput;
use crate::methods::poisson::propagation::weights;
use crate::operators::gradients::{EdgeChanges, Gradients};
use crate::systems::plate_energy::PlateEnergy;
use crate::systems::poisson_system::PoissonSystem;
use crate::{BindError, Propagation, SolveError};

/// The bound method.
#[derive(Debug)]
pub(crate) struct FramesSolver {
    options: Frames,
    system: PoissonSystem,
    gradients: Gradients,
    /// Each handle's harmonic weight: one row for each local vertex.
    weights: Vec<f64>,
    handles: Vec<Handle>,
    /// True if a handle or a fixed vertex constrains the component.
    is_held: bool,
    /// The motions that the current shape belongs to.
    motions: Vec<Motion>,
    /// True if the offsets changed since the last step.
    has_other_offsets: bool,
    shape: Shape,
    descent: Descent,
    state: State,
    scratch: Scratch,
}

/// Memory that is kept from frame to frame, so that no frame allocates it.
#[derive(Clone, Debug, Default)]
struct Scratch {
    changes: Vec<EdgeChanges>,
    load: Vec<[f64; 3]>,
    covariances: Vec<DMat3>,
}

impl FramesSolver {
    /// Factors the Laplacian and solves for the handles' weights.
    pub fn bind(options: &Frames, input: &BindInput<'_>) -> Result<Self, BindError> {
        let &BindInput { problem, progress, .. } = input;
        let system = PoissonSystem::bind(
            PlateEnergy::of_power(1),
            problem.stiffness,
            input.refactorisation,
            input,
        )?;
        progress.set(0.6);
        // The system contains the painted stiffness, for frames as for positions.
        let weights = weights(Propagation::Material, &system, input)?;
        progress.set(0.9);
        let gradients = Gradients::of(
            problem.surface,
            problem.topology,
            problem.stiffness,
            &system.operator().laplacian,
            system.columns(),
        );
        input.cancel.check()?;
        progress.set(1.0);
        Ok(Self {
            options: options.clone(),
            weights,
            handles: input.handles.to_vec(),
            is_held: input.partition.held.contains(&true),
            motions: vec![Motion::default(); input.handles.len()],
            has_other_offsets: false,
            shape: Shape {
                frames: vec![Frame::default(); system.vertices().len()],
                field: system.field(),
                energy: 0.0,
            },
            descent: Descent::default(),
            state: State::Converged,
            scratch: Scratch::default(),
            gradients,
            system,
        })
    }

    /// Computes the linear shape for new motions, or takes one step of the descent for unchanged ones; returns the
    /// state.
    fn advance(&mut self, motions: &[Motion], displacements: &mut [DVec3]) -> Result<State, SolveError> {
        let is_same = !std::mem::take(&mut self.has_other_offsets) && self.motions == motions;
        let solved = if self.options.iterations > 0 && is_same {
            match self.state {
                State::Descending => self.descend(),
                State::Converged | State::Stalled => Ok(self.state),
            }
        } else {
            self.motions.copy_from_slice(motions);
            self.descent.restart();
            blend(
                &handle_frames(&self.handles, motions),
                &self.weights,
                &mut self.shape.frames,
            );
            let state = match self.options.iterations {
                0 => State::Converged,
                _ => State::Descending,
            };
            self.solve(motions).map(|()| state)
        };
        self.system.write(&self.shape.field, displacements);
        if solved.is_err() || !self.shape.energy.is_finite() {
            // The next targets start from rest.
            self.rest();
        }
        self.state = solved?;
        Ok(self.state)
    }

    /// Solves for the positions that fit the frames.
    fn solve(&mut self, motions: &[Motion]) -> Result<(), SolveError> {
        self.find_load();
        let Self {
            system, shape, scratch, ..
        } = self;
        system.prescribe(motions, &mut shape.field);
        system.solve(&scratch.load, &mut shape.field)?;
        self.shape.energy = self.energy(&self.shape.frames, &self.shape.field);
        Ok(())
    }

    /// Finds the load b of the present frames.
    fn find_load(&mut self) {
        let Self {
            system,
            gradients,
            shape,
            scratch,
            ..
        } = self;
        let frames = &shape.frames;
        gradients.change(
            |face| {
                let [a, b, c] = face.locals.map(|local| frames[local as usize].change);
                let mean = (a + b + c) * (1.0 / 3.0);
                move |edge| mean * edge
            },
            &mut scratch.changes,
        );
        gradients.divergence(&scratch.changes, system.membrane_stiffness(), &mut scratch.load);
    }

    /// E and the springs' energy, in units of the rest shape's ½ Σ w |e|².
    fn energy(&self, frames: &[Frame], field: &[[f64; 3]]) -> f64 {
        let faces = self.gradients.total(|_, face| {
            let [u, v] = face.moved(field);
            let corner = |local: u32| {
                let [own_u, own_v] = face.mapped(frames[local as usize].change);
                face.square([u - own_u, v - own_v])
            };
            face.locals.map(corner).iter().sum::<f64>() / 3.0
        });
        let scale = self.system.membrane_stiffness() * self.gradients.scale;
        let springs = self.system.spring_energy(field);
        faces + if scale > 0.0 { springs / scale } else { 0.0 }
    }

    /// Returns the energy of any displacements with the frames of the linear solution or, with iterations, with the
    /// frames that fit best.
    fn energy_of(&self, motions: &[Motion], displacements: &[DVec3]) -> f64 {
        let field = self.system.read(motions, displacements);
        let mut frames = vec![Frame::default(); self.shape.frames.len()];
        blend(&handle_frames(&self.handles, motions), &self.weights, &mut frames);
        if self.options.iterations > 0 {
            fit_to(
                &self.gradients,
                self.system.columns(),
                &field,
                &mut Vec::new(),
                &mut frames,
            );
        }
        self.energy(&frames, &field)
    }

    /// Returns to the rest shape.
    fn rest(&mut self) {
        self.motions.fill(Motion::default());
        self.shape.frames.fill(Frame::default());
        self.shape.field.fill([0.0; 3]);
        self.shape.energy = 0.0;
        self.descent.restart();
        self.state = State::Converged;
    }

    /// The handles' maps; a turn by more than half a turn becomes the shorter one in the opposite direction.
    fn polars(&self, motions: &[Motion]) -> Vec<Polar> {
        polars(&self.handles, motions)
    }
}

fn polars(handles: &[Handle], motions: &[Motion]) -> Vec<Polar> {
    polars_of(&vec![Polar::default(); handles.len()], handles, motions)
}

fn handle_frames(handles: &[Handle], motions: &[Motion]) -> Vec<HandleFrame> {
    polars(handles, motions).iter().map(HandleFrame::of).collect()
}
