//! The position and the reach of a handle along the surface, in world units.

use std::f64::consts::PI;

use glam::DVec3;
use pliant_mesh::{Surface, SurfaceVertex, Topology, face_area};

use crate::document::{PART_RADII, Reach};

/// The most that a reach can be, in world units.
pub(super) fn most_of(reach: Reach, surface: &Surface, topology: &Topology, members: &[SurfaceVertex]) -> f64 {
    match reach {
        Reach::Bounded(length) | Reach::Creased(length) | Reach::Length(length) => length,
        Reach::Radii(radii) => radii * handle_radius(surface, topology, members),
        Reach::Found | Reach::Feature | Reach::Part => PART_RADII * handle_radius(surface, topology, members),
    }
}

/// A handle's radius: that of the disc with its area; for bare points alone, that of the disc over which they would be
/// spread.
///
/// Farthest distances or moments would be equally good for one round patch, but a handle of two patches far apart would
/// then reach across everything between them.
pub(crate) fn handle_radius(surface: &Surface, topology: &Topology, members: &[SurfaceVertex]) -> f64 {
    let area_of = |face: u32| face_area(surface.triangles[face as usize].map(|v| surface.positions[v.index()]));
    let area: f64 = members
        .iter()
        .map(|&vertex| topology.faces(vertex, &surface.triangles).map(area_of).sum::<f64>() / 3.0)
        .sum();
    let is_bare = |vertex: &SurfaceVertex| topology.neighbours(*vertex).is_empty();
    if area == 0.0 && members.iter().all(is_bare) {
        return radius_of_points(&surface.positions, members);
    }
    (area / PI).sqrt()
}

/// The radius of a disc whose points have this mean squared distance from its middle.
fn radius_of_points(positions: &[DVec3], members: &[SurfaceVertex]) -> f64 {
    let middle = centroid(positions, members.iter().copied());
    let squared = |vertex: &SurfaceVertex| positions[vertex.index()].distance_squared(middle);
    let sum: f64 = members.iter().map(squared).sum();
    (2.0 * sum / members.len().max(1) as f64).sqrt()
}

/// The mean position of some vertices; the origin for none.
pub(crate) fn centroid(positions: &[DVec3], vertices: impl Iterator<Item = SurfaceVertex>) -> DVec3 {
    let (mut sum, mut count) = (DVec3::ZERO, 0.0);
    for vertex in vertices {
        sum += positions[vertex.index()];
        count += 1.0;
    }
    if count > 0.0 { sum / count } else { DVec3::ZERO }
}
