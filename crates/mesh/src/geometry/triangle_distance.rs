//! The distance of a point from a triangle.

use glam::DVec3;

/// The point of a triangle that is nearest to `point`.
pub(crate) fn nearest_on_triangle(point: DVec3, [a, b, c]: [DVec3; 3]) -> DVec3 {
    let normal = (b - a).cross(c - a);
    let is_over = |from: DVec3, to: DVec3| normal.cross(to - from).dot(point - from) >= 0.0;
    if normal != DVec3::ZERO && is_over(a, b) && is_over(b, c) && is_over(c, a) {
        let normal = normal.normalize();
        return point - normal * normal.dot(point - a);
    }
    let on_edges = [[a, b], [b, c], [c, a]].map(|[from, to]| {
        let along = to - from;
        let share = (along.dot(point - from) / along.length_squared()).clamp(0.0, 1.0);
        from + along * if share.is_finite() { share } else { 0.0 }
    });
    let [first, others @ ..] = on_edges;
    others.into_iter().fold(first, |nearest, other| {
        match other.distance_squared(point) < nearest.distance_squared(point) {
            true => other,
            false => nearest,
        }
    })
}

/// The distance of a point from a triangle.
pub(crate) fn distance_to_triangle(point: DVec3, corners: [DVec3; 3]) -> f64 {
    point.distance(nearest_on_triangle(point, corners))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_distance_from_a_triangle_is_the_least_of_those_from_its_points() {
        let corners = [DVec3::ZERO, DVec3::X, DVec3::new(0.2, 0.7, 0.1)];
        let points = (0..=60).flat_map(|i| (0..=60 - i).map(move |j| (f64::from(i) / 60.0, f64::from(j) / 60.0)));
        let points: Vec<DVec3> = points
            .map(|(s, t)| corners[0] + (corners[1] - corners[0]) * s + (corners[2] - corners[0]) * t)
            .collect();
        for point in [
            [0.3, 0.2, 0.5],
            [-0.4, -0.2, 0.1],
            [0.9, 0.6, -0.3],
            [0.2, 1.4, 0.0],
            [0.5, -0.7, 0.2],
        ] {
            let point = DVec3::from_array(point);
            let sampled = points.iter().map(|p| p.distance(point)).fold(f64::INFINITY, f64::min);
            let distance = distance_to_triangle(point, corners);
            assert!(
                distance <= sampled + 1e-12 && sampled < distance + 0.02,
                "{distance} {sampled}"
            );
        }
    }
}
