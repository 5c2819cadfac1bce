//! The tufted cover [SC20, section 3]: every triangle twice, once for each of its sides, glued so that every edge has
//! exactly two.
//!
//! Around an edge the triangles are like the pages of a book; each one's back is glued to the next one's front. A
//! border's single triangle is glued to its own back, two triangles give the surface's outside and inside.

use std::collections::BTreeMap;

use glam::DVec3;
use pliant_mesh::SurfaceVertex;

use crate::operators::triangulation::flips::Sides;
use crate::operators::triangulation::surface::SurfaceTriangulation;

/// The sides of triangles, numbered 3 f + i for the one opposite corner i of triangle f, by their edge.
pub(crate) fn edges(triangulation: &SurfaceTriangulation) -> impl Iterator<Item = Vec<u32>> + use<> {
    let mut keyed: Vec<([u32; 2], u32)> = Vec::with_capacity(3 * triangulation.surface.triangles.len());
    for (face, corners) in triangulation.surface.triangles.iter().enumerate() {
        for i in 0..3 {
            let (from, to) = (corners[(i + 1) % 3].0, corners[(i + 2) % 3].0);
            keyed.push(([from.min(to), from.max(to)], (3 * face + i) as u32));
        }
    }
    keyed.sort_unstable();
    let mut grouped: Vec<Vec<u32>> = Vec::new();
    let mut last = None;
    for (edge, side) in keyed {
        match grouped.last_mut() {
            Some(group) if last == Some(edge) => group.push(side),
            _ => grouped.push(vec![side]),
        }
        last = Some(edge);
    }
    grouped.into_iter()
}

/// The cover with the surface triangles' lengths: triangle f's front is f, its back f plus their count.
pub(crate) fn cover(triangulation: &SurfaceTriangulation, lengths: &[[f64; 3]]) -> Sides {
    let fronts = &triangulation.surface.triangles;
    let backs = fronts.iter().map(|[a, b, c]| [*a, *c, *b]);
    let corners: Vec<[SurfaceVertex; 3]> = fronts.iter().copied().chain(backs).collect();
    let turned = lengths.iter().map(|[a, b, c]| [*a, *c, *b]);
    let mut sides = Sides::new(corners, lengths.iter().copied().chain(turned).collect());
    let first_back = 3 * fronts.len() as u32;
    // A side on the back is opposite the same corner: 1 and 2 have changed places.
    let back = |side: u32| first_back + side - side % 3 + (3 - side % 3) % 3;
    for mut edge in edges(triangulation) {
        if edge.len() > 2 {
            sort_around(triangulation, &mut edge);
        }
        // The one of a triangle's two copies that runs along the edge from its lower vertex, and the other.
        let copies = |side: u32| {
            let (face, i) = (side as usize / 3, side as usize % 3);
            let runs_up = fronts[face][(i + 1) % 3] < fronts[face][(i + 2) % 3];
            if runs_up {
                (side, back(side))
            } else {
                (back(side), side)
            }
        };
        for (place, &side) in edge.iter().enumerate() {
            let next = edge[(place + 1) % edge.len()];
            sides.join(copies(side).0, copies(next).1);
        }
    }
    sides
}

/// Sorts the sides on an edge by the angles of their triangles around it.
fn sort_around(triangulation: &SurfaceTriangulation, edge: &mut [u32]) {
    let position = |vertex: SurfaceVertex| triangulation.surface.positions[vertex.index()];
    let corners = |side: u32| {
        let (face, i) = (side as usize / 3, side as usize % 3);
        let corners = triangulation.surface.triangles[face];
        (corners[i], corners[(i + 1) % 3], corners[(i + 2) % 3])
    };
    let (_, a, b) = corners(edge[0]);
    let (low, high) = (position(a.min(b)), position(a.max(b)));
    let axis = (high - low).normalize_or(DVec3::X);
    let (across, over) = axis.any_orthonormal_pair();
    let angles: BTreeMap<u32, f64> = edge
        .iter()
        .map(|&side| {
            let arm = position(corners(side).0) - low;
            (side, arm.dot(over).atan2(arm.dot(across)))
        })
        .collect();
    edge.sort_by(|one, other| angles[one].total_cmp(&angles[other]).then(one.cmp(other)));
}
