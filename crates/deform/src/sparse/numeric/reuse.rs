//! The parts of a factor that are equal to those of another matrix's.
//!
//! A part's numbers depend only on its columns of the matrix and on its children's contributions. If these are the same
//! to the bit, so are its numbers, and they are reused: after a stroke that changes which vertices are free, only the
//! parts around the stroke and their ancestors are factored again (after [HA18], "Factor Once", with supernodes instead
//! of columns).

use std::collections::BTreeMap;

use rayon::prelude::*;

use crate::sparse::Elimination;
use crate::sparse::line::LANES;
use crate::sparse::matrix::ScaledMatrix;
use crate::sparse::symbolic::assembly_tree::AssemblyTree;
use crate::sparse::symbolic::{Symbolic, contribution_lines};

/// The kept contributions need at most this many times the factor's own memory. On a mesh's own triangles all of them
/// need about as much as the factor; if the ordering fits badly, as with flipped edges at order 3, they would need ten
/// times that.
const KEPT: usize = 1;

/// For each part, whether its contribution is kept for the next factorisation: those that save the most operations per
/// byte, up to [`KEPT`] times the factor.
pub(crate) fn worth_keeping(symbolic: &Symbolic, assembly_tree: &AssemblyTree) -> Vec<bool> {
    let count = assembly_tree.parts.len();
    // The saving is the work of the whole subtree.
    let mut work: Vec<f64> = vec![0.0; count];
    for (part, own) in assembly_tree.parts.iter().enumerate() {
        work[part] += own.supernodes.clone().map(|s| symbolic.work(s)).sum::<f64>();
        if let Some(above) = own.parent {
            work[above] += work[part];
        }
    }
    let lines = |part: usize| contribution_lines(symbolic.pattern(assembly_tree.parts[part].supernodes.end - 1).len());
    let mut by_worth: Vec<usize> = (0..count).filter(|&part| lines(part) > 0).collect();
    let worth = |part: usize| work[part] / lines(part) as f64;
    by_worth.sort_by(|&a, &b| worth(b).total_cmp(&worth(a)).then(a.cmp(&b)));
    let mut left = KEPT * symbolic.stored() / LANES;
    let mut kept = vec![false; count];
    for part in by_worth {
        if lines(part) <= left {
            left -= lines(part);
            kept[part] = true;
        }
    }
    kept
}

/// A factorisation with the names of its columns: the same column of two matrices has the same name.
#[derive(Clone, Copy)]
pub(crate) struct Named<'a> {
    pub matrix: &'a ScaledMatrix,
    pub elimination: &'a Elimination,
    pub symbolic: &'a Symbolic,
    pub assembly_tree: &'a AssemblyTree,
}

/// For each part of `new`, the part of `old` that is equal to the bit, if any.
pub(crate) fn equal_parts(new: Named, old: Named) -> Vec<Option<usize>> {
    let first = |part: usize| old.elimination.order[old.assembly_tree.parts[part].columns.start];
    let part_by_name: BTreeMap<u32, usize> = (0..old.assembly_tree.parts.len())
        .map(|part| (first(part), part))
        .collect();
    let mut equal: Vec<Option<usize>> = new
        .assembly_tree
        .parts
        .par_iter()
        .enumerate()
        .map(|(part, own)| {
            let other = *part_by_name.get(&new.elimination.order[own.columns.start])?;
            equals(new, part, old, other).then_some(other)
        })
        .collect();
    // Children come before parents.
    for part in 0..equal.len() {
        let children = &new.assembly_tree.parts[part].children;
        let same = |other: usize| {
            let others = old.assembly_tree.parts[other].children.iter().map(|&child| Some(child));
            children.iter().map(|&child| equal[child]).eq(others)
        };
        equal[part] = equal[part].filter(|&other| same(other));
    }
    equal
}

/// Returns true if two parts have the same columns of the matrix, in the same supernodes over the same rows.
fn equals(new: Named, new_part: usize, old: Named, old_part: usize) -> bool {
    let (new_part, old_part) = (&new.assembly_tree.parts[new_part], &old.assembly_tree.parts[old_part]);
    let new_shapes = new_part.supernodes.clone().map(|s| new.symbolic.shape(s));
    if new_part.columns.len() != old_part.columns.len()
        || new.elimination.order[new_part.columns.clone()] != old.elimination.order[old_part.columns.clone()]
        || !new_shapes.eq(old_part.supernodes.clone().map(|s| old.symbolic.shape(s)))
    {
        return false;
    }
    let new_name = |row: &u32| new.elimination.order[*row as usize];
    let old_name = |row: &u32| old.elimination.order[*row as usize];
    let new_below = new.symbolic.pattern(new_part.supernodes.end - 1).iter().map(new_name);
    if !new_below.eq(old.symbolic.pattern(old_part.supernodes.end - 1).iter().map(old_name)) {
        return false;
    }
    new_part
        .columns
        .clone()
        .zip(old_part.columns.clone())
        .all(|(new_column, old_column)| {
            let (new_rows, new_values) = new.matrix.column(new_column);
            let (old_rows, old_values) = old.matrix.column(old_column);
            let bits = |value: &f64| value.to_bits();
            new_rows.iter().map(new_name).eq(old_rows.iter().map(old_name))
                && new_values.iter().map(bits).eq(old_values.iter().map(bits))
        })
}
