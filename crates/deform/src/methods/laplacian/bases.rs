//! The solutions of the implicit system for each of a handle's twelve numbers: a first shape as one product.

use glam::DVec3;
use rayon::prelude::*;

use super::coupled::{CoupledEnergy, DOF};
use super::implicit::ImplicitSystem;
use crate::BindError;
use crate::budget::{bytes_of, filled};
use crate::handles::Motion;
use crate::method::BindInput;
use crate::numerical::rows::CHUNK;
use crate::sparse::system_error::SystemError;
use crate::systems::poisson_system::{PoissonSystem, TOLERANCE, refused};

/// The number of solutions that are computed at once.
const AT_ONCE: usize = 6;

/// The displacement of a solved vertex for each number of a handle's motion: number 3 k + c is component c of the
/// factor of the handle's coordinate k (x, y, z, 1). They are in double precision, because transformations are made of
/// differences of displacements.
type Basis = [DVec3; 4 * DOF];

/// The bases, one row for each solved vertex, one entry per handle.
#[derive(Debug)]
pub(super) struct ImplicitBases {
    /// The solved local vertices, ascending.
    locals: Vec<u32>,
    rows: Vec<Basis>,
}

impl ImplicitBases {
    /// Factors the energy's system and solves for every handle.
    pub fn of(system: &PoissonSystem, energy: CoupledEnergy<'_>, input: &BindInput<'_>) -> Result<Self, BindError> {
        let &BindInput { partition, cancel, .. } = input;
        let (count, solved) = (input.handles.len(), system.columns().len());
        let bytes = bytes_of(count, solved * size_of::<Basis>());
        let budget = partition.budget.without(bytes).map_err(|_| BindError::Handles {
            handle_count: count,
            free_count: solved,
        })?;
        let at = |local: usize| system.vertices()[local];
        let refuse = |error| refused(error, input);
        let elimination = input.ordering()?.elimination(&partition.solved);
        let mut implicit = ImplicitSystem::of(energy, &elimination, budget, cancel)
            .map_err(|error| refuse(SystemError::of(error, at)))?;
        let check = |error: f64, local: u32| {
            cancel.check()?;
            // NaN is an error too. If nothing is free there is no vertex to name, and no error.
            if error <= TOLERANCE {
                Ok(())
            } else {
                let vertex = at(local as usize);
                Err(refuse(SystemError::Inaccurate { vertex, error }))
            }
        };
        let (missed, local) = implicit.check(cancel);
        check(missed, local)?;
        let first = system.columns().first().copied().unwrap_or(0);
        let mut locals = system.columns().to_vec();
        locals.sort_unstable();
        let mut rows = filled(Basis::default(), solved * count).map_err(|_| refuse(SystemError::OutOfMemory))?;
        for (handle, prescribed) in system.prescribed.iter().enumerate() {
            for half in 0..2 {
                let mut d = vec![[0.0; AT_ONCE]; DOF * system.operator().field_len()];
                for &(place, coordinates) in prescribed {
                    for number in 0..AT_ONCE {
                        let (k, component) = ((half * AT_ONCE + number) / DOF, number % DOF);
                        d[DOF * place as usize + component][number] = coordinates[k];
                    }
                }
                check(implicit.solve(&mut d, cancel).error, first)?;
                for (row, &local) in locals.iter().enumerate() {
                    for number in 0..AT_ONCE {
                        let at = |component: usize| d[DOF * local as usize + component][number];
                        rows[row * count + handle][half * AT_ONCE + number] = DVec3::new(at(0), at(1), at(2));
                    }
                }
            }
        }
        Ok(Self { locals, rows })
    }

    /// Fills in the solved rows of a field of displacements.
    pub fn evaluate(&self, motions: &[Motion], field: &mut [[f64; 3]]) {
        let numbers = |motion: &Motion| {
            let linear = motion.linear;
            let columns = [linear.x_axis, linear.y_axis, linear.z_axis, motion.shift];
            columns.map(|column| column.to_array())
        };
        let motions: Vec<[[f64; 3]; 4]> = motions.iter().map(numbers).collect();
        field.par_chunks_mut(CHUNK).enumerate().for_each(|(chunk, out)| {
            let first = chunk * CHUNK;
            let place = |local: usize| self.locals.partition_point(|&other| (other as usize) < local);
            let own = place(first)..place(first + out.len());
            let rows = self.rows[own.start * motions.len()..own.end * motions.len()].chunks_exact(motions.len());
            for (&local, bases) in self.locals[own].iter().zip(rows) {
                let mut sum = DVec3::ZERO;
                for (basis, motion) in bases.iter().zip(&motions) {
                    for (part, number) in basis.iter().zip(motion.as_flattened()) {
                        sum += *part * *number;
                    }
                }
                out[local as usize - first] = sum.to_array();
            }
        });
    }
}
