//! Cuts a long polygon in two along the chord that is shortest relative to the lines on both sides of it.

use crate::fill::rim::Rim;

/// About this many points are tried as ends of the chord.
const TRIED: usize = 600;

/// Each side keeps at least this share of the points.
const LEAST_SHARE: f64 = 0.2;

/// The best chord between two points of `polygon` (points of the rim), by their places in it; `None` if the surface
/// already joins all tried pairs.
///
/// It is the shortest in units of the shorter way along the polygon, so that it cuts a slit across and not along, and
/// neither side has few points: so log n rounds of cutting suffice.
pub(crate) fn best_chord(rim: &Rim<'_>, polygon: &[u32]) -> Option<[usize; 2]> {
    let count = polygon.len();
    let point = |place: usize| rim.points[polygon[place] as usize];
    let mut ways = vec![0.0; count + 1];
    for place in 0..count {
        ways[place + 1] = ways[place] + point(place).distance(point((place + 1) % count));
    }
    let step = count.div_ceil(TRIED);
    let least = ((count as f64 * LEAST_SHARE) as usize).max(2);
    let mut best: Option<(f64, [usize; 2])> = None;
    for from in (0..count).step_by(step) {
        for to in (from + least..count.min(from + count - least + 1)).step_by(step) {
            let along = ways[to] - ways[from];
            let shorter = along.min(ways[count] - along);
            let ratio = point(from).distance(point(to)) / shorter.max(f64::MIN_POSITIVE);
            if best.is_none_or(|(least, _)| ratio < least) && !rim.joined.contains(polygon[from], polygon[to]) {
                best = Some((ratio, [from, to]));
            }
        }
    }
    best.map(|(_, chord)| chord)
}
