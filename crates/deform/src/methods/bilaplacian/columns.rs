//! The unknowns of binding: the four columns of each handle's basis [BK04], and the energies between handles.

use std::collections::TryReserveError;

use pliant_mesh::{Cancel, Progress};
use rayon::prelude::*;

use crate::budget::filled;
use crate::handles::bases::Stored;
use crate::methods::bilaplacian::parts::StiffParts;
use crate::sparse::system_error::SystemError;
use crate::systems::factored::BilaplacianSystem;
use crate::systems::setup::Prescribed;

/// The owners of columns: the handles, then the stiff parts.
#[derive(Clone, Copy)]
struct Driven<'a> {
    prescribed: &'a [Prescribed],
    parts: &'a StiffParts,
}

impl Driven<'_> {
    /// The part of this number.
    fn part(&self, number: usize) -> Option<usize> {
        number.checked_sub(self.prescribed.len() - self.parts.len())
    }
}

/// One handle's four columns.
pub(crate) struct Columns<T> {
    /// The columns on the solved vertices, ascending.
    pub rows: Vec<[T; 4]>,
    /// C_hᵀ F of this handle against each handle h, F the force at h: A B, or the springs' W (C − B).
    energies: Vec<[[f64; 4]; 4]>,
    /// The solution's error, relative to its largest value.
    pub error: f64,
    /// A vertex of the handle, to name the place of the error.
    pub vertex: u32,
}

/// Checks the system and solves for each handle's columns on the vertices `solved`; without handles it only checks.
pub(crate) fn solve_columns<T: Stored>(
    system: &mut BilaplacianSystem,
    prescribed: &[Prescribed],
    parts: &StiffParts,
    solved: &[u32],
    progress: &Progress,
    cancel: &Cancel,
) -> Result<Vec<Columns<T>>, SystemError> {
    let solved_locals = system.operator.laplacian.locals(solved);
    let field_len = system.operator.field_len();
    let Some((first, others)) = prescribed.split_first() else {
        system.check(&mut vec![[1.0]; field_len], cancel)?;
        return Ok(Vec::new());
    };
    // The constant is solved for beside the first handle: one pass over the factor for both.
    let mut d = vec![[0.0, 0.0, 0.0, 0.0, 1.0]; field_len];
    for &(place, [x, y, z, w]) in first {
        d[place as usize] = [x, y, z, w, 1.0];
    }
    let error = system.check(&mut d, cancel)?;
    let mut columns = Vec::with_capacity(prescribed.len());
    let driven = Driven { prescribed, parts };
    columns.push(Columns::of(system, &d, 0, driven, &solved_locals, error));
    progress.set(0.85);
    let learning = system.solution().is_learning();
    let shared = &*system;
    let is_wanted = || cancel.check().map_err(|_| SystemError::Cancelled);
    let solve = |(number, own): (usize, &Prescribed)| {
        let number = number + 1;
        is_wanted()?;
        let mut d = vec![[0.0; 4]; field_len];
        for &(place, coordinates) in own {
            d[place as usize] = coordinates;
        }
        let outcome = match driven.part(number) {
            Some(part) => shared.solve_loaded(&parts.load(part, &shared.operator, shared.columns()), &mut d, cancel),
            None => shared.solve(&mut d, cancel),
        };
        is_wanted()?;
        Ok(Columns::of(shared, &d, number, driven, &solved_locals, outcome.error))
    };
    let others: Result<Vec<_>, SystemError> = match learning {
        true => others.iter().enumerate().map(solve).collect(),
        false => others.par_iter().enumerate().map(solve).collect(),
    };
    columns.extend(others?);
    system.settle();
    Ok(columns)
}

/// The blocks G_hk of the energy ½ Σ_hk tr(X_hᵀ G_hk X_k) of motions X, row-major over pairs of handles and, after the
/// `handle_count` handles, stiff parts.
pub(crate) fn energy_blocks<T>(
    columns: &[Columns<T>],
    handle_count: usize,
) -> Result<Vec<[[f64; 4]; 4]>, TryReserveError> {
    let mut blocks = filled([[0.0; 4]; 4], columns.len() * columns.len())?;
    for (k, column) in columns.iter().enumerate() {
        for (h, block) in column.energies.iter().enumerate() {
            blocks[h * columns.len() + k] = *block;
        }
    }
    // The load of a part is not among the forces at handles: a handle's effect on the part is the same.
    for h in 0..handle_count.min(columns.len()) {
        for k in handle_count..columns.len() {
            let other = blocks[k * columns.len() + h];
            blocks[h * columns.len() + k] = std::array::from_fn(|i| std::array::from_fn(|j| other[j][i]));
        }
    }
    Ok(blocks)
}

impl<T: Stored> Columns<T> {
    /// The columns from a solution whose first four functions are the handle's.
    fn of<const K: usize>(
        system: &BilaplacianSystem,
        d: &[[f64; K]],
        own: usize,
        driven: Driven,
        solved_locals: &[u32],
        error: f64,
    ) -> Self {
        let operator = &system.operator;
        let first_spring = operator.laplacian.vertices().len();
        let potential = operator.potential(d);
        let energy = |(number, handle): (usize, &Prescribed)| {
            let mut block = match driven.part(number) {
                Some(part) => driven.parts.energy(part, number == own, operator, d),
                None => [[0.0; 4]; 4],
            };
            for &(place, coordinates) in handle {
                let force = match (place as usize).checked_sub(first_spring) {
                    Some(spring) => operator.pull(spring, d),
                    None => operator.force(place as usize, &potential),
                };
                for i in 0..4 {
                    for j in 0..4 {
                        block[i][j] += coordinates[i] * force[j];
                    }
                }
            }
            block
        };
        let row = |&local: &u32| std::array::from_fn(|k| T::of(d[local as usize][k]));
        let vertex = driven.prescribed[own].first().map_or(0, |&(place, _)| {
            operator.laplacian.vertices()[operator.local_of(place as usize) as usize]
        });
        Self {
            rows: solved_locals.iter().map(row).collect(),
            energies: driven.prescribed.iter().enumerate().map(energy).collect(),
            error,
            vertex,
        }
    }
}
