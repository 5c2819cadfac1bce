//! Solids as signed distance functions (negative inside), and operations to combine them.
//!
//! Some distances are only bounds, where exactness is not worth its cost (ellipsoids): extraction needs only the sign
//! and a slope near one.

use super::noise;
use super::vector::{Vec3, v};

/// A closed shape, given by its signed distance and its colour.
pub trait Solid: Sync {
    /// Approximate signed distance to the surface at `p`, negative inside, with a slope near one.
    fn distance(&self, p: Vec3) -> f64;
    /// A bounding box of the surface.
    fn bounds(&self) -> (Vec3, Vec3);
    /// Linear colour of the surface at `p`, in [0, 1].
    fn colour(&self, p: Vec3, normal: Vec3) -> Vec3;
    /// Simulated scanner noise along the normal of a vertex, from -1 to 1.
    fn scanner_noise(&self, vertex: usize, p: Vec3) -> f64 {
        let _ = p;
        noise::white(vertex as u64, 7)
    }
}

/// Distance to a sphere.
pub fn sphere(p: Vec3, centre: Vec3, radius: f64) -> f64 {
    (p - centre).length() - radius
}

/// Approximate distance to an ellipsoid with semi-axes `radii` along x, y and z.
pub fn ellipsoid(p: Vec3, centre: Vec3, radii: Vec3) -> f64 {
    let q = p - centre;
    let near = q.over(radii).length();
    let slope = q.over(radii).over(radii).length();
    if slope > 0.0 {
        near * (near - 1.0) / slope
    } else {
        -radii.x.min(radii.y).min(radii.z)
    }
}

/// Distance to a round cone: two spheres and the cone tangent to both.
pub fn round_cone(p: Vec3, a: Vec3, radius_a: f64, b: Vec3, radius_b: f64) -> f64 {
    let axis = b - a;
    let length = axis.length();
    let along_axis = axis * (1.0 / length);
    let q = p - a;
    let y = q.dot(along_axis);
    let x = (q - along_axis * y).length();
    let sine = (radius_a - radius_b) / length;
    let cosine = (1.0 - sine * sine).max(0.0).sqrt();
    let along = y * cosine - x * sine;
    if along < 0.0 {
        q.length() - radius_a
    } else if along > length * cosine {
        (p - b).length() - radius_b
    } else {
        x * cosine + y * sine - radius_a
    }
}

/// Distance to a chain of round cones through `knots` of centre and radius.
pub fn chain(p: Vec3, knots: &[(Vec3, f64)]) -> f64 {
    knots
        .windows(2)
        .map(|k| round_cone(p, k[0].0, k[0].1, k[1].0, k[1].1))
        .fold(f64::INFINITY, f64::min)
}

/// Smooth union, blended over a width of about `width`.
pub fn smooth_union(a: f64, b: f64, width: f64) -> f64 {
    let overlap = (width - (a - b).abs()).max(0.0) / width;
    a.min(b) - overlap * overlap * width * 0.25
}

/// Smooth difference of `a` and `b`, blended over a width of about `width`.
pub fn smooth_difference(a: f64, b: f64, width: f64) -> f64 {
    -smooth_union(-a, b, width)
}

/// Smooth step from 0 at `from` to 1 at `to`; `from` may be larger than `to`.
pub fn step(from: f64, to: f64, x: f64) -> f64 {
    let t = ((x - from) / (to - from)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

/// Linear interpolation from colour `a` to colour `b`.
pub fn mix(a: Vec3, b: Vec3, t: f64) -> Vec3 {
    a.lerp(b, t.clamp(0.0, 1.0))
}

/// A linear colour from sRGB in hexadecimal; glTF stores linear vertex colours.
///
/// A cubic approximates the sRGB curve within 0.003, because `powf` differs between machines.
pub fn srgb(hex: u32) -> Vec3 {
    let linear = |c: u32| {
        let s = f64::from(c & 0xff) / 255.0;
        s * (s * (s * 0.305306011 + 0.682171111) + 0.012522878)
    };
    v(linear(hex >> 16), linear(hex >> 8), linear(hex))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_round_cone_holds_both_spheres_and_has_slope_one() {
        let (a, b) = (v(0.0, 0.0, 0.0), v(1.0, 2.0, 0.5));
        for i in 0..500_i32 {
            let t = f64::from(i);
            let p = v((t * 0.37) % 4.0 - 2.0, (t * 0.73) % 5.0 - 1.0, (t * 0.11) % 3.0 - 1.5);
            let d = round_cone(p, a, 0.5, b, 0.2);
            assert!(d <= sphere(p, a, 0.5) + 1e-12 && d <= sphere(p, b, 0.2) + 1e-12);
            let q = p + v(1e-3, -2e-3, 1e-3);
            assert!((round_cone(q, a, 0.5, b, 0.2) - d).abs() <= (q - p).length() * (1.0 + 1e-9));
        }
    }

    #[test]
    fn a_smooth_union_contains_both_and_equals_them_far_apart() {
        assert_eq!(smooth_union(0.1, 0.9, 0.5), 0.1);
        assert!(smooth_union(0.1, 0.2, 0.5) < 0.1);
        assert!(smooth_difference(-0.5, -0.1, 0.2) >= 0.1);
    }
}
