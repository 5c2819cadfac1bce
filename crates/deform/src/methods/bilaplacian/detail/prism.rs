//! A prism between a triangle of the base and that of the surface: its volume and the volume's gradient.
//!
//! Over a triangle with corners b the displacements o vary linearly, and the triangle with corners b + s o has the area
//! vector A(s), s going from 0 to 1. So with m, the mean of o, the volume is m · ∫ A ds: positive where the surface is
//! on the side of the base's normal.

use glam::DVec3;

/// The signed volume of the prism from the base's corners to the surface's.
#[inline]
pub(crate) fn volume(base: [DVec3; 3], top: [DVec3; 3]) -> f64 {
    let edges = Edges::of(base, top);
    edges.mean.dot(edges.mean_area())
}

/// The derivative of the volume by each of the surface's corners.
#[inline]
pub(crate) fn gradient(base: [DVec3; 3], top: [DVec3; 3]) -> [DVec3; 3] {
    let edges = Edges::of(base, top);
    let Edges {
        bottom: [u, v],
        top: [p, q],
        mean,
    } = edges;
    let share = edges.mean_area() / 3.0;
    let by_p = q.cross(mean) / 6.0 + v.cross(mean) / 12.0;
    let by_q = mean.cross(p) / 6.0 + mean.cross(u) / 12.0;
    [share - by_p - by_q, share + by_p, share + by_q]
}

/// Two edges of each triangle, and m.
struct Edges {
    bottom: [DVec3; 2],
    top: [DVec3; 2],
    mean: DVec3,
}

impl Edges {
    #[inline]
    fn of([a, b, c]: [DVec3; 3], [p, q, r]: [DVec3; 3]) -> Self {
        Self {
            bottom: [b - a, c - a],
            top: [q - p, r - p],
            mean: ((p - a) + (q - b) + (r - c)) / 3.0,
        }
    }

    /// ∫ A ds.
    #[inline]
    fn mean_area(&self) -> DVec3 {
        let ([u, v], [p, q]) = (self.bottom, self.top);
        (u.cross(v) + p.cross(q)) / 6.0 + (u.cross(q) + p.cross(v)) / 12.0
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::{gradient, volume};

    /// The volume under the linear motion from base to top, by the divergence theorem: the six tetrahedra of the two
    /// triangulations of each side, on average.
    fn by_tetrahedra(base: [DVec3; 3], top: [DVec3; 3]) -> f64 {
        let cone = |a: DVec3, b: DVec3, c: DVec3| a.dot(b.cross(c)) / 6.0;
        let mut sum = cone(top[0], top[1], top[2]) - cone(base[0], base[1], base[2]);
        for k in 0..3 {
            let (a, b, p, q) = (base[k], base[(k + 1) % 3], top[k], top[(k + 1) % 3]);
            sum += 0.5 * (cone(a, b, q) + cone(a, q, p) + cone(a, b, p) + cone(b, q, p));
        }
        sum
    }

    #[test]
    fn the_volume_is_that_of_its_tetrahedra_and_the_gradient_its_derivative() {
        let at = |k: i32| {
            let of = |n: i32| f64::from((k * 37 + n * 101) % 89) / 89.0 - 0.4;
            DVec3::new(of(1), of(5), of(11))
        };
        for seed in 0..20 {
            let corner = |k: i32| at(7 * seed + k);
            let base = [corner(0), corner(1), corner(2)];
            let top = [corner(3), corner(4), corner(5)];
            let expected = by_tetrahedra(base, top);
            assert!(
                (volume(base, top) - expected).abs() < 1e-12,
                "{} {expected}",
                volume(base, top)
            );
            for (k, own) in gradient(base, top).into_iter().enumerate() {
                for axis in DVec3::AXES {
                    let moved = |by: f64| {
                        let mut top = top;
                        top[k] += axis * by;
                        volume(base, top)
                    };
                    let slope = (moved(1e-4) - moved(-1e-4)) / 2e-4;
                    assert!((own.dot(axis) - slope).abs() < 1e-9, "{own} {slope}");
                }
            }
        }
    }
}
