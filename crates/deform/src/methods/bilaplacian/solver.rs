//! The bound bi-Laplacian: its binding, and its frames, from the bases or by back substitution.

use std::borrow::Cow;
use std::sync::Arc;

use glam::DVec3;
use pliant_mesh::{Cancel, SurfaceVertex};

use crate::handles::bases::{Stored, frame};
use crate::handles::finite::Finite;
use crate::handles::offsets::Offsets;
use crate::handles::{Motion, clear};
use crate::method::BindInput;
use crate::methods::bilaplacian::columns::{energy_blocks, solve_columns};
use crate::methods::bilaplacian::parts::StiffParts;
use crate::methods::bilaplacian::plate::{PLAIN, Plate};
use crate::operators::repairs;
use crate::region::boundary_problem::BoundaryProblem;
use crate::region::partition::Partition;
use crate::region::slender;
use crate::sparse::refactorisation::RenewableFactor;
use crate::sparse::system_error::SystemError;
use crate::systems::elimination_plan::EliminationPlan;
use crate::systems::factored::BilaplacianSystem;
use crate::systems::setup::Prescribed;
use crate::{Bilaplacian, BindError, HandleBases, SolveError};

/// The bound bi-Laplacian, with handle bases of the precision `T`.
#[derive(Debug)]
pub(crate) struct BilaplacianSolver<T = f32> {
    system: BilaplacianSystem,
    bases: HandleBases<T>,
    /// Each handle's places in a field, at its vertices or, if it is soft, at their springs, and their coordinates;
    /// then those of stiff parts.
    prescribed: Vec<Prescribed>,
    parts: StiffParts,
    /// The offsets of handles' vertices from their handles' motions.
    offsets: Arc<Offsets>,
    /// True if natural boundaries were left out.
    is_plain: bool,
    /// E = ½ Σ_hk tr(X_hᵀ G_hk X_k) over the motions' 4×3 matrices X; row-major, one 4×4 block a pair of handles.
    energy_blocks: Vec<[[f64; 4]; 4]>,
}

/// The allowed error of a solution, relative to its largest value.
const TOLERANCE: f64 = 1e-7;

impl<T: Stored> BilaplacianSolver<T> {
    /// Assembles, factors, checks, and solves for the bases of `handles`.
    pub fn bind(options: &Bilaplacian, input: &BindInput<'_>) -> Result<Self, BindError> {
        let &BindInput {
            problem,
            partition,
            handles,
            progress,
            cancel,
            ..
        } = input;
        let solved = &partition.solved;
        let component_of = |vertex: u32| problem.topology.component(SurfaceVertex(vertex));
        let refuse = |error: SystemError| of_order(options, error.into_bind_error(problem.topology, solved.len()));
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
        let Plate {
            mut system,
            prescribed,
            mut parts,
            is_plain,
        } = Plate::of(options, &plan, input).map_err(refuse)?;
        cancel.check()?;
        progress.set(0.7);
        let columns = solve_columns(&mut system, &prescribed, &parts, solved, progress, cancel).map_err(refuse)?;
        for column in &columns {
            let (vertex, error) = (column.vertex, column.error);
            if error.is_nan() || error > TOLERANCE {
                return Err(refuse(SystemError::Inaccurate { vertex, error }));
            }
        }
        let free_count = solved.len();
        let energy_blocks =
            energy_blocks(&columns, handles.len()).map_err(|_| BindError::OutOfMemory { free_count })?;
        parts.settle(&energy_blocks);
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
            parts,
            offsets: Arc::default(),
            is_plain,
            energy_blocks,
        })
    }

    /// The motions of handles and stiff parts.
    fn all<'m>(&self, motions: &'m [Motion]) -> Cow<'m, [Motion]> {
        match self.parts.len() {
            0 => motions.into(),
            _ => self.parts.motions(motions).into(),
        }
    }

    /// Sets the offsets of handles' vertices from their handles' motions.
    pub fn set_offsets(&mut self, offsets: &Arc<Offsets>) {
        self.offsets = Arc::clone(offsets);
    }

    /// Returns true if no vertex has an offset, so that the bases give the frame.
    pub fn is_affine(&self) -> bool {
        self.offsets.is_empty()
    }

    /// The data that the binding of a nearly equal problem can reuse.
    pub fn factored(&self) -> &Arc<RenewableFactor> {
        self.system.factored()
    }

    /// Returns true if no stiff part moves between the handles.
    pub fn is_driven_by_handles_alone(&self) -> bool {
        self.parts.len() == 0
    }

    /// The handles' bases, then those of stiff parts.
    pub fn bases(&self) -> &HandleBases<T> {
        &self.bases
    }

    /// Fills all of `displacements` from the bases.
    pub fn frame(&self, motions: &[Motion], displacements: &mut [DVec3]) -> Finite {
        let vertex = |place| self.vertex(place) as usize;
        let all = self.all(motions);
        let of_handles = &self.prescribed[..motions.len().min(self.prescribed.len())];
        frame(&self.bases, of_handles, vertex, &all, displacements)
    }

    /// Sentences about repairs.
    pub fn warnings(&self) -> Vec<String> {
        let mut sentences: Vec<String> = repairs(self.system.operator.laplacian.mollified_faces())
            .into_iter()
            .collect();
        sentences.extend(self.system.solution().warnings());
        sentences.extend(self.is_plain.then(|| PLAIN.to_owned()));
        sentences
    }

    /// The number of entries that the factor stores.
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
        let motions = &*self.all(motions);
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
        // Rigid motions leave a rounding error of either sign; NaN stays NaN.
        if sum > 0.0 || sum.is_nan() { 0.5 * sum } else { 0.0 }
    }

    /// The energy of any displacements, one per surface vertex, with soft handles pulling towards `motions`; components
    /// without a handle are left out.
    pub fn energy_of(&self, motions: &[Motion], displacements: &[DVec3]) -> f64 {
        let mut d = self.field(displacements);
        let all = self.all(motions);
        let first_spring = self.system.operator.laplacian.vertices().len();
        for (own, motion) in self.prescribed.iter().zip(&*all) {
            for &(place, coordinates) in own.iter().filter(|(place, _)| *place as usize >= first_spring) {
                let offset = self.offsets.at(self.vertex(place));
                d[place as usize] = (motion.displace(coordinates) + offset).to_array();
            }
        }
        let of_parts = &all[motions.len()..];
        self.system.operator.energy(&d) - self.parts.relief(&self.system.operator, &d, of_parts)
    }

    /// Displacements, one per surface vertex, as a field.
    fn field(&self, displacements: &[DVec3]) -> Vec<[f64; 3]> {
        let operator = &self.system.operator;
        let vertices = operator.laplacian.vertices();
        (0..operator.field_len())
            .map(|place| displacements[vertices[operator.local_of(place) as usize] as usize].to_array())
            .collect()
    }

    /// Like [`BilaplacianSolver::frame`], but solves with the factor instead of using the bases.
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
                displacements[vertex as usize] = motion.displace(coordinates) + self.offsets.at(vertex);
            }
        }
        let of_parts = self.all(motions)[motions.len()..].to_vec();
        if of_parts.is_empty() || self.is_affine() {
            return self.substitute(&of_parts, displacements);
        }
        // The bases do not contain the offsets, so the stiff parts follow the surface.
        let targets = displacements.to_vec();
        self.substitute(&of_parts, displacements)?;
        let of_parts = self.parts.fitted(displacements);
        displacements.copy_from_slice(&targets);
        self.substitute(&of_parts, displacements)
    }

    /// Solves for the solved vertices' displacements, given all others. The displacements of soft handles' vertices
    /// serve as the handles' targets, and stiff parts take the rigid motions that fit theirs best.
    ///
    /// # Errors
    /// If the solution stays too inaccurate.
    pub fn back_substitute(&self, displacements: &mut [DVec3]) -> Result<(), SolveError> {
        let of_parts = self.parts.fitted(displacements);
        self.substitute(&of_parts, displacements)
    }

    fn substitute(&self, of_parts: &[Motion], displacements: &mut [DVec3]) -> Result<(), SolveError> {
        let (system, first) = (&self.system, self.prescribed.len() - self.parts.len());
        let vertices = system.operator.laplacian.vertices();
        let mut d = self.field(displacements);
        let mut load = vec![[0.0; 3]; if of_parts.is_empty() { 0 } else { system.columns().len() }];
        for (part, motion) in of_parts.iter().enumerate() {
            for &(place, coordinates) in &self.prescribed[first + part] {
                d[place as usize] = motion.displace(coordinates).to_array();
            }
            for (load, own) in load
                .iter_mut()
                .zip(self.parts.load(part, &system.operator, system.columns()))
            {
                let own = motion.displace(own).to_array();
                (0..3).for_each(|k| load[k] += own[k]);
            }
        }
        let error = match of_parts.is_empty() {
            true => system.solve(&mut d, &Cancel::new()).error,
            false => system.solve_loaded(&load, &mut d, &Cancel::new()).error,
        };
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

    /// The surface vertex of a field's entry.
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
fn reference_handles(problem: &BoundaryProblem, partition: &Partition) -> Vec<Option<u16>> {
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
