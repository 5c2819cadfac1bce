//! A problem bound to a method: new transforms in, displacements out.

use std::sync::Arc;

use glam::{DAffine3, DVec3};
use pliant_mesh::{Cancel, Progress};
use rayon::prelude::*;

use crate::arap::ArapSolver;
use crate::follow::{Followers, followers};
use crate::handle::{Handle, Motion};
use crate::partition::Partition;
use crate::primo::PrimoSolver;
use crate::shell::bases::FRAME_CHUNK;
use crate::shell::plate::{Finite, Known, Plate, repairs};
use crate::sparse::cholesky::{Renewable, Renewal};
use crate::{BindError, Budget, HandleBases, Method, Ordering, Problem, SolveError};

/// A bound problem: everything that does not depend on the handles' transforms is solved.
#[derive(Debug)]
pub struct Bound {
    revision: u64,
    vertex_count: usize,
    free_count: usize,
    handles: Vec<Handle>,
    motions: Vec<Motion>,
    iteration: u32,
    solver: Solver,
    followers: Followers,
    warnings: Vec<String>,
}

/// The factor of a bound linear shell, of which [`Problem::rebind`] takes over what is the same. Cheap to clone.
#[derive(Clone, Debug)]
pub struct Remains(Arc<Renewable>);

impl Remains {
    pub(crate) fn factored(&self) -> &Renewable {
        &self.0
    }

    /// The share of the factor's numbers that were taken over from `other`, 0 to 1.
    pub fn share_of(&self, other: &Self) -> f64 {
        self.0.share_of(&other.0)
    }
}

/// What the method computed; later methods join as variants.
#[derive(Debug)]
enum Solver {
    Plate(Box<Plate>),
    Arap(Box<ArapSolver>),
    Primo(Box<PrimoSolver>),
}

/// How a plate finds what is solved for.
#[derive(Clone, Copy, Debug)]
enum Way {
    Bases,
    BackSubstitution,
}

/// What one step did.
#[derive(Clone, Copy, PartialEq, Debug, Default)]
pub struct Step {
    /// Whether further steps to the same targets would change nothing. Linear methods: always.
    pub converged: bool,
    /// Whether further steps to the same targets do nothing: it converged, or met the method's limit.
    pub finished: bool,
    /// The deformation energy, 0 at rest, which has no unit and does not change with the model's scale: for the linear
    /// shell ½ dᵀ A d (see [`crate::Bilaplacian`]) and what soft handles' springs hold, for ARAP its energy and its springs' over ½ Σ w |e|² of the rest shape. Components
    /// without a handle are left out.
    pub energy: f64,
    /// How many steps were taken towards these targets, this one included.
    pub iteration: u32,
}

impl Bound {
    pub(crate) fn bind(
        problem: &Problem,
        ordering: &Ordering,
        renewal: Renewal,
        budget: Budget,
        progress: &Progress,
        cancel: &Cancel,
    ) -> Result<Self, BindError> {
        let bound = Self::bind_within(problem, ordering, renewal, budget, progress, cancel);
        bound.map_err(|refused| refused.with_culprit(problem.topology, budget))
    }

    fn bind_within(
        problem: &Problem,
        ordering: &Ordering,
        renewal: Renewal,
        budget: Budget,
        progress: &Progress,
        cancel: &Cancel,
    ) -> Result<Self, BindError> {
        cancel.check()?;
        let mut partition = Partition::of(problem)?;
        partition.take_budget(budget)?;
        let (expected, expected_power) = (problem.surface.positions.len(), problem.method.operator_power());
        if (ordering.vertex_count(), ordering.power()) != (expected, expected_power) {
            let (found, found_power) = (ordering.vertex_count(), ordering.power());
            return Err(BindError::Ordering {
                found,
                found_power,
                expected,
                expected_power,
            });
        }
        let positions = &problem.surface.positions;
        let handles: Vec<Handle> = partition
            .handles
            .iter()
            .map(|vertices| Handle::new(vertices.clone(), positions))
            .collect();
        let solver = match problem.method {
            Method::Bilaplacian(options) => {
                let known = Known { ordering, renewal };
                let plate = Plate::bind(problem, options, &partition, &handles, known, progress, cancel)?;
                partition.warnings.extend(plate.warnings());
                Solver::Plate(Box::new(plate))
            }
            Method::Arap(options) => {
                let arap = ArapSolver::bind(problem, options, &partition, &handles, ordering, progress, cancel)?;
                partition.warnings.extend(repairs(arap.mollified_faces()));
                Solver::Arap(Box::new(arap))
            }
            Method::Primo(options) => {
                let primo = PrimoSolver::bind(problem, options, &partition, &handles, progress, cancel)?;
                Solver::Primo(Box::new(primo))
            }
        };
        Ok(Self {
            revision: problem.revision,
            vertex_count: positions.len(),
            free_count: partition.free_count,
            motions: vec![Motion::default(); handles.len()],
            handles,
            iteration: 0,
            solver,
            followers: followers(
                problem.surface,
                problem.topology,
                &partition.following,
                &partition.driven,
            ),
            warnings: partition.warnings,
        })
    }

    /// What binding a problem that differs in a few vertices' roles can take over, where the method has a factor that
    /// can be renewed: the linear shell. There is much only where [`Problem::rebind`] bound it.
    pub fn remains(&self) -> Option<Remains> {
        match &self.solver {
            Solver::Plate(plate) => Some(Remains(Arc::clone(plate.factored()))),
            Solver::Arap(_) | Solver::Primo(_) => None,
        }
    }

    /// Sets where the handles are to go: one affine map of world positions a handle, from rest.
    ///
    /// # Errors
    /// A wrong count, or a transform that is not finite; the former targets stay then.
    pub fn set_targets(&mut self, world_targets: &[DAffine3]) -> Result<(), SolveError> {
        if world_targets.len() != self.handles.len() {
            return Err(SolveError::TargetCount {
                found: world_targets.len(),
                expected: self.handles.len(),
            });
        }
        if let Some(handle) = world_targets.iter().position(|target| !target.is_finite()) {
            return Err(SolveError::TargetNotFinite { handle });
        }
        let motions: Vec<Motion> = self
            .handles
            .iter()
            .zip(world_targets)
            .map(|(handle, target)| handle.motion(target))
            .collect();
        // A method that iterates goes on where it is.
        if matches!(self.solver, Solver::Plate(_)) || motions != self.motions {
            self.iteration = 0;
        }
        self.motions = motions;
        Ok(())
    }

    /// One step towards the targets: fills `displacements`, one a surface vertex, in world units.
    ///
    /// Hard handles' vertices get what their transform says; what nothing moves gets zero to the last bit.
    ///
    /// # Errors
    /// A wrong length, or a result that is not finite; `displacements` is all zero then.
    pub fn step(&mut self, displacements: &mut [DVec3]) -> Result<Step, SolveError> {
        self.frame(displacements, Way::Bases)
    }

    /// As [`Bound::step`], but by solving with the factor in f64 instead of using the handles' bases. What has no bases
    /// takes a step.
    ///
    /// # Errors
    /// As [`Bound::step`].
    pub fn step_by_back_substitution(&mut self, displacements: &mut [DVec3]) -> Result<Step, SolveError> {
        self.frame(displacements, Way::BackSubstitution)
    }

    /// The handles' vertices, what the method makes of them and zeros elsewhere, then the followers and the gate.
    fn frame(&mut self, displacements: &mut [DVec3], way: Way) -> Result<Step, SolveError> {
        if displacements.len() != self.vertex_count {
            displacements.fill(DVec3::ZERO);
            return Err(SolveError::OutputLength {
                found: displacements.len(),
                expected: self.vertex_count,
            });
        }
        self.iteration += 1;
        let mut step = Step {
            converged: true,
            finished: true,
            energy: 0.0,
            iteration: self.iteration,
        };
        let motions = &self.motions;
        if motions.iter().all(Motion::is_rest) {
            clear(displacements);
            match &mut self.solver {
                Solver::Plate(_) => {}
                Solver::Arap(arap) => arap.rest(),
                Solver::Primo(primo) => primo.rest(),
            }
            return Ok(step);
        }
        let mut finite = Finite::Unknown;
        match (&mut self.solver, way) {
            (Solver::Plate(plate), Way::Bases) => {
                finite = plate.frame(motions, displacements);
                step.energy = plate.energy(motions);
            }
            (Solver::Plate(plate), Way::BackSubstitution) => {
                clear(displacements);
                for (handle, motion) in motions.iter().enumerate() {
                    place(plate.prescribed(handle), motion, displacements);
                }
                plate
                    .back_substitute(displacements)
                    .inspect_err(|_| displacements.fill(DVec3::ZERO))?;
                step.energy = plate.energy_of(motions, displacements);
            }
            (Solver::Arap(arap), _) => {
                clear(displacements);
                for (handle, motion) in motions.iter().enumerate() {
                    place(arap.prescribed(handle), motion, displacements);
                }
                (step.converged, step.energy) = arap.step(motions, displacements);
                step.finished = step.converged || self.iteration >= arap.max_iterations();
            }
            (Solver::Primo(primo), _) => {
                clear(displacements);
                for (handle, motion) in motions.iter().enumerate() {
                    place(primo.prescribed(handle), motion, displacements);
                }
                (step.converged, step.energy) = primo.step(motions, displacements);
                step.finished = step.converged || self.iteration >= primo.max_iterations();
            }
        }
        self.followers.carry(displacements);
        if finite == Finite::Unknown || !self.followers.is_empty() {
            gate(displacements)?;
        }
        if !step.energy.is_finite() {
            displacements.fill(DVec3::ZERO);
            return Err(SolveError::EnergyNotFinite);
        }
        Ok(step)
    }

    /// The energy of any displacements, one a surface vertex, as in [`Step::energy`], with soft handles wanting what the
    /// present targets say; `None` where the method has no
    /// energy or the length is wrong.
    pub fn energy_of(&self, displacements: &[DVec3]) -> Option<f64> {
        if displacements.len() != self.vertex_count {
            return None;
        }
        match &self.solver {
            Solver::Plate(plate) => Some(plate.energy_of(&self.motions, displacements)),
            Solver::Arap(arap) => Some(arap.energy_of(&self.motions, displacements)),
            // Its energy is the prisms', not the vertices'.
            Solver::Primo(_) => None,
        }
    }

    /// The handles' bases, where the method is linear.
    pub fn handle_bases(&self) -> Option<&HandleBases> {
        match &self.solver {
            Solver::Plate(plate) => Some(plate.bases()),
            Solver::Arap(_) | Solver::Primo(_) => None,
        }
    }

    /// The energy of the rest shape, as in [`Step::energy`].
    pub fn energy_rest(&self) -> f64 {
        match self.solver {
            Solver::Plate(_) | Solver::Arap(_) | Solver::Primo(_) => 0.0,
        }
    }

    /// Sentences for a person: what components do that lack a handle or a hold, what was repaired.
    pub fn warnings(&self) -> &[String] {
        &self.warnings
    }

    /// How many vertices the surface has: the length of what [`Bound::step`] fills.
    pub fn vertex_count(&self) -> usize {
        self.vertex_count
    }

    /// How many vertices have the role [`crate::Role::Free`].
    pub fn free_count(&self) -> usize {
        self.free_count
    }

    /// How many of them the system is solved for: those that a handle can reach.
    pub fn solved_count(&self) -> usize {
        match &self.solver {
            Solver::Plate(plate) => plate.bases().vertices().len(),
            Solver::Arap(arap) => arap.solved_count(),
            Solver::Primo(primo) => primo.solved_count(),
        }
    }

    /// About what a step costs, in vertices of a method whose steps are cheap: who shows shapes as they come takes fewer
    /// steps between two of them where they are dear. Coupled prisms took 17 ms a step on the survey's bar (5,122 solved
    /// vertices, two cores), so that a shape a step is what keeps a window going.
    pub fn step_cost(&self) -> usize {
        match &self.solver {
            Solver::Plate(_) | Solver::Arap(_) => self.solved_count(),
            Solver::Primo(_) => 20 * self.solved_count(),
        }
    }

    /// How many numbers the system's factor stores, 8 bytes each.
    pub fn factor_len(&self) -> usize {
        match &self.solver {
            Solver::Plate(plate) => plate.factor_len(),
            Solver::Arap(arap) => arap.factor_len(),
            Solver::Primo(primo) => primo.factor_len(),
        }
    }

    /// [`Problem::revision`] of the problem it was bound from.
    pub fn revision(&self) -> u64 {
        self.revision
    }
}

/// Writes where a handle's vertices go.
fn place(vertices: impl Iterator<Item = (u32, [f64; 4])>, motion: &Motion, displacements: &mut [DVec3]) {
    for (vertex, coordinates) in vertices {
        displacements[vertex as usize] = motion.displace(coordinates);
    }
}

/// All zero.
fn clear(displacements: &mut [DVec3]) {
    displacements
        .par_chunks_mut(FRAME_CHUNK)
        .for_each(|chunk| chunk.fill(DVec3::ZERO));
}

/// The one way out: no displacement that is not finite passes.
fn gate(displacements: &mut [DVec3]) -> Result<(), SolveError> {
    let finite = displacements
        .par_chunks(FRAME_CHUNK)
        .all(|chunk| chunk.iter().all(|displacement| displacement.is_finite()));
    if finite {
        return Ok(());
    }
    let vertex = displacements
        .iter()
        .position(|displacement| !displacement.is_finite())
        .unwrap_or_default();
    displacements.fill(DVec3::ZERO);
    Err(SolveError::NotFinite { vertex: vertex as u32 })
}
