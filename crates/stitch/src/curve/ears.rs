//! Triangles of a polygon, by cutting off ears [Mei75].

use glam::DVec2;

/// Twice the area of a triangle, in the plane of the polygon; counterclockwise is positive.
pub(super) fn turn(a: DVec2, b: DVec2, c: DVec2) -> f64 {
    (b - a).perp_dot(c - a)
}

/// Smaller triangles, of one with twice the area 1, have no sure direction.
const FLAT: f64 = 1e-15;

/// Triangles of a simple counterclockwise polygon, by numbers of points. Its corners may be on lines, and a hole may be
/// joined to its outline by an edge there and back. Of possible ears, that with the shortest cut goes first, as `length`
/// measures. `None` if it has no sure ear: points are too near to each other.
pub(super) fn triangles(
    polygon: &[u32],
    point: impl Fn(u32) -> DVec2,
    length: impl Fn(u32, u32) -> f64,
) -> Option<Vec<[u32; 3]>> {
    let mut left = polygon.to_vec();
    let mut found = Vec::new();
    while left.len() > 3 {
        let count = left.len();
        let corners = |place: usize| [place, place + 1, place + 2].map(|place| left[place % count]);
        let is_ear = |&place: &usize| {
            let ear = corners(place);
            let [a, b, c] = ear.map(&point);
            let holds = |&other: &u32| {
                let p = point(other);
                [turn(a, b, p), turn(b, c, p), turn(c, a, p)]
                    .iter()
                    .all(|side| *side >= -FLAT)
            };
            turn(a, b, c) > FLAT && !left.iter().any(|other| !ear.contains(other) && holds(other))
        };
        let cut = |&place: &usize| {
            let [a, _, c] = corners(place);
            length(a, c)
        };
        let ears = (0..count).filter(is_ear);
        let best = ears.min_by(|a, b| cut(a).total_cmp(&cut(b)))?;
        found.push(corners(best));
        left.remove((best + 1) % count);
    }
    let [a, b, c] = left[..] else { return None };
    (turn(point(a), point(b), point(c)) > FLAT).then_some(())?;
    found.push([a, b, c]);
    Some(found)
}
