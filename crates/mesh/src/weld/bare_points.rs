//! Bare points: drawn vertices that no kept triangle uses. Each gets a surface vertex after those of the triangles, so
//! that a file without them is welded in the same way, with the same memory.
//!
//! If a point is so close to a triangle's vertex that another vertex there would be joined to it, the point becomes a
//! twin of that vertex and moves with it. Equal points become one.

use glam::DVec3;
use rayon::prelude::*;

use super::closeness::Closeness;
use super::joining::{Joined, join_equal};
use super::nearby::{MayJoin, join_nearest};
use crate::Bounds;
use crate::drawn::drawn_set::NONE;
use crate::geometry::bounds_of;

/// Gives the drawn vertices `bare`, which have finite positions, a surface vertex each. `positions` has those of the
/// triangles' vertices, whose distances are in `closeness`; new ones are appended in Morton order, and
/// `surface_vertices` is filled in.
pub(super) fn add(
    drawn_positions: &[DVec3],
    bare: &[u32],
    positions: &mut Vec<DVec3>,
    surface_vertices: &mut [u32],
    closeness: &Closeness<'_>,
) {
    let Some(bounds) = bounds_of(bare.par_iter().map(|&v| drawn_positions[v as usize])) else {
        return;
    };
    let near = vertices_near(positions, &bounds, closeness);
    // The triangles' vertices come first, because a position joins a lower one.
    let mut all = Vec::with_capacity(near.len() + bare.len());
    all.extend(near.iter().map(|&v| positions[v as usize]));
    all.extend(bare.iter().map(|&v| drawn_positions[v as usize]));
    let members = (0..all.len() as u32).collect();
    let bounds = bounds_of(all.par_iter().copied()).unwrap_or(bounds);
    let mut joined = join_equal(&all, members, &bounds);
    let of_vertex = |index: u32| near.get(index as usize).map(|&v| closeness.reach(v));
    let furthest = (0..near.len() as u32).filter_map(of_vertex).fold(0.0, f64::max);
    let of_point = closeness.given().unwrap_or(furthest);
    let order = joined.order.clone();
    join_nearest(
        &all,
        &mut joined,
        &bounds,
        |place| of_vertex(order[place as usize]).unwrap_or(of_point),
        |_| Rule {
            order: &order,
            vertices: near.len(),
            is_given: closeness.given().is_some(),
        },
    );
    let Joined { order, representative } = joined;
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

/// Points join vertices, and each other within a distance that a person gives; vertices are already apart.
struct Rule<'a> {
    order: &'a [u32],
    vertices: usize,
    is_given: bool,
}

impl MayJoin for Rule<'_> {
    fn may_join(&self, place: u32, other: u32, _: f64) -> bool {
        let is_vertex = |place: u32| (self.order[place as usize] as usize) < self.vertices;
        !is_vertex(place) && (is_vertex(other) || self.is_given)
    }

    fn has_joined(&mut self, _: u32, _: u32) {}
}

/// The vertices that a point in this box might join.
fn vertices_near(positions: &[DVec3], bounds: &Bounds, closeness: &Closeness<'_>) -> Vec<u32> {
    (0..)
        .zip(positions)
        .filter(|&(v, &position)| bounds.distance(position) <= closeness.reach(v))
        .map(|(v, _)| v)
        .collect()
}
