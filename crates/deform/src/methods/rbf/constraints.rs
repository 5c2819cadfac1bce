//! The points that the field interpolates.

use glam::DVec3;

use super::directions::directions;
use crate::Role;
use crate::method::BindInput;
use crate::numerical::samples::thinned;

/// More constraints than these are thinned out to about as many, evenly in space.
const MOST: usize = 40_000;

/// Constraints in one plane do not determine the effect of a handle's turn beside the plane. They get copies at this
/// distance to both sides, in the unit of all points, which move with their handles.
const SLAB: f64 = 0.05;

/// Points in their own unit, so that nothing depends on a scan's position and size.
#[derive(Clone, Debug)]
pub(super) struct Constraints {
    pub points: Vec<Constraint>,
    /// The points' mean.
    pub world_origin: DVec3,
    /// Their largest distance from it, the unit of length; 1 if all are in one place.
    pub unit: f64,
}

/// A point, and its constraint.
#[derive(Clone, Copy, Debug)]
pub(super) struct Constraint {
    /// (p − origin) / unit.
    pub point: DVec3,
    /// The handle that it moves with, and its coordinates there; `None` if it is fixed.
    pub handle: Option<(usize, [f64; 4])>,
}

impl Constraints {
    /// The constraints of all handles and fixed vertices.
    pub fn of(input: &BindInput<'_>) -> Self {
        let positions = &input.problem.surface.positions;
        let handles = input.handles.iter().map(|handle| handle.vertices.clone());
        let fixed = (0..).zip(input.problem.roles);
        let fixed = fixed.filter_map(|(vertex, role)| (*role == Role::Fixed).then_some(vertex));
        let mut sets: Vec<Vec<u32>> = handles.collect();
        sets.push(fixed.collect());
        let everything = || sets.iter().flatten().map(|&vertex| positions[vertex as usize]);
        // Neither depends on the axes' directions.
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
