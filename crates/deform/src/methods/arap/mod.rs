//! As-rigid-as-possible deformation: each vertex's cell is rotated as a whole and deviates from that rotation as little
//! as possible.
//!
//! The energy is a function of the positions alone, E(p) = min over the cells' rotations, and is minimised by L-BFGS on
//! top of the factored Laplacian with a line search on the true energy, so it never rises. Without history a step *is*
//! one iteration of the usual local/global method [SA07], which descends slowly: our iterations cost a tenth more, and
//! an order of magnitude fewer are needed.
//!
//! Parts: `domain` numbers the vertices, `rims` and `spokes` make the two energies' `cells`, `bending` and `barrier` add
//! the smooth one's terms, `shape` evaluates them in a `fit_pass` and a `gradient_pass`, `matrix` and `precondition` make
//! the global step and the handles' weights, `start` chooses the first shape, `history` gives the direction and `descent`
//! makes the energy one that [`crate::descent`] lowers. For a large surface `clusters` make a small one, whose solver is
//! the `coarse` level and takes the `lead`. At the end of a drag a `second` descent begins from rest.

mod barrier;
mod bend;
mod bending;
mod cells;
pub(crate) mod coarse;
mod declaration;
mod descent;
mod end;
mod fit_pass;
mod gradient_pass;
mod history;
mod lead;
mod matrix;
mod options;
mod precondition;
mod rims;
mod rotation;
mod second;
mod shape;
mod spokes;
mod start;

use glam::DVec3;
use pliant_mesh::{Cancel, Progress, SurfaceVertex};
use rayon::prelude::*;

pub(crate) use self::declaration::DECLARATION;
pub use self::options::{Arap, ArapEnergy};

use self::cells::{Cells, quad, vector};
use self::end::End;
use self::history::{Field, History};
use self::matrix::System;
use self::precondition::{Preconditioner, WeightInput};
use self::shape::{Guesses, IDENTITY, Scratch, Shape};
use crate::coarse::domain::Domain;
use crate::descent::prescribed::Prescribed;
use crate::descent::rule::State;
use crate::descent::springs::Springs;
use crate::handles::blend::HandleFrame;
use crate::handles::offsets::Offsets;
use crate::handles::{Handle, Motion};
use crate::numerical::rows::CHUNK;
use crate::numerical::sums::CHUNKS_A_TASK;
use crate::region::boundary_problem::BoundaryProblem;
use crate::region::partition::Partition;
use crate::sparse::Elimination;
use crate::{BindError, Laplacian, Ordering, Role};

/// The bound method, with its present shape.
#[derive(Debug)]
pub(crate) struct ArapSolver {
    options: Arap,
    domain: Domain,
    cells: Cells,
    springs: Springs<f32>,
    preconditioner: Preconditioner,
    /// Handles' harmonic weights, one row per cell.
    weights: Vec<f64>,
    /// The handles in coordinates relative to `world_origin`.
    handles: Vec<HandleFrame>,
    /// The surface vertices of each hard handle with their coordinates, and the local ones among them.
    prescribed: Vec<Vec<Prescribed>>,
    /// Rest positions of the local vertices relative to the first handle's centre.
    rest: Vec<DVec3>,
    current: Shape,
    trial: Shape,
    scratch: Scratch,
    history: History,
    /// The direction uphill, in units of `unit`.
    direction: Field,
    end: End,
    /// The unit of length of single-precision fields: about the model's size.
    unit: f64,
    /// The motions of the `current` shape.
    motions: Vec<Motion>,
    /// True if vertices of handles have offsets from the motions.
    has_offsets: bool,
    /// True if the offsets changed since the last step.
    has_other_offsets: bool,
    state: State,
    /// The number of further targets without a try of the blend from the rest shape, and the number of targets to skip
    /// after the blend loses.
    until_blend: u32,
    patience: u32,
    mollified_faces: usize,
}

impl ArapSolver {
    /// Numbers the vertices, factors, and solves for the weights of `handles`.
    pub fn bind(
        problem: &BoundaryProblem,
        options: &Arap,
        partition: &Partition,
        handles: &[Handle],
        ordering: &Ordering,
        progress: &Progress,
        cancel: &Cancel,
    ) -> Result<Self, BindError> {
        let (surface, topology) = (problem.surface, problem.topology);
        let Elimination { order, ends } = ordering.elimination(&partition.solved);
        cancel.check()?;
        progress.set(0.1);
        let domain = Domain::of(surface, topology, &order);
        let mut rows = match options.energy {
            ArapEnergy::Spokes => domain.vertices.clone(),
            ArapEnergy::SpokesAndRims | ArapEnergy::Smooth => order,
        };
        rows.sort_unstable();
        let laplacian = Laplacian::with_rows(surface, topology, problem.stiffness, &rows);
        let mollified_faces = laplacian.mollified_faces();
        cancel.check()?;
        progress.set(0.3);
        let (cells, bending) = cells_of(problem, options, &laplacian, &domain);
        let springs = Springs::of(
            (handles, &partition.soft),
            &surface.positions,
            |vertex| Some(laplacian.inverse_areas()[laplacian.local(vertex)?].recip()),
            |square_wave_number| square_wave_number + bending * square_wave_number.powi(2),
            |vertex| Some(domain.local_of[vertex as usize]),
            cells.unit(),
        );
        let system = match options.energy {
            ArapEnergy::Spokes | ArapEnergy::SpokesAndRims => {
                matrix::assemble(&laplacian, &domain, springs.all(), options.energy)
            }
            ArapEnergy::Smooth => matrix::assemble_bending(&cells, &domain, springs.all()),
        };
        let too_large = |_| BindError::OutOfMemory {
            free_count: domain.solved_count,
        };
        let system = system.map_err(too_large)?;
        cancel.check()?;
        progress.set(0.4);
        let (preconditioner, weights) = preconditioner(problem, partition, &domain, &system, &ends, cancel)?;
        cancel.check()?;
        progress.set(0.9);
        let world_origin = handles.first().map_or(DVec3::ZERO, |handle| handle.world_centre);
        let world_rest = |surface_vertex: u32| surface.positions[surface_vertex as usize];
        let rest: Vec<DVec3> = domain.vertices.iter().map(|&v| world_rest(v) - world_origin).collect();
        let at_rest = Shape::at_rest(domain.vertices.len(), domain.cell_count, domain.solved_count);
        let unit = cells.unit();
        progress.set(1.0);
        Ok(Self {
            options: options.clone(),
            cells,
            springs,
            preconditioner,
            weights,
            handles: HandleFrame::of_all(handles, world_origin),
            prescribed: Prescribed::of(handles, &partition.soft, &surface.positions, &domain.local_of),
            rest,
            current: at_rest.clone(),
            trial: at_rest,
            scratch: Scratch::default(),
            history: History::default(),
            direction: Field::new(),
            end: End::Known,
            unit,
            motions: vec![Motion::default(); handles.len()],
            has_offsets: false,
            has_other_offsets: false,
            state: State::Converged,
            until_blend: 0,
            patience: 1,
            mollified_faces,
            domain,
        })
    }

    /// The number of entries that the factor stores.
    pub fn factor_len(&self) -> usize {
        self.preconditioner.stored()
    }

    /// The energy in units of the rest shape's, so that it does not depend on the model's scale.
    fn relative(&self, energy: f64) -> f64 {
        let scale = self.cells.scale;
        if scale > 0.0 { energy / scale } else { 0.0 }
    }

    /// The energy of any displacements, one per surface vertex, for the targets in `motions`.
    pub fn energy_of(&self, motions: &[Motion], displacements: &[DVec3]) -> f64 {
        let mut shape = self.current.clone();
        for (own, &vertex) in shape.displacements.iter_mut().zip(&self.domain.vertices) {
            *own = quad(displacements[vertex as usize], 0.0);
        }
        self.cells.measure(&mut shape, Guesses::Own, &mut Scratch::default());
        let mut springs = self.springs.clone();
        springs.aim(motions);
        shape.add_energy_of(&springs);
        self.relative(shape.energy)
    }

    /// Sets the offsets of handles' vertices from their handles' motions.
    pub fn set_offsets(&mut self, offsets: &Offsets) {
        for vertex in self.prescribed.iter_mut().flatten() {
            vertex.set_offset(offsets);
        }
        self.springs.set_offsets(offsets);
        self.has_offsets = !offsets.is_empty();
        self.has_other_offsets = true;
    }

    /// Returns true if these motions or the offsets differ from the last step's.
    fn takes_other(&mut self, motions: &[Motion]) -> bool {
        std::mem::take(&mut self.has_other_offsets) || self.motions != motions
    }

    /// Returns to the rest shape.
    pub fn rest(&mut self) {
        self.motions.fill(Motion::default());
        self.springs.aim(&self.motions);
        self.current.displacements.fill([0.0; 4]);
        self.current.rotations.fill(IDENTITY);
        self.current.gradient.fill([0.0; 3]);
        self.current.energy = 0.0;
        self.history.clear();
        self.end = End::Known;
        self.springs.loads.clear();
        self.until_blend = 0;
        self.patience = 1;
        self.state = State::Converged;
    }

    /// Returns true if the descent has stalled: no step lowers the energy although the shape has not converged.
    pub fn has_stalled(&self) -> bool {
        self.state == State::Stalled
    }

    /// One step towards `motions`.
    pub fn step(&mut self, motions: &[Motion]) {
        // The pool is entered once: otherwise each of the many short loops would wait for it.
        rayon::scope(|_| {
            if self.takes_other(motions) {
                self.start(motions);
            }
            if self.state == State::Descending {
                self.descend();
            }
        });
    }

    /// Writes the solved vertices' displacements in a shape. Returns its energy.
    fn read(&self, current: &Shape, displacements: &mut [DVec3]) -> f64 {
        let domain = &self.domain;
        displacements
            .par_chunks_mut(CHUNK)
            .zip(domain.local_of.par_chunks(CHUNK))
            .with_min_len(CHUNKS_A_TASK)
            .for_each(|(displacements, locals)| {
                for (displacement, &local) in displacements.iter_mut().zip(locals) {
                    if (local as usize) < domain.solved_count {
                        *displacement = vector(current.displacements[local as usize]);
                    }
                }
            });
        self.relative(current.energy)
    }
}

/// Factors the system, checks the factor, and solves for the handles' weights.
fn preconditioner(
    problem: &BoundaryProblem,
    partition: &Partition,
    domain: &Domain,
    system: &System,
    ends: &[u32],
    cancel: &Cancel,
) -> Result<(Preconditioner, Vec<f64>), BindError> {
    let component = |local: usize| problem.topology.component(SurfaceVertex(domain.vertices[local]));
    let handle_of = |local: u32| match problem.roles[domain.vertices[local as usize] as usize] {
        Role::Handle(handle) => Some(usize::from(handle)),
        Role::Fixed | Role::Free => None,
    };
    let unheld = |local: u32| !partition.held[component(local as usize) as usize];
    let input = WeightInput {
        domain,
        handle_count: partition.handles.len(),
        handle_of: &handle_of,
        unheld: &unheld,
    };
    Preconditioner::of(system, ends, &input, partition.budget, cancel)
        .map_err(|error| error.into_bind_error(problem.topology, domain.solved_count))
}

/// The cells of the options' energy, and the stiffness κ A of its bending term, 0 without one.
fn cells_of(problem: &BoundaryProblem, options: &Arap, laplacian: &Laplacian, domain: &Domain) -> (Cells, f64) {
    let (surface, topology, stiffness) = (problem.surface, problem.topology, problem.stiffness);
    match options.energy {
        ArapEnergy::Spokes => (spokes::cells(surface, laplacian, domain), 0.0),
        ArapEnergy::SpokesAndRims => (rims::cells(surface, topology, stiffness, domain, &[]), 0.0),
        ArapEnergy::Smooth => {
            let bending = bending::stiffness(surface, domain, options.smoothness);
            let ties = bending::ties(surface, topology, domain, bending);
            let mut cells = rims::cells(surface, topology, stiffness, domain, &ties);
            bending::add(&mut cells, &ties);
            (cells, bending)
        }
    }
}
