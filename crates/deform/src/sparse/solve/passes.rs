//! Forward substitution from the leaves of an assembly tree to its roots and backward substitution from the roots to
//! the leaves, part by part, with rows of right-hand sides.

use std::sync::{Mutex, MutexGuard, PoisonError};

use crate::sparse::symbolic::assembly_tree::AssemblyTree;

/// The data of one part's work.
struct PartRows<'a, R> {
    /// Its own columns of the right-hand sides.
    own: &'a mut [R],
    /// The rows of its own columns, then those of its last supernode's pattern.
    rows: &'a mut Vec<R>,
}

/// Solves for `x`, which has one row per column, part by part. `forward` gets and changes a part's own rows and,
/// starting from zero, the changes to its ancestors' rows; its children's changes are added first. `backward` gets the
/// solved rows of the ancestors.
///
/// A part passes changes to its parent and gets solved rows from it, so nothing is shared, and nothing is summed in an
/// order that could vary. `part_rows` is scratch memory that is kept between calls.
pub(crate) fn forward_and_backward<R: Copy + Send + Sync>(
    assembly_tree: &AssemblyTree,
    x: &mut [R],
    part_rows: &mut Vec<Vec<R>>,
    zero: R,
    add: impl Fn(&mut R, R) + Sync,
    forward: impl Fn(usize, &mut [R]) + Sync,
    backward: impl Fn(usize, &mut [R]) + Sync,
) {
    part_rows.resize_with(assembly_tree.parts.len(), Vec::new);
    let mut rest = x;
    let part_rows: Vec<Mutex<PartRows<R>>> = assembly_tree
        .parts
        .iter()
        .zip(part_rows)
        .map(|(part, rows)| {
            let (own, tail) = std::mem::take(&mut rest).split_at_mut(part.columns.len());
            rest = tail;
            Mutex::new(PartRows { own, rows })
        })
        .collect();
    let rows_of =
        |part: usize| -> MutexGuard<PartRows<R>> { part_rows[part].lock().unwrap_or_else(PoisonError::into_inner) };
    assembly_tree.upwards(|index| {
        let part = &assembly_tree.parts[index];
        let PartRows { own, rows } = &mut *rows_of(index);
        rows.clear();
        rows.extend_from_slice(own);
        rows.resize(own.len() + part.outside.len(), zero);
        for &child in &part.children {
            let child_part = &assembly_tree.parts[child];
            let changes = &rows_of(child).rows[child_part.columns.len()..];
            for (&place, &change) in child_part.outside.iter().zip(changes) {
                add(&mut rows[place as usize], change);
            }
        }
        forward(index, rows);
    });
    assembly_tree.downwards(|index| {
        let part = &assembly_tree.parts[index];
        let PartRows { own, rows } = &mut *rows_of(index);
        if let Some(above) = part.parent {
            let above = rows_of(above);
            for (&place, row) in part.outside.iter().zip(&mut rows[own.len()..]) {
                *row = above.rows[place as usize];
            }
        }
        backward(index, rows);
        own.copy_from_slice(&rows[..own.len()]);
    });
}
