//! The points through which the field goes.

use std::collections::HashSet;

use glam::DVec3;

use super::system::directions;
use crate::Role;
use crate::method::BindInput;

/// More constraints than these are thinned out to about as many, evenly in space.
const MOST: usize = 40_000;

/// Constraints that lie in one plane do not say what a turn of a handle does beside it. They get copies so far to
/// both sides, in the unit of all points, which move as their handles do.
const SLAB: f64 = 0.05;

/// Points in a unit of their own, so that nothing depends on where a scan stands and how large it is.
#[derive(Clone, Debug)]
pub(super) struct Constraints {
    pub points: Vec<Constraint>,
    /// The points' mean.
    pub world_origin: DVec3,
    /// Their largest distance from it, the unit of length; 1 if all are in one place.
    pub unit: f64,
}

/// A point, and what happens there.
#[derive(Clone, Copy, Debug)]
pub(super) struct Constraint {
    /// (p − origin) / unit.
    pub point: DVec3,
    /// The handle whose motion it has, with its coordinates there; `None` where it is fixed.
    pub handle: Option<(usize, [f64; 4])>,
}

impl Constraints {
    /// Of all handles and fixed vertices.
    pub fn of(input: &BindInput<'_>) -> Self {
        let positions = &input.problem.surface.positions;
        let handles = input.handles.iter().map(|handle| handle.vertices.clone());
        let fixed = (0..).zip(input.problem.roles);
        let fixed = fixed.filter_map(|(vertex, role)| (*role == Role::Fixed).then_some(vertex));
        let mut sets: Vec<Vec<u32>> = handles.collect();
        sets.push(fixed.collect());
        let everything = || sets.iter().flatten().map(|&vertex| positions[vertex as usize]);
        // Neither depends on how the axes lie.
        let world_origin = everything().sum::<DVec3>() / everything().count().max(1) as f64;
        let radius = everything()
            .map(|point| point.distance(world_origin))
            .fold(0.0, f64::max);
        let unit = if radius > 0.0 { radius } else { 1.0 };
        let most = MOST / sets.len();
        let mut points: Vec<Constraint> = Vec::new();
        let constraint = |set: usize, point: DVec3| {
            let own = input.handles.get(set);
            Constraint {
                point,
                handle: own.map(|handle| (set, handle.coordinates(world_origin + point * unit))),
            }
        };
        for (set, vertices) in sets.iter().enumerate() {
            let vertices = thinned(vertices, positions, most).into_iter();
            points.extend(vertices.map(|vertex| constraint(set, (positions[vertex as usize] - world_origin) / unit)));
        }
        let flat = directions(&points.iter().map(|constraint| constraint.point).collect::<Vec<_>>()).flat;
        let on_plane = points.clone();
        for aside in flat.into_iter().flat_map(|aside| [aside, -aside]) {
            let copies = on_plane.iter().map(|own| {
                let set = own.handle.map_or(input.handles.len(), |(handle, _)| handle);
                constraint(set, own.point + aside * SLAB)
            });
            points.extend(copies);
        }
        Self {
            points,
            world_origin,
            unit,
        }
    }
}

/// At most about so many of the vertices: the first in each cell of the finest grid that has no more occupied cells.
fn thinned(vertices: &[u32], positions: &[DVec3], most: usize) -> Vec<u32> {
    if vertices.len() <= most {
        return vertices.to_vec();
    }
    let points = || vertices.iter().map(|&vertex| positions[vertex as usize]);
    let (low, high) = points().fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), point| {
        (low.min(point), high.max(point))
    });
    let extent = (high - low).max_element();
    // Each coarser grid has a quarter to an eighth of the cells.
    let mut cells = 1024.0;
    loop {
        let cell = |point: DVec3| ((point - low) * (cells / extent)).as_i64vec3();
        let mut seen = HashSet::new();
        let kept = |vertex: &&u32| seen.insert(cell(positions[**vertex as usize]));
        let kept: Vec<u32> = vertices.iter().filter(kept).copied().collect();
        if kept.len() <= most || cells <= 1.0 {
            return kept;
        }
        cells *= 0.5_f64.max((most as f64 / kept.len() as f64).sqrt());
    }
}
