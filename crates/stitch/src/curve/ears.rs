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
///
/// Only the corners beside a cut one are looked at again, so that a curve of thousands of points in one triangle takes
/// time by their square.
pub(super) fn triangles(
    polygon: &[u32],
    point: impl Fn(u32) -> DVec2,
    length: impl Fn(u32, u32) -> f64,
) -> Option<Vec<[u32; 3]>> {
    let mut left = polygon.to_vec();
    let mut found = Vec::new();
    let around = |left: &[u32], tip: usize| {
        let count = left.len();
        [(tip + count - 1) % count, tip, (tip + 1) % count].map(|place| left[place])
    };
    // The length of the cut at each corner; infinite if it is no ear.
    let cut = |left: &[u32], tip: usize| {
        let ear = around(left, tip);
        let [a, b, c] = ear.map(&point);
        let holds = |&other: &u32| {
            let p = point(other);
            [turn(a, b, p), turn(b, c, p), turn(c, a, p)]
                .iter()
                .all(|side| *side >= -FLAT)
        };
        let is_ear = turn(a, b, c) > FLAT && !left.iter().any(|other| !ear.contains(other) && holds(other));
        if is_ear { length(ear[0], ear[2]) } else { f64::INFINITY }
    };
    let all = |left: &[u32]| -> Vec<f64> { (0..left.len()).map(|tip| cut(left, tip)).collect() };
    let shortest = |cuts: &[f64]| {
        let ears = (0..cuts.len()).filter(|tip| cuts[*tip].is_finite());
        ears.min_by(|a, b| cuts[*a].total_cmp(&cuts[*b]))
    };
    let mut cuts = all(&left);
    while left.len() > 3 {
        let mut best = shortest(&cuts);
        if best.is_none() {
            // A corner in another one's triangle may be gone by now.
            cuts = all(&left);
            best = shortest(&cuts);
        }
        let best = best?;
        found.push(around(&left, best));
        left.remove(best);
        cuts.remove(best);
        let count = left.len();
        for tip in [(best + count - 1) % count, best % count] {
            cuts[tip] = cut(&left, tip);
        }
    }
    let [a, b, c] = left[..] else { return None };
    (turn(point(a), point(b), point(c)) > FLAT).then_some(())?;
    found.push([a, b, c]);
    Some(found)
}
