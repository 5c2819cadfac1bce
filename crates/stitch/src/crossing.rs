//! Crossings of a closed line with itself.

use glam::DVec3;

/// Two edges of a line cross if they are this close to each other, in units of the shorter one.
const TOUCH: f64 = 1e-9;

/// The first pair of edges of a closed line that cross each other inside both; each edge has the number of its first
/// point. Edges that only meet at an end don't cross.
pub(crate) fn first_crossing(points: &[DVec3]) -> Option<[usize; 2]> {
    let count = points.len();
    let edge = |k: usize| [points[k], points[(k + 1) % count]];
    // The sweep follows the longest axis: edges that are apart there can't cross.
    let low = points.iter().copied().fold(DVec3::INFINITY, DVec3::min);
    let high = points.iter().copied().fold(DVec3::NEG_INFINITY, DVec3::max);
    let size = high - low;
    let axis = (0..3).fold(0, |best, axis| if size[axis] > size[best] { axis } else { best });
    let span = |k: usize| {
        let [from, to] = edge(k);
        [from[axis].min(to[axis]), from[axis].max(to[axis])]
    };
    let mut order: Vec<usize> = (0..count).collect();
    order.sort_by(|&a, &b| span(a)[0].total_cmp(&span(b)[0]).then(a.cmp(&b)));
    let mut open: Vec<usize> = Vec::new();
    let mut found: Option<[usize; 2]> = None;
    for &k in &order {
        open.retain(|&other| span(other)[1] >= span(k)[0]);
        for &other in &open {
            let are_next = (k + 1) % count == other || (other + 1) % count == k;
            if !are_next && cross(edge(k), edge(other)) {
                let pair = [k.min(other), k.max(other)];
                found = Some(found.map_or(pair, |best| best.min(pair)));
            }
        }
        open.push(k);
    }
    found
}

/// True if two segments pass through each other inside both.
fn cross([a, b]: [DVec3; 2], [c, d]: [DVec3; 2]) -> bool {
    let (u, v, w) = (b - a, d - c, c - a);
    let normal = u.cross(v);
    let square = normal.length_squared();
    let (long, short) = (u.length().max(v.length()), u.length().min(v.length()));
    if square <= (TOUCH * long * short).powi(2) {
        return false;
    }
    // a + s u and c + t v are the nearest points of both.
    let s = w.cross(v).dot(normal) / square;
    let t = w.cross(u).dot(normal) / square;
    let gap = (w.dot(normal) / square.sqrt()).abs();
    let is_inside = |x: f64| x > TOUCH && x < 1.0 - TOUCH;
    gap <= TOUCH * short && is_inside(s) && is_inside(t)
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::first_crossing;

    fn flat(points: &[[f64; 2]]) -> Vec<DVec3> {
        points.iter().map(|&[x, y]| DVec3::new(x, y, 0.5)).collect()
    }

    #[test]
    fn a_figure_of_eight_crosses_itself_and_a_polygon_does_not() {
        let eight = flat(&[[0.0, 0.0], [2.0, 2.0], [2.0, 0.0], [0.0, 2.0]]);
        assert_eq!(first_crossing(&eight), Some([0, 2]));
        let hollow = flat(&[[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [1.0, 0.5], [0.0, 2.0]]);
        assert_eq!(first_crossing(&hollow), None);
    }

    #[test]
    fn lifting_one_arm_of_the_eight_ends_the_crossing() {
        let mut eight = flat(&[[0.0, 0.0], [2.0, 2.0], [2.0, 0.0], [0.0, 2.0]]);
        eight[1].z += 1.0;
        assert_eq!(first_crossing(&eight), None);
    }
}
