//! Flips edges until the triangulation is Delaunay on the patch.

use glam::DVec3;

use super::patch::Patch;

/// The flips allowed for each edge: a patch in space may have no Delaunay triangulation.
const MOST_FLIPS: usize = 8;

/// An edge is flipped if its two opposite angles exceed half a turn by about this, so that rounding does not flip it
/// back.
const SLACK: f64 = 1e-9;

/// Flips edges inside the patch whose opposite angles add up to more than half a turn, unless that would double an edge
/// or fold the patch.
pub(crate) fn flip_until_delaunay(patch: &mut Patch) {
    let mut waiting: Vec<[u32; 2]> = Vec::with_capacity(3 * patch.triangles.len());
    for &[a, b, c] in &patch.triangles {
        waiting.extend([[a, b], [b, c], [c, a]].into_iter().filter(|[from, to]| from < to));
    }
    let mut left = MOST_FLIPS * waiting.len();
    while let Some(edge) = waiting.pop() {
        let Some([c, d]) = other_diagonal(patch, edge) else {
            continue;
        };
        if left == 0 {
            return;
        }
        left -= 1;
        patch.flip(edge);
        let [a, b] = edge;
        waiting.extend([[a, c], [c, b], [b, d], [d, a]]);
    }
}

/// The points that a flip of this edge would join; `None` if it should not be flipped.
fn other_diagonal(patch: &Patch, edge: [u32; 2]) -> Option<[u32; 2]> {
    let [a, b] = edge;
    let (left, right) = (patch.left_of(a, b)?, patch.left_of(b, a)?);
    let (c, d) = (patch.opposite(left, edge), patch.opposite(right, edge));
    let [pa, pb, pc, pd] = [a, b, c, d].map(|point| patch.points[point as usize]);
    if !is_beyond_half_a_turn([pa, pb], pc, pd) || c == d || patch.is_edge(c, d) {
        return None;
    }
    // Both new triangles must face the average direction of the old ones.
    let normal = |p: DVec3, q: DVec3, r: DVec3| (q - p).cross(r - p);
    let before = normal(pa, pb, pc).normalize_or_zero() + normal(pb, pa, pd).normalize_or_zero();
    let (one, two) = (normal(pa, pd, pc), normal(pd, pb, pc));
    let floor = 1e-12 * (pc - pd).length_squared() * before.length();
    let is_upright = before == DVec3::ZERO || (one.dot(before) > floor && two.dot(before) > floor);
    is_upright.then_some([c, d])
}

/// True if the angles at which two points see an edge add up to more than half a turn: then the sine of their sum is
/// negative.
fn is_beyond_half_a_turn([a, b]: [DVec3; 2], c: DVec3, d: DVec3) -> bool {
    let (u, v, s, t) = (a - c, b - c, a - d, b - d);
    let ([sine, cosine], [other_sine, other_cosine]) =
        ([u.cross(v).length(), u.dot(v)], [s.cross(t).length(), s.dot(t)]);
    let (one, other) = (sine.hypot(cosine), other_sine.hypot(other_cosine));
    sine * other_cosine + cosine * other_sine < -SLACK * one * other
}
