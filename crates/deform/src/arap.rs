//! As-rigid-as-possible deformation: each vertex's cell turned as well as it can be, and as little bent as possible.
//!
//! The energy is a function of the positions alone, E(p) = min over the cells' rotations, and is minimised by L-BFGS on
//! top of the factored Laplacian with a line search on the true energy, so it never rises. With no memory a step *is*
//! one iteration of the usual local/global method (Sorkine & Alexa 2007), which descends slowly: an iteration of ours
//! costs a tenth more and needs an order of magnitude fewer.
//!
//! Parts: `domain` numbers the vertices, `rims` and `spokes` make the two energies' `cells` and `bending` adds the smooth
//! one's term, `shape` evaluates them, `matrix` and `precondition` make the global step and the handles' weights, `start`
//! chooses where to begin, `history` gives the direction and `descent` takes the step.

mod bending;
mod cells;
mod descent;
mod domain;
mod history;
mod matrix;
mod options;
mod precondition;
mod rims;
mod shape;
mod spokes;
mod start;

use glam::DVec3;
use pliant_mesh::{Cancel, Progress, SurfaceVertex};

pub use self::options::{Arap, ArapEnergy};

use self::cells::{Cells, quad, vector};
use self::domain::Domain;
use self::history::{Field, History};
use self::precondition::{MapRoom, PreconditionError, Preconditioner, WeightInput};
use self::shape::{Guesses, IDENTITY, Scratch, Shape};
use crate::blend::HandleFrame;
use crate::handle::{Handle, Motion};
use crate::partition::Partition;
use crate::sparse::Elimination;
use crate::{BindError, Laplacian, Ordering, Problem, Role};

/// The bound method, with the shape it is at.
#[derive(Debug)]
pub(crate) struct ArapSolver {
    options: Arap,
    domain: Domain,
    cells: Cells,
    preconditioner: Preconditioner,
    /// Handles' harmonic weights, one row a cell.
    weights: Vec<f64>,
    /// The handles in coordinates relative to `world_origin`.
    handles: Vec<HandleFrame>,
    /// Of each handle: its surface vertices with their coordinates, and the local ones among them.
    prescribed: Vec<Vec<Prescribed>>,
    /// Rest positions of the local vertices relative to the first handle's centre.
    rest: Vec<DVec3>,
    current: Shape,
    trial: Shape,
    scratch: Scratch,
    map_room: MapRoom,
    history: History,
    /// Uphill, in units of `unit`.
    direction: Field,
    /// The length that single-precision fields are measured in: about the model's.
    unit: f64,
    /// The motions that `current` is a shape for.
    motions: Vec<Motion>,
    state: State,
    /// How many targets were set since the rest shape, and the energy of the last blend from it.
    drag_frames: u32,
    blend_energy: f64,
    mollified_faces: usize,
}

/// How far the present targets are.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
enum State {
    /// On its way.
    Descending,
    /// At a minimum, to the tolerance.
    Converged,
}

#[derive(Clone, Copy, Debug)]
struct Prescribed {
    surface_vertex: u32,
    /// [`domain::ABSENT`] where no cell sees it.
    local: u32,
    coordinates: [f64; 4],
}

impl ArapSolver {
    /// Numbers, factors, and solves for the weights of `handles`.
    pub fn bind(
        problem: &Problem,
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
            ArapEnergy::SpokesAndRims => order,
            ArapEnergy::Smooth => domain.vertices[..domain.cell_count].to_vec(),
        };
        rows.sort_unstable();
        let laplacian = Laplacian::with_rows(surface, topology, problem.stiffness, &rows);
        let mollified_faces = laplacian.mollified_faces();
        cancel.check()?;
        progress.set(0.3);
        let mut cells = match options.energy {
            ArapEnergy::Spokes => spokes::cells(surface, &laplacian, &domain),
            ArapEnergy::SpokesAndRims | ArapEnergy::Smooth => {
                rims::cells(surface, topology, problem.stiffness, &domain)
            }
        };
        let system = match options.energy {
            ArapEnergy::Spokes | ArapEnergy::SpokesAndRims => matrix::assemble(&laplacian, &domain, options.energy),
            ArapEnergy::Smooth => {
                bending::add(&mut cells, surface, &laplacian, &domain, options.smoothness);
                let bending = bending::stiffness(surface, &domain, options.smoothness);
                matrix::assemble_plate(laplacian, &domain, bending)
            }
        };
        cancel.check()?;
        progress.set(0.4);
        let component = |local: usize| topology.component(SurfaceVertex(domain.vertices[local]));
        let handle_of = |local: u32| match problem.roles[domain.vertices[local as usize] as usize] {
            Role::Handle(handle) => Some(usize::from(handle)),
            Role::Fixed | Role::Free => None,
        };
        let unheld = |local: u32| !partition.held[component(local as usize) as usize];
        let input = WeightInput {
            domain: &domain,
            handle_count: handles.len(),
            handle_of: &handle_of,
            unheld: &unheld,
        };
        let (preconditioner, weights) =
            Preconditioner::of(&system, &ends, &input, cancel).map_err(|error| match error {
                PreconditionError::Pivot(local) => BindError::NotPositiveDefinite {
                    component: component(local),
                    vertex: domain.vertices[local],
                },
                PreconditionError::Inaccurate(local, error) => BindError::Inaccurate {
                    component: component(local),
                    vertex: domain.vertices[local],
                    error,
                },
                PreconditionError::Memory => BindError::OutOfMemory {
                    free_count: domain.solved_count,
                },
                PreconditionError::Cancelled => BindError::Cancelled(pliant_mesh::Cancelled),
            })?;
        cancel.check()?;
        progress.set(0.9);
        let world_origin = handles.first().map_or(DVec3::ZERO, |handle| handle.world_centre);
        let world_rest = |surface_vertex: u32| surface.positions[surface_vertex as usize];
        let prescribed = handles
            .iter()
            .map(|handle| {
                let of = |&surface_vertex: &u32| Prescribed {
                    surface_vertex,
                    local: domain.local_of[surface_vertex as usize],
                    coordinates: handle.coordinates(world_rest(surface_vertex)),
                };
                handle.vertices.iter().map(of).collect()
            })
            .collect();
        let rest: Vec<DVec3> = domain.vertices.iter().map(|&v| world_rest(v) - world_origin).collect();
        let at_rest = Shape::at_rest(domain.vertices.len(), domain.cell_count, domain.solved_count);
        let unit = if cells.scale > 0.0 { cells.scale.sqrt() } else { 1.0 };
        progress.set(1.0);
        Ok(Self {
            options: options.clone(),
            cells,
            preconditioner,
            weights,
            handles: handles
                .iter()
                .map(|handle| HandleFrame {
                    centre: handle.world_centre - world_origin,
                    radius: handle.radius,
                })
                .collect(),
            prescribed,
            rest,
            current: at_rest.clone(),
            trial: at_rest,
            scratch: Scratch::default(),
            map_room: MapRoom::default(),
            history: History::default(),
            direction: Field::new(),
            unit,
            motions: vec![Motion::default(); handles.len()],
            state: State::Converged,
            drag_frames: 0,
            blend_energy: 0.0,
            mollified_faces,
            domain,
        })
    }

    /// How many triangles were too flat for cotangents of their own.
    pub fn mollified_faces(&self) -> usize {
        self.mollified_faces
    }

    /// How many numbers the factor stores.
    pub fn factor_len(&self) -> usize {
        self.preconditioner.stored()
    }

    /// How many vertices are solved for.
    pub fn solved_count(&self) -> usize {
        self.domain.solved_count
    }

    /// Most iterations towards one set of targets.
    pub fn max_iterations(&self) -> u32 {
        self.options.max_iterations
    }

    /// The handles' surface vertices and their coordinates.
    pub fn prescribed(&self, handle: usize) -> impl Iterator<Item = (u32, [f64; 4])> + '_ {
        self.prescribed[handle]
            .iter()
            .map(|p| (p.surface_vertex, p.coordinates))
    }

    /// The energy in units of the rest shape's, which a change of the model's scale leaves as it is.
    fn relative(&self, energy: f64) -> f64 {
        let scale = self.cells.scale;
        if scale > 0.0 { energy / scale } else { 0.0 }
    }

    /// The energy of any displacements, one a surface vertex.
    pub fn energy_of(&self, displacements: &[DVec3]) -> f64 {
        let mut shape = self.current.clone();
        for (own, &vertex) in shape.displacements.iter_mut().zip(&self.domain.vertices) {
            *own = quad(displacements[vertex as usize], 0.0);
        }
        self.cells.evaluate(&mut shape, Guesses::Own, &mut Scratch::default());
        self.relative(shape.energy)
    }

    /// Back to the rest shape.
    pub fn rest(&mut self) {
        self.motions.fill(Motion::default());
        self.current.displacements.fill([0.0; 4]);
        self.current.rotations.fill(IDENTITY);
        self.current.gradient.fill([0.0; 4]);
        self.current.energy = 0.0;
        self.history.clear();
        self.drag_frames = 0;
        self.state = State::Converged;
    }

    /// One step towards `motions`: writes the solved vertices' displacements. Says whether it converged, and the energy.
    pub fn step(&mut self, motions: &[Motion], displacements: &mut [DVec3]) -> (bool, f64) {
        // One entry into the pool: each of the many short loops would wait for it otherwise.
        rayon::scope(|_| {
            if self.motions != motions {
                self.start(motions);
            }
            if self.state == State::Descending {
                self.descend();
            }
        });
        for (&vertex, &own) in self.domain.vertices[..self.domain.solved_count]
            .iter()
            .zip(&self.current.displacements)
        {
            displacements[vertex as usize] = vector(own);
        }
        let energy = self.current.energy;
        if !energy.is_finite() {
            // The gate refuses it; the next targets begin afresh.
            self.rest();
            return (true, energy);
        }
        (self.state == State::Converged, self.relative(energy))
    }
}
