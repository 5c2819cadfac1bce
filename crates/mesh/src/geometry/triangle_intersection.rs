//! The segment in which two triangles pass through each other.

use glam::DVec3;

/// Rounding of [`side`] is below this times the sum of its terms' sizes: (7 + 56ε)ε of [She97], with ε = 2⁻⁵³.
const SIDE_ERROR: f64 = 7.771_561_172_376_104e-16;

/// The segment in which two triangles pass through each other; `None` if they are apart, only touch, or are in one
/// plane, as far as f64 can decide.
///
/// Corners in bit-equal positions are shared: triangles that share an edge never pass through each other, and triangles
/// that share a corner do so if they also meet elsewhere.
pub fn triangle_intersection(a: [DVec3; 3], b: [DVec3; 3]) -> Option<[DVec3; 2]> {
    let is_shared = |corner: &&DVec3| b.contains(corner);
    let shared: Vec<DVec3> = a.iter().filter(is_shared).copied().collect();
    if shared.len() > 1 || are_boxes_apart(&a, &b) {
        return None;
    }
    let pierced = |edges: [DVec3; 3], by: [DVec3; 3]| {
        let edges = [[0, 1], [1, 2], [2, 0]].map(|ends| ends.map(|end| edges[end]));
        // An edge that begins on the other triangle is on no side of it.
        edges.into_iter().filter_map(move |edge| pierced(edge, by))
    };
    let mut ends = shared.iter().copied().chain(pierced(a, b)).chain(pierced(b, a));
    let first = ends.next()?;
    // Takes the two farthest points, because rounding may give an edge two.
    ends.max_by(|p, q| p.distance_squared(first).total_cmp(&q.distance_squared(first)))
        .filter(|last| *last != first)
        .map(|last| [first, last])
}

/// The point where the edge passes through a triangle. The triangle's border counts: two halves that are each other's
/// mirror image meet only in such points.
fn pierced([p, q]: [DVec3; 2], [a, b, c]: [DVec3; 3]) -> Option<DVec3> {
    let (before, after) = (side([a, b, c], p), side([a, b, c], q));
    let are_opposite = (before > 0.0 && after < 0.0) || (before < 0.0 && after > 0.0);
    if !are_opposite {
        return None;
    }
    let around = [[a, b], [b, c], [c, a]].map(|[from, to]| side([p, q, from], to));
    let is_inside = around.iter().all(|side| *side >= 0.0) || around.iter().all(|side| *side <= 0.0);
    is_inside.then(|| p + (q - p) * (before / (before - after)))
}

/// Six times the signed volume of the tetrahedron a b c d, which says on which side of the triangle d is; 0 if its sign
/// is uncertain.
fn side([a, b, c]: [DVec3; 3], d: DVec3) -> f64 {
    let (a, b, c) = (a - d, b - d, c - d);
    let volume = a.dot(b.cross(c));
    let size = |u: DVec3, v: DVec3| DVec3::new(v.y, v.z, v.x) * DVec3::new(u.z, u.x, u.y);
    let terms = |u: DVec3, v: DVec3| size(u.abs(), v.abs()) + size(v.abs(), u.abs());
    let bound = SIDE_ERROR * a.abs().dot(terms(b, c));
    if volume.abs() > bound { volume } else { 0.0 }
}

fn are_boxes_apart(a: &[DVec3; 3], b: &[DVec3; 3]) -> bool {
    let low = |corners: &[DVec3; 3]| corners[0].min(corners[1]).min(corners[2]);
    let high = |corners: &[DVec3; 3]| corners[0].max(corners[1]).max(corners[2]);
    low(a).cmpgt(high(b)).any() || low(b).cmpgt(high(a)).any()
}

#[cfg(test)]
#[allow(clippy::expect_used, reason = "a test that can't go on fails")]
mod tests {
    use super::*;

    fn triangle(corners: [[f64; 3]; 3]) -> [DVec3; 3] {
        corners.map(DVec3::from_array)
    }

    const FLAT: [[f64; 3]; 3] = [[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0]];

    #[test]
    fn a_blade_through_a_sheet_meets_it_in_a_segment() {
        let blade = triangle([[1.0, 1.0, -1.0], [1.0, 1.0, 1.0], [1.0, 2.0, 1.0]]);
        for (a, b) in [(triangle(FLAT), blade), (blade, triangle(FLAT))] {
            let mut ends = triangle_intersection(a, b).expect("they meet");
            ends.sort_by(|p, q| p.y.total_cmp(&q.y));
            assert!(ends[0].distance(DVec3::new(1.0, 1.0, 0.0)) < 1e-12, "{ends:?}");
            assert!(ends[1].distance(DVec3::new(1.0, 1.5, 0.0)) < 1e-12, "{ends:?}");
        }
    }

    #[test]
    fn what_touches_lies_in_one_plane_or_is_a_neighbour_passes_through_nothing() {
        for other in [
            // Beside it, above it, and on the same plane.
            [[5.0, 5.0, -1.0], [5.0, 5.0, 1.0], [6.0, 5.0, 0.0]],
            [[1.0, 1.0, 0.1], [2.0, 1.0, 1.0], [1.0, 2.0, 1.0]],
            [[1.0, 1.0, 0.0], [2.0, 1.0, 0.0], [1.0, 2.0, 0.0]],
            // A corner or an edge on it.
            [[1.0, 1.0, 0.0], [2.0, 1.0, 1.0], [1.0, 2.0, 1.0]],
            [[1.0, 1.0, 0.0], [2.0, 1.0, 0.0], [1.0, 2.0, 1.0]],
            // Neighbours across an edge, folded down or not, and across a corner.
            [[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [1.0, 1.0, 1e-9]],
            [[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [1.0, 1.0, 0.0]],
            [[0.0, 0.0, 0.0], [1.0, 1.0, 1.0], [2.0, 1.0, 1.0]],
            // The same.
            FLAT,
        ] {
            for turn in 0..3 {
                let mut corners = triangle(other);
                corners.rotate_left(turn);
                assert_eq!(triangle_intersection(triangle(FLAT), corners), None, "{other:?}");
                assert_eq!(triangle_intersection(corners, triangle(FLAT)), None, "{other:?}");
            }
        }
    }

    #[test]
    fn neighbours_over_a_corner_meet_beyond_it() {
        let through = triangle([[0.0, 0.0, 0.0], [2.0, 1.0, 1.0], [1.0, 2.0, -1.0]]);
        let [from, to] = triangle_intersection(triangle(FLAT), through).expect("they meet");
        assert_eq!(from, DVec3::ZERO);
        assert!(to.distance(DVec3::new(1.5, 1.5, 0.0)) < 1e-12);
    }

    #[test]
    fn mirror_images_meet_in_their_plane() {
        let left = triangle([[-1.0, 0.0, 0.0], [0.5, 1.0, 0.0], [0.5, 0.0, 1.0]]);
        let right = left.map(|p| DVec3::new(-p.x, p.y, p.z));
        let ends = triangle_intersection(left, right).expect("they meet");
        for end in ends {
            assert!(
                end.x.abs() < 1e-12 && (end.y + end.z - 2.0 / 3.0).abs() < 1e-12,
                "{ends:?}"
            );
        }
    }

    #[test]
    fn it_is_the_same_far_from_the_origin_and_small() {
        let place = |corners: [DVec3; 3]| corners.map(|p| p * 1e-3 + DVec3::new(4e5, 5e6, 30.0));
        let blade = triangle([[1.0, 1.0, -1.0], [1.0, 1.0, 1.0], [1.0, 2.0, 1.0]]);
        assert!(triangle_intersection(place(triangle(FLAT)), place(blade)).is_some());
    }
}
