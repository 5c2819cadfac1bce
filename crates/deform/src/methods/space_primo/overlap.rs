//! Whether a triangle and a cube overlap, by separating axes.

use glam::DVec3;

/// Returns true if the triangle meets the cube about the origin with this half side.
pub(super) fn overlap(corners: [DVec3; 3], half: f64) -> bool {
    let [a, b, c] = corners;
    let (low, high) = (a.min(b).min(c), a.max(b).max(c));
    if low.max_element() > half || high.min_element() < -half {
        return false;
    }
    let edges = [b - a, c - b, a - c];
    let separates = |axis: DVec3| {
        let along = corners.map(|corner| axis.dot(corner));
        let reach = half * (axis.x.abs() + axis.y.abs() + axis.z.abs());
        let (least, most) = (
            along[0].min(along[1]).min(along[2]),
            along[0].max(along[1]).max(along[2]),
        );
        least > reach || most < -reach
    };
    if separates(edges[0].cross(edges[1])) {
        return false;
    }
    !edges
        .into_iter()
        .any(|edge| DVec3::AXES.into_iter().any(|axis| separates(axis.cross(edge))))
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::overlap;

    /// Against dense points of the triangle.
    #[test]
    fn a_triangle_with_a_point_inside_overlaps_and_one_far_from_all_does_not() {
        let noise = |k: usize| 3.0 * ((k as f64 * 12.9898).sin() * 43_758.545).fract();
        let (mut met, mut missed) = (0, 0);
        for i in 0..2000 {
            let corner = |k: usize| DVec3::new(noise(9 * i + k), noise(9 * i + k + 1), noise(9 * i + k + 2));
            let [a, b, c] = [corner(0), corner(3), corner(6)];
            let steps = 60;
            let mut least = f64::INFINITY;
            for u in 0..=steps {
                for v in 0..=steps - u {
                    let (u, v) = (f64::from(u) / f64::from(steps), f64::from(v) / f64::from(steps));
                    least = least.min((a + (b - a) * u + (c - a) * v).abs().max_element());
                }
            }
            if least <= 1.0 {
                assert!(overlap([a, b, c], 1.0));
                met += 1;
            } else if least > 1.2 {
                assert!(!overlap([a, b, c], 1.0));
                missed += 1;
            }
        }
        assert!(met > 200 && missed > 200, "{met} {missed}");
    }
}
