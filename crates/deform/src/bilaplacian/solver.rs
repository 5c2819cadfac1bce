//! The bound bi-Laplacian: its binding, and its frames, from the bases or by back substitution.

use std::sync::Arc;

use glam::DVec3;
use pliant_mesh::{Cancel, SurfaceVertex};

use crate::bilaplacian::columns::{energy_blocks, solve_columns};
use crate::bilaplacian::elimination_plan::EliminationPlan;
use crate::bilaplacian::factored::BilaplacianSystem;
use crate::bilaplacian::setup::operator;
use crate::bilaplacian::system_error::SystemError;
use crate::handles::bases::{Stored, frame};
use crate::handles::{Motion, clear};
use crate::method::{BindInput, Finite};
use crate::operators::repairs;
use crate::region::partition::Partition;
use crate::region::slender;
use crate::sparse::refactorisation::RenewableFactor;
use crate::{Bilaplacian, BindError, HandleBases, Problem, SolveError};

/// The bound bi-Laplacian, with handle bases of the precision `T`.
#[derive(Debug)]
pub(crate) struct BilaplacianSolver<T = f32> {
    system: BilaplacianSystem,
    bases: HandleBases<T>,
    /// Each handle's places in a field, at its vertices or, where it is soft, at their springs, and their coordinates.
    prescribed: Vec<Vec<(u32, [f64; 4])>>,
    /// E = ½ Σ_hk tr(X_hᵀ G_hk X_k) over the motions' 4×3 matrices X; row-major, one 4×4 block a pair of handles.
    energy_blocks: Vec<[[f64; 4]; 4]>,
}

/// How far off a solution may be, relative to its largest value.
const TOLERANCE: f64 = 1e-7;

impl<T: Stored> BilaplacianSolver<T> {
    /// Assembles, factors, checks, and solves for the bases of `handles`.
    pub fn bind(options: &Bilaplacian, input: &BindInput<'_>) -> Result<Self, BindError> {
        let &BindInput {
            problem,
            partition,
            handles,
            refactorisation,
            progress,
            cancel,
            ..
        } = input;
        let solved = &partition.solved;
        let component_of = |vertex: u32| problem.topology.component(SurfaceVertex(vertex));
        let refuse = |error: SystemError| of_order(options, error.into_bind_error(component_of, solved.len()));
        let order = options.operator_power();
        slender::check(
            &partition.triangulation,
            solved,
            slender::most_edges(order),
            Some(order),
        )?;
        let plan = EliminationPlan::of(input)?;
        cancel.check()?;
        progress.set(0.1);
        let (operator, prescribed) = operator(problem, options, partition, handles);
        cancel.check()?;
        progress.set(0.2);
        let mut system =
            BilaplacianSystem::planned(operator, &plan, refactorisation, partition.budget, cancel).map_err(refuse)?;
        progress.set(0.7);
        let columns = solve_columns(&mut system, &prescribed, solved, progress, cancel).map_err(refuse)?;
        for column in &columns {
            let (vertex, error) = (column.vertex, column.error);
            if error.is_nan() || error > TOLERANCE {
                let component = component_of(vertex);
                let refused = BindError::Inaccurate {
                    component,
                    vertex,
                    error,
                };
                return Err(of_order(options, refused));
            }
        }
        let free_count = solved.len();
        let energy_blocks = energy_blocks(&columns).map_err(|_| BindError::OutOfMemory { free_count })?;
        let reference = reference_handles(problem, partition);
        let blocks: Vec<Vec<[T; 4]>> = columns.into_iter().map(|column| column.rows).collect();
        let bases = HandleBases::new(solved.clone(), &blocks, |vertex| {
            reference[component_of(vertex) as usize]
        });
        let bases = bases.map_err(|_| BindError::OutOfMemory { free_count })?;
        progress.set(1.0);
        Ok(Self {
            system,
            bases,
            prescribed,
            energy_blocks,
        })
    }

    /// What binding nearly the same problem can take over.
    pub fn factored(&self) -> &Arc<RenewableFactor> {
        self.system.factored()
    }

    /// The handles' bases.
    pub fn bases(&self) -> &HandleBases<T> {
        &self.bases
    }

    /// Fills all of `displacements` from the bases.
    pub fn frame(&self, motions: &[Motion], displacements: &mut [DVec3]) -> Finite {
        let vertex = |place| self.vertex(place) as usize;
        frame(&self.bases, &self.prescribed, vertex, motions, displacements)
    }

    /// Sentences about what had to be repaired.
    pub fn warnings(&self) -> Vec<String> {
        let mut sentences: Vec<String> = repairs(self.system.operator.laplacian.mollified_faces())
            .into_iter()
            .collect();
        sentences.extend(self.system.solution().warnings());
        sentences
    }

    /// How many numbers the factor stores.
    pub fn factor_len(&self) -> usize {
        self.system.factor_len()
    }

    /// The energy of a frame, from the motions alone: no pass over the surface.
    pub fn energy(&self, motions: &[Motion]) -> f64 {
        let columns = |motion: &Motion| {
            [
                motion.linear.x_axis,
                motion.linear.y_axis,
                motion.linear.z_axis,
                motion.shift,
            ]
        };
        let mut sum = 0.0;
        for (h, left) in motions.iter().map(columns).enumerate() {
            for (k, right) in motions.iter().map(columns).enumerate() {
                let block = &self.energy_blocks[h * motions.len() + k];
                for i in 0..4 {
                    for j in 0..4 {
                        sum += block[i][j] * left[i].dot(right[j]);
                    }
                }
            }
        }
        // Rigid motions leave a rounding error of either sign; what is not a number stays so.
        if sum > 0.0 || sum.is_nan() { 0.5 * sum } else { 0.0 }
    }

    /// The energy of any displacements, one per surface vertex, with soft handles pulling towards `motions`; components
    /// without a handle are left out.
    pub fn energy_of(&self, motions: &[Motion], displacements: &[DVec3]) -> f64 {
        let mut d = self.field(displacements);
        let first_spring = self.system.operator.laplacian.vertices().len();
        for (own, motion) in self.prescribed.iter().zip(motions) {
            for &(place, coordinates) in own.iter().filter(|(place, _)| *place as usize >= first_spring) {
                d[place as usize] = motion.displace(coordinates).to_array();
            }
        }
        self.system.operator.energy(&d)
    }

    /// Displacements, one per surface vertex, as a field.
    fn field(&self, displacements: &[DVec3]) -> Vec<[f64; 3]> {
        let operator = &self.system.operator;
        let vertices = operator.laplacian.vertices();
        (0..operator.field_len())
            .map(|place| displacements[vertices[operator.local_of(place) as usize] as usize].to_array())
            .collect()
    }

    /// As [`BilaplacianSolver::frame`], but solves with the factor in place of the bases.
    ///
    /// # Errors
    /// If the solution stays too inaccurate.
    pub fn frame_by_back_substitution(
        &self,
        motions: &[Motion],
        displacements: &mut [DVec3],
    ) -> Result<(), SolveError> {
        clear(displacements);
        for (handle, motion) in motions.iter().enumerate() {
            for (vertex, coordinates) in self.prescribed(handle) {
                displacements[vertex as usize] = motion.displace(coordinates);
            }
        }
        self.back_substitute(displacements)
    }

    /// Solves for the solved vertices' displacements, given all others. The displacements of soft handles' vertices are
    /// taken as the handles' targets.
    ///
    /// # Errors
    /// If the solution stays too inaccurate.
    pub fn back_substitute(&self, displacements: &mut [DVec3]) -> Result<(), SolveError> {
        let vertices = self.system.operator.laplacian.vertices();
        let mut d = self.field(displacements);
        let error = self.system.solve(&mut d, &Cancel::new()).error;
        for &local in self.system.columns() {
            displacements[vertices[local as usize] as usize] = DVec3::from_array(d[local as usize]);
        }
        // An error that is not finite is reported by the check of all displacements.
        if error.is_finite() && error > TOLERANCE {
            Err(SolveError::Inaccurate { error })
        } else {
            Ok(())
        }
    }

    /// The handles' vertices and coordinates, as surface vertices, ascending.
    fn prescribed(&self, handle: usize) -> impl Iterator<Item = (u32, [f64; 4])> + '_ {
        self.prescribed[handle]
            .iter()
            .map(|&(place, coordinates)| (self.vertex(place), coordinates))
    }

    /// The surface vertex that a field's entry is for.
    fn vertex(&self, place: u32) -> u32 {
        let operator = &self.system.operator;
        operator.laplacian.vertices()[operator.local_of(place as usize) as usize]
    }
}

/// The refusal with a lower order as a further remedy, if there is one.
fn of_order(options: &Bilaplacian, refused: BindError) -> BindError {
    let order = options.operator_power();
    match refused {
        BindError::NotPositiveDefinite { .. } | BindError::Inaccurate { .. } if order > 1 => BindError::Order {
            order,
            refused: Box::new(refused),
        },
        _ => refused,
    }
}

/// The lowest handle of each component in which nothing is fixed.
fn reference_handles(problem: &Problem, partition: &Partition) -> Vec<Option<u16>> {
    let mut reference = vec![None; partition.held.len()];
    for (handle, vertices) in partition.handles.iter().enumerate().rev() {
        for &vertex in vertices {
            let component = problem.topology.component(SurfaceVertex(vertex)) as usize;
            if !partition.held[component] {
                reference[component] = Some(handle as u16);
            }
        }
    }
    reference
}
