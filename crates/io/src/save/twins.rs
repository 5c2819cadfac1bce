//! Twins: drawn vertices that a seam split. They must keep one normal so that the seam stays invisible.
//!
//! Exporters write the two sides of a seam in single precision or on grids of their own, so twins are rarely equal to
//! the bit. Vertices count as twins if they are closer to each other than a sixteenth of their shortest edge and their
//! normals agree within a degree; the two sides of a hard edge don't agree. Only vertices at the rim of the parts that
//! are connected by number can be a side of a seam, so few are compared.

use glam::DVec3;
use pliant_mesh::Drawn;

/// The share of a vertex's shortest edge within which its twins are.
const NEAR: f64 = 1.0 / 16.0;

/// The cosine of a degree.
const AGREEMENT: f64 = 0.999_847_695;

/// The number of neighbours along a line that are compared with a vertex, so that a search among a million vertices at
/// one place ends.
const MOST_COMPARED: usize = 64;

/// A direction that is no mesh's axis.
const DIRECTION: DVec3 = DVec3::new(0.533_817_26, 0.617_309_04, 0.577_854_49);

/// Calls `join` with each vertex of `among` (by number, all of them at a [rim]) and an earlier twin of it.
pub(super) fn for_each(
    drawn: &Drawn,
    normals: &[DVec3],
    is_at_rim: &[bool],
    among: &[u32],
    mut join: impl FnMut(u32, u32),
) {
    if among.is_empty() {
        return;
    }
    let reach = reaches(drawn, is_at_rim);
    let mut line: Vec<(f64, u32)> = (among.iter().copied())
        .filter(|&v| reach[v as usize] > 0.0)
        .map(|v| (drawn.positions[v as usize].dot(DIRECTION), v))
        .collect();
    line.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    let direction = |v: usize| normals.get(v).copied().unwrap_or_default().normalize_or_zero();
    for (place, &(along, v)) in line.iter().enumerate() {
        let (at, own) = (drawn.positions[v as usize], direction(v as usize));
        let before = line[..place].iter().rev().take(MOST_COMPARED);
        let near = before.take_while(|(other, _)| along - other <= reach[v as usize]);
        let twin = near.map(|&(_, other)| other).find(|&other| {
            let o = other as usize;
            let within = reach[v as usize].min(reach[o]);
            let other_direction = direction(o);
            let agree = own.dot(other_direction) > AGREEMENT || (own == DVec3::ZERO && other_direction == own);
            agree && at.distance_squared(drawn.positions[o]) <= within * within
        });
        if let Some(twin) = twin {
            join(v.max(twin), v.min(twin));
        }
    }
}

/// Whether each vertex is at the rim of the triangles around it, as the numbers of corners connect them, or in no
/// triangle. Around an interior vertex, each neighbour follows one triangle's corner and precedes another's, so that the
/// sums are equal; a rim with equal sums is as unlikely as two equal hashes.
pub(super) fn rim(drawn: &Drawn) -> Vec<bool> {
    let mut sums = vec![0_u64; drawn.positions.len()];
    let hash = |v: usize| (v as u64 + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15).rotate_left(29) ^ (v as u64);
    for corners in &drawn.triangles {
        let [a, b, c] = corners.map(|corner| corner.index());
        let [of_a, of_b, of_c] = [a, b, c].map(hash);
        for (v, next, last) in [(a, of_b, of_c), (b, of_c, of_a), (c, of_a, of_b)] {
            // The lowest bit says that the vertex is in a triangle.
            sums[v] = sums[v].wrapping_add(next.wrapping_sub(last) << 1) | 1;
        }
    }
    sums.into_iter().map(|sum| sum != 1).collect()
}

/// The largest distance of each vertex's twins; 0 for vertices that are not wanted or that no edge with a length
/// touches.
fn reaches(drawn: &Drawn, is_wanted: &[bool]) -> Vec<f64> {
    let mut shortest = vec![f64::INFINITY; drawn.positions.len()];
    for corners in &drawn.triangles {
        let corners = corners.map(|corner| corner.index());
        if !corners.iter().any(|&v| is_wanted[v]) {
            continue;
        }
        for (a, b) in [(0, 1), (1, 2), (2, 0)].map(|(a, b): (usize, usize)| (corners[a], corners[b])) {
            let length = drawn.positions[a].distance(drawn.positions[b]);
            if length > 0.0 {
                shortest[a] = shortest[a].min(length);
                shortest[b] = shortest[b].min(length);
            }
        }
    }
    let reach = shortest
        .into_iter()
        .map(|length| if length.is_finite() { NEAR * length } else { 0.0 });
    reach.collect()
}
