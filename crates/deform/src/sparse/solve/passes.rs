//! Up the parts of an assembly tree and down again, with rows of right-hand sides.

use std::sync::{Mutex, MutexGuard, PoisonError};

use crate::sparse::symbolic::assembly_tree::AssemblyTree;

/// What one part works on.
struct Desk<'a, R> {
    /// Its own columns of the right-hand sides.
    own: &'a mut [R],
    /// First its own columns', then its last block's pattern's.
    rows: &'a mut Vec<R>,
}

/// Solves for `x`, one row a column, part by part: `up` has a part's rows as they stand and what children changed, from
/// 0 where they lie in the part above, and changes them; `down` has those above as they came out.
///
/// A part hands what it changes to the part above and gets what it needs from there, so nothing is shared, and nothing is
/// added up in an order that could vary. `desks` is room, kept from one time to the next.
pub(crate) fn up_and_down<R: Copy + Send + Sync>(
    assembly_tree: &AssemblyTree,
    x: &mut [R],
    desks: &mut Vec<Vec<R>>,
    zero: R,
    add: impl Fn(&mut R, R) + Sync,
    up: impl Fn(usize, &mut [R]) + Sync,
    down: impl Fn(usize, &mut [R]) + Sync,
) {
    desks.resize_with(assembly_tree.parts.len(), Vec::new);
    let mut rest = x;
    let desks: Vec<Mutex<Desk<R>>> = assembly_tree
        .parts
        .iter()
        .zip(desks)
        .map(|(part, rows)| {
            let (own, tail) = std::mem::take(&mut rest).split_at_mut(part.columns.len());
            rest = tail;
            Mutex::new(Desk { own, rows })
        })
        .collect();
    let desk = |part: usize| -> MutexGuard<Desk<R>> { desks[part].lock().unwrap_or_else(PoisonError::into_inner) };
    assembly_tree.upwards(|index| {
        let part = &assembly_tree.parts[index];
        let Desk { own, rows } = &mut *desk(index);
        rows.clear();
        rows.extend_from_slice(own);
        rows.resize(own.len() + part.outside.len(), zero);
        for &child in &part.children {
            let child_part = &assembly_tree.parts[child];
            let changes = &desk(child).rows[child_part.columns.len()..];
            for (&place, &change) in child_part.outside.iter().zip(changes) {
                add(&mut rows[place as usize], change);
            }
        }
        up(index, rows);
    });
    assembly_tree.downwards(|index| {
        let part = &assembly_tree.parts[index];
        let Desk { own, rows } = &mut *desk(index);
        if let Some(above) = part.parent {
            let above = desk(above);
            for (&place, row) in part.outside.iter().zip(&mut rows[own.len()..]) {
                *row = above.rows[place as usize];
            }
        }
        down(index, rows);
        own.copy_from_slice(&rows[..own.len()]);
    });
}
