//! Checks a cage that a person gives, and finds the points outside it.

use std::collections::BTreeMap;

use glam::DVec3;
use rayon::prelude::*;

use super::crossings::met;
use super::mesh::CageMesh;
use crate::attachment::{Attachment, ControlMesh, finite};
use crate::attachment_refused::AttachmentRefused;

/// The fewest and the most vertices: the equations by which the handles drive a cage are dense.
const VERTICES: [usize; 2] = [4, 3000];

/// A triangle of less than this share of the cage's size squared has no area, and a cage of less than this share of its
/// size cubed has no volume.
const NOTHING: f64 = 1e-14;

/// Refuses anything but a closed triangle mesh around a volume.
pub(super) fn check(attachment: &Attachment) -> Result<(), AttachmentRefused> {
    let Attachment::Mesh(mesh) = attachment else {
        return Err(AttachmentRefused::Kind);
    };
    let (found, [least, most]) = (mesh.rest.len(), VERTICES);
    if !(least..=most).contains(&found) {
        return Err(AttachmentRefused::PointCount { found, least, most });
    }
    finite(&mesh.rest)?;
    check_corners(mesh)?;
    check_edges(&mesh.triangles)?;
    let size = size(&mesh.rest);
    let flat = mesh.triangles.iter().position(|corners| {
        let [a, b, c] = corners.map(|corner| mesh.rest[corner as usize]);
        (b - a).cross(c - a).length() <= NOTHING * size * size
    });
    match flat {
        Some(triangle) => Err(AttachmentRefused::NoArea { triangle }),
        None if volume(mesh).abs() <= NOTHING * size.powi(3) => Err(AttachmentRefused::NoVolume),
        None => Ok(()),
    }
}

/// The faces, counterclockwise seen from outside.
pub(super) fn outward_faces(mesh: &ControlMesh) -> Vec<[u32; 3]> {
    match volume(mesh) < 0.0 {
        true => mesh.triangles.iter().map(|&[a, b, c]| [a, c, b]).collect(),
        false => mesh.triangles.to_vec(),
    }
}

/// A flag for each point that is outside a cage: a line along x from it crosses the cage an even number of times.
pub(super) fn are_outside(cage: &CageMesh, points: &[DVec3]) -> Vec<bool> {
    let faces = (0..cage.faces.len()).map(|face| {
        let corners = cage.corners(face);
        let planar = corners.map(|corner| [corner.y, corner.z]);
        let [low, high] = [DVec3::min, DVec3::max].map(|of| of(of(corners[0], corners[1]), corners[2]));
        (face, planar, low, high)
    });
    let faces: Vec<_> = faces.collect();
    let is_outside = |&point: &DVec3| {
        let mut is_outside = true;
        for (face, planar, low, high) in &faces {
            if point.y < low.y || point.y > high.y || point.z < low.z || point.z > high.z || point.x > high.x {
                continue;
            }
            if let Some(shares) = met(&cage.faces[*face], *planar, [point.y, point.z]) {
                let corners = cage.corners(*face);
                let at: f64 = (0..3).map(|k| shares[k] * corners[k].x).sum();
                is_outside ^= at > point.x;
            }
        }
        is_outside
    };
    points.par_iter().map(is_outside).collect()
}

fn check_corners(mesh: &ControlMesh) -> Result<(), AttachmentRefused> {
    let count = mesh.rest.len();
    let mut is_used = vec![false; count];
    for (triangle, corners) in mesh.triangles.iter().enumerate() {
        for &vertex in corners {
            match is_used.get_mut(vertex as usize) {
                Some(is_used) => *is_used = true,
                None => {
                    return Err(AttachmentRefused::NoSuchVertex {
                        triangle,
                        vertex,
                        count,
                    });
                }
            }
        }
    }
    match is_used.iter().position(|is_used| !is_used) {
        Some(vertex) => Err(AttachmentRefused::UnusedVertex { vertex }),
        None => Ok(()),
    }
}

/// Refuses edges that do not have two triangles, one in each direction.
fn check_edges(triangles: &[[u32; 3]]) -> Result<(), AttachmentRefused> {
    let mut along: BTreeMap<[u32; 2], [u32; 2]> = BTreeMap::new();
    for (triangle, &[a, b, c]) in triangles.iter().enumerate() {
        if a == b || b == c || c == a {
            return Err(AttachmentRefused::NoArea { triangle });
        }
        for [from, to] in [[a, b], [b, c], [c, a]] {
            let counts = along.entry([from.min(to), from.max(to)]).or_default();
            counts[usize::from(from < to)] += 1;
        }
    }
    for ([a, b], counts) in along {
        match counts {
            [1, 1] => {}
            [0, 1] | [1, 0] => return Err(AttachmentRefused::Open(a, b)),
            [0, 2] | [2, 0] => return Err(AttachmentRefused::Turned(a, b)),
            _ => return Err(AttachmentRefused::NonManifold(a, b)),
        }
    }
    Ok(())
}

/// The enclosed volume, negative if the triangles face inward.
fn volume(mesh: &ControlMesh) -> f64 {
    // A made cage around no points has no vertex.
    let origin = mesh.rest.first().copied().unwrap_or_default();
    let volumes = mesh.triangles.iter().map(|corners| {
        let [a, b, c] = corners.map(|corner| mesh.rest[corner as usize] - origin);
        a.cross(b).dot(c) / 6.0
    });
    volumes.sum()
}

/// The diagonal of the points' box.
fn size(points: &[DVec3]) -> f64 {
    let (low, high) = points
        .iter()
        .fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), &point| {
            (low.min(point), high.max(point))
        });
    low.distance(high)
}
