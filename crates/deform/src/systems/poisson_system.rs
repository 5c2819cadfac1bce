//! A problem's Poisson system A d = b, where b changes from frame to frame and A is factored once.
//!
//! Methods that change differential coordinates and reassemble the surface solve this: at power 1 A is −L, at power 2
//! it is L M⁻¹ L [BS08, equations 15 and 21]. The [`PoissonEquation`](crate::PoissonEquation) knows no handles: it is
//! for functions on a whole surface.

use std::sync::Arc;

use glam::DVec3;
use rayon::prelude::*;

use crate::handles::offsets::Offsets;
use crate::handles::{FRAME_CHUNK, Motion, clear};
use crate::method::{BindInput, FactoredSystem};
use crate::operators::repairs;
use crate::region::boundary_problem::BoundaryProblem;
use crate::region::slender;
use crate::sparse::refactorisation::Refactorisation;
use crate::sparse::system_error::SystemError;
use crate::systems::elimination_plan::EliminationPlan;
use crate::systems::factored::BilaplacianSystem;
use crate::systems::operator::BilaplacianOperator;
use crate::systems::plate_energy::PlateEnergy;
use crate::systems::refine::Outcome;
use crate::systems::setup::{Boundaries, Prescribed, operator};
use crate::{BindError, ReusableFactor, SolveError};

/// The factored system, and the data for setting up and reading its fields: one row for each local vertex of its
/// Laplacian, then one for each spring.
#[derive(Debug)]
pub(crate) struct PoissonSystem {
    system: BilaplacianSystem,
    /// Each handle's places in a field, at its vertices or, if it is soft, at their springs, and their coordinates.
    pub prescribed: Vec<Prescribed>,
    /// The offsets of handles' vertices from their handles' motions.
    offsets: Arc<Offsets>,
}

/// The allowed error of a solution, relative to its largest value.
pub(crate) const TOLERANCE: f64 = 1e-7;

impl PoissonSystem {
    /// Assembles, factors and checks the operator of `energy` under this stiffness, one number a surface vertex.
    ///
    /// # Errors
    /// The bi-Laplacian's errors.
    pub fn bind(
        energy: PlateEnergy,
        stiffness: &[f64],
        refactorisation: Refactorisation,
        input: &BindInput<'_>,
    ) -> Result<Self, BindError> {
        Self::bind_tied(energy, stiffness, refactorisation, input, |_| ())
    }

    /// The same after `tie` has hung further springs on the operator. Their anchors come after those of soft handles in
    /// every field, and their values are the caller's.
    ///
    /// # Errors
    /// The bi-Laplacian's errors.
    pub fn bind_tied(
        energy: PlateEnergy,
        stiffness: &[f64],
        refactorisation: Refactorisation,
        input: &BindInput<'_>,
        tie: impl FnOnce(&mut BilaplacianOperator),
    ) -> Result<Self, BindError> {
        let &BindInput { partition, cancel, .. } = input;
        let problem = BoundaryProblem {
            stiffness,
            ..*input.problem
        };
        let order = energy.power;
        slender::check(
            &partition.triangulation,
            &partition.solved,
            slender::most_edges(order),
            Some(order),
        )?;
        let plan = EliminationPlan::of(input)?;
        let (mut operator, prescribed) = operator(&problem, energy, partition, input.handles, Boundaries::OfLaplacian);
        tie(&mut operator);
        cancel.check()?;
        let refuse = |error| refused(error, input);
        let mut system =
            BilaplacianSystem::planned(operator, &plan, refactorisation, partition.budget, cancel).map_err(refuse)?;
        let mut constant = vec![[1.0]; system.operator.field_len()];
        system.check(&mut constant, cancel).map_err(refuse)?;
        system.settle();
        Ok(Self {
            system,
            prescribed,
            offsets: Arc::default(),
        })
    }

    /// A and its Laplacian.
    pub fn operator(&self) -> &BilaplacianOperator {
        &self.system.operator
    }

    /// k in A = −k L at power 1, also a factor of loads.
    pub fn membrane_stiffness(&self) -> f64 {
        self.operator().stretching + self.operator().bending
    }

    /// The solved local vertices, one for each row of a load.
    pub fn columns(&self) -> &[u32] {
        self.system.columns()
    }

    /// A field of zeros.
    pub fn field<const K: usize>(&self) -> Vec<[f64; K]> {
        vec![[0.0; K]; self.system.operator.field_len()]
    }

    /// Fills in the solved rows of K fields without a load from their other rows.
    ///
    /// # Errors
    /// [`BindError::Inaccurate`] if the solution does not settle; [`BindError::Cancelled`].
    pub fn extend<const K: usize>(&self, field: &mut [[f64; K]], input: &BindInput<'_>) -> Result<(), BindError> {
        let error = self.system.solve(field, input.cancel).error;
        input.cancel.check()?;
        if error <= TOLERANCE {
            return Ok(());
        }
        let vertex = self
            .columns()
            .first()
            .map_or(0, |&local| self.vertices()[local as usize]);
        Err(refused(SystemError::Inaccurate { vertex, error }, input))
    }

    /// Sets the offsets of handles' vertices from their handles' motions.
    pub fn set_offsets(&mut self, offsets: &Arc<Offsets>) {
        self.offsets = Arc::clone(offsets);
    }

    /// Sets the handles' rows of a field to their targets.
    pub fn prescribe(&self, motions: &[Motion], field: &mut [[f64; 3]]) {
        for (own, motion) in self.prescribed.iter().zip(motions) {
            for &(place, coordinates) in own {
                field[place as usize] = self.wanted(motion, place, coordinates);
            }
        }
    }

    /// The target of a handle's row.
    fn wanted(&self, motion: &Motion, place: u32, coordinates: [f64; 4]) -> [f64; 3] {
        let operator = self.operator();
        let vertex = self.vertices()[operator.local_of(place as usize) as usize];
        (motion.displace(coordinates) + self.offsets.at(vertex)).to_array()
    }

    /// Fills in the solved rows of a field of displacements from its other rows and the load.
    ///
    /// # Errors
    /// If the solution stays too inaccurate.
    pub fn solve(&self, load: &[[f64; 3]], field: &mut [[f64; 3]]) -> Result<(), SolveError> {
        settled(self.system.solve_frame(load, field))
    }

    /// A d − b with the springs' forces on the solved vertices, for a field and a load.
    pub fn residual(&self, load: &[[f64; 3]], field: &[[f64; 3]]) -> Vec<[f64; 3]> {
        let mut residual = self.system.scaled_residual(field);
        for ((row, load), scale) in residual.iter_mut().zip(load).zip(self.system.scale()) {
            *row = std::array::from_fn(|k| -row[k] / scale - load[k]);
        }
        residual
    }

    /// Writes a field to the displacements of all surface vertices, zeros elsewhere.
    pub fn write(&self, field: &[[f64; 3]], displacements: &mut [DVec3]) {
        clear(displacements);
        write_field(field, self.vertices(), displacements);
    }

    /// The rows of a field for displacements of all surface vertices; the motions give the springs' targets.
    pub fn read(&self, motions: &[Motion], displacements: &[DVec3]) -> Vec<[f64; 3]> {
        let mut field = self.field();
        for (row, &vertex) in field.iter_mut().zip(self.vertices()) {
            *row = displacements[vertex as usize].to_array();
        }
        let first_spring = self.vertices().len();
        for (own, motion) in self.prescribed.iter().zip(motions) {
            for &(place, coordinates) in own.iter().filter(|(place, _)| *place as usize >= first_spring) {
                field[place as usize] = self.wanted(motion, place, coordinates);
            }
        }
        field
    }

    /// ½ Σ W |c − d|² of the springs.
    pub fn spring_energy(&self, field: &[[f64; 3]]) -> f64 {
        let springs = &self.operator().springs;
        let of = |spring: usize| {
            let pull = DVec3::from_array(self.operator().pull(spring, field));
            0.5 * pull.length_squared() / springs.strength(spring)
        };
        (0..springs.len()).map(of).sum()
    }

    /// The surface vertex of each local one, ascending.
    pub fn vertices(&self) -> &[u32] {
        self.system.operator.laplacian.vertices()
    }
}

impl FactoredSystem for PoissonSystem {
    fn factor_len(&self) -> usize {
        self.system.factor_len()
    }

    fn reusable_factor(&self) -> ReusableFactor {
        ReusableFactor(Arc::clone(self.system.factored()))
    }

    fn warnings(&self) -> Vec<String> {
        let mut sentences: Vec<String> = repairs(self.operator().laplacian.mollified_faces())
            .into_iter()
            .collect();
        sentences.extend(self.system.solution().warnings());
        sentences
    }
}

/// Writes a field's rows to the displacements of `vertices`, which ascend.
pub(crate) fn write_field(field: &[[f64; 3]], vertices: &[u32], displacements: &mut [DVec3]) {
    let place = |vertex: usize| vertices.partition_point(|&other| (other as usize) < vertex);
    displacements
        .par_chunks_mut(FRAME_CHUNK)
        .enumerate()
        .for_each(|(chunk, out)| {
            let first = chunk * FRAME_CHUNK;
            let own = place(first)..place(first + out.len());
            for (&vertex, row) in vertices[own.clone()].iter().zip(&field[own]) {
                out[vertex as usize - first] = DVec3::from_array(*row);
            }
        });
}

/// Whether a frame's solution is accurate enough.
///
/// # Errors
/// If it is not.
pub(crate) fn settled(Outcome { error, .. }: Outcome) -> Result<(), SolveError> {
    // A value that is not finite is found by the check of all displacements, which names the vertex.
    if error.is_finite() && error > TOLERANCE {
        return Err(SolveError::Inaccurate { error });
    }
    Ok(())
}

/// The refusal of a system in the caller's terms.
pub(crate) fn refused(error: SystemError, input: &BindInput<'_>) -> BindError {
    error.into_bind_error(input.problem.topology, input.partition.solved.len())
}
