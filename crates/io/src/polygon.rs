//! Polygons as triangles, for drawing and bending faces with more than three corners. The file keeps the polygon.
//!
//! A quad is cut along the shorter of its diagonals that don't fold it over; if they are equal, along [one that a
//! mirror keeps](diagonals); a larger polygon is cut by ears in the plane of its Newell normal, which is right for
//! every simple planar polygon, convex or not. Ears cost n times the reflex corners, so polygons beyond [`MOST_EARS`]
//! corners, and those whose corners aren't finite, become a fan.

pub(crate) mod diagonals;

use glam::{DVec2, DVec3};
use pliant_mesh::geometry::{WithoutEar, ears};
use pliant_mesh::{Cancel, Cancelled, DrawnVertex};

use crate::convert::Polygons;
use diagonals::Diagonals;

/// The most corners that are cut by ears.
const MOST_EARS: usize = 256;

/// The number of corners of faces between two checks for cancellation.
pub(crate) const CORNERS_BETWEEN_LOOKS: usize = 1 << 12;

/// Cuts all faces of a file whose drawn vertices are its vertices in order. `corners` has the corners of all faces, one
/// after the other, and `face_ends` the end of each face. Gives the triangles, and the faces themselves if one isn't a
/// triangle.
pub(crate) fn cut_faces(
    positions: &[DVec3],
    corners: Vec<u32>,
    face_ends: &[u32],
    cancel: &Cancel,
) -> Result<(Vec<[DrawnVertex; 3]>, Option<Polygons>), Cancelled> {
    let mut triangles = Vec::with_capacity(corners.len().saturating_sub(2 * face_ends.len()));
    let diagonals = Diagonals::of(positions);
    let (mut start, mut looked_at) = (0, 0);
    for &end in face_ends {
        if end as usize >= looked_at {
            cancel.check()?;
            looked_at = end as usize + CORNERS_BETWEEN_LOOKS;
        }
        let face = &corners[start..end as usize];
        triangulate(
            face.len(),
            |k| positions[face[k] as usize],
            &diagonals,
            |triangle| triangles.push(triangle.map(|k| DrawnVertex(face[k]))),
        );
        start = end as usize;
    }
    let polygons = (triangles.len() != face_ends.len()).then(|| Polygons {
        offsets: [0].into_iter().chain(face_ends.iter().copied()).collect(),
        corners: corners.into_iter().map(DrawnVertex).collect(),
    });
    Ok((triangles, polygons))
}

/// A sentence about faces that draw nothing, if there are any.
pub(crate) fn left_out_note(count: usize) -> Option<String> {
    let faces = if count == 1 { "face" } else { "faces" };
    (count > 0)
        .then(|| format!("{count} {faces} with fewer than three corners left out of the surface; the file keeps them."))
}

/// Calls `emit` with the three corners (numbers within the polygon) of each triangle that `corners` is cut into:
/// n − 2 of them, wound as the polygon is; none for fewer than three corners.
///
/// `position` gives the position of a corner, numbered within the polygon; `diagonals` are those of the polygon's file.
pub(crate) fn triangulate(
    corner_count: usize,
    position: impl Fn(usize) -> DVec3,
    diagonals: &Diagonals<'_>,
    mut emit: impl FnMut([usize; 3]),
) {
    match corner_count {
        0..=2 => {}
        3 => emit([0, 1, 2]),
        4 => {
            let [a, b, c, d] = [position(0), position(1), position(2), position(3)];
            let normal = |p: DVec3, q: DVec3, r: DVec3| (q - p).cross(r - p);
            let along_ac = normal(a, b, c).dot(normal(a, c, d));
            let along_bd = normal(a, b, d).dot(normal(b, c, d));
            let cut_bd = match (along_ac > 0.0, along_bd > 0.0) {
                (true, true) => diagonals.takes_bd([a, b, c, d]),
                (ac, bd) => bd && !ac,
            };
            let triangles = if cut_bd {
                [[0, 1, 3], [1, 2, 3]]
            } else {
                [[0, 1, 2], [0, 2, 3]]
            };
            triangles.into_iter().for_each(emit);
        }
        _ if corner_count <= MOST_EARS => {
            let corners: Vec<DVec3> = (0..corner_count).map(position).collect();
            cut_ears(&corners, &mut emit);
        }
        _ => fan(corner_count, &mut emit),
    }
}

/// All triangles at corner 0.
fn fan(corner_count: usize, emit: &mut impl FnMut([usize; 3])) {
    for last in 2..corner_count {
        emit([0, last - 1, last]);
    }
}

/// Ears of the polygon projected along its Newell normal; every shape gives n − 2 triangles.
fn cut_ears(corners: &[DVec3], emit: &mut impl FnMut([usize; 3])) {
    let cut = flatten(corners).and_then(|flat| {
        let length = |a: usize, b: usize| flat[a].distance_squared(flat[b]);
        ears(&flat, 0.0, length, WithoutEar::CutSharpest)
    });
    match cut {
        Some(triangles) => triangles.into_iter().for_each(emit),
        None => fan(corners.len(), emit),
    }
}

/// The corners in the plane of the polygon, counterclockwise; `None` if it has no plane.
fn flatten(corners: &[DVec3]) -> Option<Vec<DVec2>> {
    let origin = corners[0];
    let mut newell = DVec3::ZERO;
    for (k, &corner) in corners.iter().enumerate() {
        newell += (corner - origin).cross(corners[(k + 1) % corners.len()] - origin);
    }
    let normal = newell.try_normalize()?;
    let (u, v) = normal.any_orthonormal_pair();
    Some(
        corners
            .iter()
            .map(|&corner| DVec2::new((corner - origin).dot(u), (corner - origin).dot(v)))
            .collect(),
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cut(corners: &[DVec3]) -> Vec<[usize; 3]> {
        let mut triangles = Vec::new();
        let diagonals = Diagonals::of(corners);
        triangulate(
            corners.len(),
            |k| corners[k],
            &diagonals,
            |triangle| triangles.push(triangle),
        );
        triangles
    }

    fn area(corners: &[DVec3], [a, b, c]: [usize; 3]) -> f64 {
        0.5 * (corners[b] - corners[a]).cross(corners[c] - corners[a]).z
    }

    #[test]
    fn every_simple_polygon_is_covered_once_by_triangles_of_its_own_winding() {
        let star: Vec<DVec3> = (0..14)
            .map(|k| {
                let angle = f64::from(k) / 14.0 * std::f64::consts::TAU;
                let radius = if k % 2 == 0 { 3.0 } else { 1.0 };
                DVec3::new(radius * angle.cos(), radius * angle.sin(), 5.0)
            })
            .collect();
        let comb: Vec<DVec3> = [
            [0., 0.],
            [5., 0.],
            [5., 3.],
            [4., 3.],
            [4., 1.],
            [3., 1.],
            [3., 3.],
            [2., 3.],
            [2., 1.],
            [1., 1.],
            [1., 3.],
            [0., 3.],
        ]
        .map(|[x, y]: [f64; 2]| DVec3::new(x, y, 0.0))
        .to_vec();
        let dart: Vec<DVec3> = [[0., 0.], [4., 0.], [1., 1.], [0., 4.]]
            .map(|[x, y]: [f64; 2]| DVec3::new(x, y, 0.0))
            .to_vec();
        for polygon in [star, comb, dart] {
            for start in 0..polygon.len() {
                let mut turned = polygon.clone();
                turned.rotate_left(start);
                let triangles = cut(&turned);
                assert_eq!(triangles.len(), turned.len() - 2);
                let whole: f64 = (0..turned.len())
                    .map(|k| 0.5 * turned[k].cross(turned[(k + 1) % turned.len()]).z)
                    .sum();
                let sum: f64 = triangles.iter().map(|&triangle| area(&turned, triangle)).sum();
                assert!((sum - whole).abs() < 1e-9, "{sum} of {whole}");
                assert!(triangles.iter().all(|&triangle| area(&turned, triangle) >= 0.0));
            }
        }
    }

    #[test]
    fn shapes_without_a_plane_still_give_n_minus_2_triangles() {
        let shapes = [
            vec![DVec3::ZERO; 7],
            vec![DVec3::NAN; 6],
            vec![DVec3::NAN; 4],
            (0..9).map(|k| DVec3::X * f64::from(k)).collect(),
            (0..2000)
                .map(|k| DVec3::new(f64::from(k).cos(), f64::from(k).sin(), 0.0))
                .collect(),
        ];
        for shape in shapes {
            assert_eq!(cut(&shape).len(), shape.len() - 2);
        }
        assert!(cut(&[DVec3::ZERO, DVec3::X]).is_empty());
    }

    /// Faces of a file, as cut: each triangle by the positions of its corners, in an order that does not depend on
    /// their numbers.
    fn cut_of(positions: &[DVec3], faces: &[[u32; 4]]) -> Vec<[[i64; 3]; 3]> {
        let ends: Vec<u32> = (1..=faces.len() as u32).map(|face| 4 * face).collect();
        let cut = cut_faces(positions, faces.as_flattened().to_vec(), &ends, &Cancel::new());
        let (triangles, _) = cut.unwrap_or_default();
        let mut places: Vec<[[i64; 3]; 3]> = (triangles.iter())
            .map(|corners| {
                let place =
                    |corner: DrawnVertex| positions[corner.index()].to_array().map(|x| (x * 1e4).round() as i64);
                let mut places = corners.map(place);
                places.sort_unstable();
                places
            })
            .collect();
        places.sort_unstable();
        places
    }

    /// A tower of square or round section whose quads all have equal diagonals; the corners of each face begin
    /// anywhere. `lean` leaves it one plane of symmetry, across x.
    fn tower(sides: usize, is_square: bool, lean: f64) -> (Vec<DVec3>, Vec<[u32; 4]>) {
        let (mut positions, mut faces) = (Vec::new(), Vec::new());
        let rings = 9;
        for ring in 0..rings {
            for side in 0..sides {
                let turn = (side as f64 / sides as f64) * std::f64::consts::TAU;
                let (sin, cos) = turn.sin_cos();
                let out = if is_square { 1.0 / sin.abs().max(cos.abs()) } else { 1.0 };
                let depth = if sin > 0.0 { 1.0 + lean } else { 1.0 };
                let height = 0.4 * ring as f64 * (1.0 + lean * ring as f64 / 40.0);
                positions.push(DVec3::new(out * cos, height, depth * out * sin));
            }
        }
        for ring in 0..rings - 1 {
            for side in 0..sides {
                let corner = |ring: usize, side: usize| (ring * sides + side % sides) as u32;
                let mut face = [
                    corner(ring, side),
                    corner(ring + 1, side),
                    corner(ring + 1, side + 1),
                    corner(ring, side + 1),
                ];
                face.rotate_left((ring * 3 + side * 5) % 4);
                faces.push(face);
            }
        }
        (positions, faces)
    }

    #[test]
    fn a_mirror_image_is_cut_as_the_image_of_the_cut() {
        let turned = glam::DQuat::from_rotation_y(0.4) * glam::DQuat::from_rotation_x(1.1);
        let straight = glam::DQuat::IDENTITY;
        for (sides, is_square) in [(16, true), (8, true), (12, false), (20, false)] {
            // If a figure has several planes, the one across the world's first axis is kept.
            for (lean, turn, by) in [
                (0.0, straight, DVec3::ZERO),
                (0.0, straight, DVec3::ONE * 7.0),
                (0.5, straight, DVec3::ONE * 7.0),
                (0.5, turned, DVec3::X),
            ] {
                let (positions, faces) = tower(sides, is_square, lean);
                let placed = |p: DVec3| turn * p + by;
                let own: Vec<DVec3> = positions.iter().map(|p| placed(*p)).collect();
                let images: Vec<DVec3> = positions
                    .iter()
                    .map(|p| placed(*p * DVec3::new(-1.0, 1.0, 1.0)))
                    .collect();
                let wound_back: Vec<[u32; 4]> = faces.iter().map(|&[a, b, c, d]| [a, d, c, b]).collect();
                // The figure is its own image, so the image's triangles are its triangles.
                let (cut, cut_of_image) = (cut_of(&own, &faces), cut_of(&images, &wound_back));
                let differ = cut.iter().filter(|triangle| !cut_of_image.contains(triangle)).count();
                assert_eq!(differ, 0, "{sides} sides, lean {lean}, at {by}");
                // So are they when its corners are cut by the rule for a mirror.
                let mirrored = |place: &[i64; 3]| -> [i64; 3] {
                    let p = DVec3::from_array(place.map(|x| x as f64 / 1e4));
                    let back = turn.inverse() * (p - by) * DVec3::new(-1.0, 1.0, 1.0);
                    placed(back).to_array().map(|x| (x * 1e4).round() as i64)
                };
                let near = |a: &[i64; 3], b: &[i64; 3]| a.iter().zip(b).all(|(a, b)| (a - b).abs() <= 2);
                let has_image = |triangle: &&[[i64; 3]; 3]| {
                    let image = triangle.map(|place| mirrored(&place));
                    let is_image = |other: &[[i64; 3]; 3]| image.iter().all(|a| other.iter().any(|b| near(a, b)));
                    cut.iter().any(is_image)
                };
                // A face across the plane, which only round sections of some sizes have, has no such cut.
                let lone = cut.iter().filter(|triangle| !has_image(triangle)).count();
                assert_eq!(lone, 0, "{sides} sides, lean {lean}, at {by}");
            }
        }
    }
}
