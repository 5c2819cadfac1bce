//! What joins loose parts: the nearest points of two, until all are one.

use glam::DVec3;

/// Pairs of points, the nearest first, that join all parts which the pairs `firm` do not join.
pub(crate) fn joins(points: &[DVec3], firm: &[[u32; 2]]) -> Vec<[u32; 2]> {
    let mut part: Vec<usize> = (0..points.len()).collect();
    let mut parts = points.len();
    for [one, other] in firm {
        let [one, other] = [one, other].map(|&point| root(&mut part, point as usize));
        parts -= usize::from(one != other);
        part[one.max(other)] = one.min(other);
    }
    let mut joins = Vec::new();
    if parts <= 1 {
        return joins;
    }
    let mut pairs: Vec<(f64, [u32; 2])> = Vec::new();
    for one in 0..points.len() {
        for other in one + 1..points.len() {
            if root(&mut part, one) != root(&mut part, other) {
                pairs.push((points[one].distance(points[other]), [one as u32, other as u32]));
            }
        }
    }
    // Of pairs that differ by rounding alone the first counts.
    let longest = pairs
        .iter()
        .fold(f64::MIN_POSITIVE, |longest, (distance, _)| longest.max(*distance));
    pairs.sort_by_cached_key(|(distance, pair)| ((distance / longest * 1e9).round() as u64, *pair));
    for (_, pair) in pairs {
        let [one, other] = pair.map(|point| root(&mut part, point as usize));
        if one != other {
            part[one.max(other)] = one.min(other);
            joins.push(pair);
        }
    }
    joins
}

/// The lowest point of a part, as far as it is known.
fn root(part: &mut [usize], mut point: usize) -> usize {
    while part[point] != point {
        part[point] = part[part[point]];
        point = part[point];
    }
    point
}
