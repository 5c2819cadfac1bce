//! Bare points: drawn vertices that no kept triangle uses. Each gets a surface vertex behind those of the triangles, so
//! that a file without them is welded in the same way, with the same memory.
//!
//! A point within the tolerance of a triangle's vertex becomes a twin of that vertex and moves with it. Points within
//! the tolerance of each other become one.

use glam::DVec3;
use rayon::prelude::*;

use super::joining::{Joined, join};
use crate::Bounds;
use crate::geometry::bounds_of;
use crate::model::drawn_set::NONE;

/// Gives the drawn vertices `bare`, which have finite positions, a surface vertex each. `positions` holds those of the
/// triangles' vertices; new ones are appended in Morton order, and `surface_vertices` is filled in. `tolerance_within`
/// gives the length within which points of these bounds are joined; `None` joins none.
pub(super) fn add(
    drawn_positions: &[DVec3],
    bare: &[u32],
    positions: &mut Vec<DVec3>,
    surface_vertices: &mut [u32],
    tolerance_within: impl FnOnce(&Bounds) -> Option<f64>,
) {
    let Some(bounds) = bounds_of(bare.par_iter().map(|&v| drawn_positions[v as usize])) else {
        return;
    };
    let tolerance = tolerance_within(&bounds);
    let near = match tolerance {
        Some(tolerance) => vertices_near(positions, &bounds, tolerance),
        None => Vec::new(),
    };
    // The triangles' vertices come first, because a position joins the lowest one that it can.
    let mut all = Vec::with_capacity(near.len() + bare.len());
    all.extend(near.iter().map(|&v| positions[v as usize]));
    all.extend(bare.iter().map(|&v| drawn_positions[v as usize]));
    let members = (0..all.len() as u32).collect();
    let bounds = bounds_of(all.par_iter().copied()).unwrap_or(bounds);
    let Joined { order, representative } = join(&all, members, &bounds, tolerance);
    let mut number = vec![NONE; all.len()];
    for (&index, &place) in order.iter().zip(&representative) {
        let of = order[place as usize] as usize;
        if of < near.len() {
            number[index as usize] = near[of];
        } else if of == index as usize {
            number[of] = positions.len() as u32;
            positions.push(all[of]);
        }
    }
    for (&index, &place) in order.iter().zip(&representative) {
        let of = order[place as usize] as usize;
        if number[index as usize] == NONE {
            number[index as usize] = number[of];
        }
    }
    for (&vertex, &number) in bare.iter().zip(&number[near.len()..]) {
        surface_vertices[vertex as usize] = number;
    }
}

/// The vertices within `tolerance` of a box.
fn vertices_near(positions: &[DVec3], bounds: &Bounds, tolerance: f64) -> Vec<u32> {
    let (low, high) = (bounds.min - tolerance, bounds.max + tolerance);
    let is_near = |position: &DVec3| position.cmpge(low).all() && position.cmple(high).all();
    (0..)
        .zip(positions)
        .filter(|(_, position)| is_near(position))
        .map(|(v, _)| v)
        .collect()
}
