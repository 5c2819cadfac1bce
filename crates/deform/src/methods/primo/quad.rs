//! The quad that two prisms share, and the integral over it.
//!
//! A prism is its triangle extruded by half the thickness along and against the vertex normals. Over the edge from a to
//! b its side is the bilinear patch
//!
//! f(s, t) = m + s e + t g + s t h,   s, t ∈ [−½, ½],
//!
//! with the edge's middle m, e = b − a, and with the two normals n_a, n_b and the thickness H the mean extrusion
//! g = ½ H (n_a + n_b) and the twist h = H (n_b − n_a). Neighbours share the patch at rest, so that under their motions
//! T_i, T_j it comes apart by an affine function of f, and the integral is exact with two moments of f (Botsch et al.
//! 2006, equation 2, in closed form):
//!
//! ∫∫ |T_i f − T_j f|² = |T_i m − T_j m|² + tr(D C Dᵀ),   D = R_i − R_j,   C = (e eᵀ + g gᵀ) / 12 + h hᵀ / 144.

use glam::{DMat3, DVec3};

/// The first two moments of a patch of area 1 in its parameters.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(crate) struct Quad {
    /// m, the mean of f.
    pub middle: DVec3,
    /// C, the mean of (f − m)(f − m)ᵀ.
    pub spread: DMat3,
}

/// An extrusion whose angle to its edge has a sine below this spans no patch.
const UPRIGHT: f64 = 0.1;

impl Quad {
    /// The patch over the edge from `a` to `b`, extruded along the unit `normals` there, by `thickness` in all.
    /// `face_normal` replaces them if they vanish, cancel or are parallel to the edge; it need not be a unit vector,
    /// and may be zero.
    pub fn over(a: DVec3, b: DVec3, normals: [DVec3; 2], face_normal: DVec3, thickness: f64) -> Self {
        let edge = b - a;
        let [first, second] = upright(edge, normals, face_normal);
        let extrusion = 0.5 * thickness * (first + second);
        let twist = thickness * (second - first);
        Self {
            middle: a + 0.5 * edge,
            spread: (square(edge) + square(extrusion)) * (1.0 / 12.0) + square(twist) * (1.0 / 144.0),
        }
    }

    /// A small ball about `point` with the moments of a cube of width `thickness`.
    pub fn around(point: DVec3, thickness: f64) -> Self {
        Self {
            middle: point,
            spread: DMat3::from_diagonal(DVec3::splat(thickness * thickness / 12.0)),
        }
    }
}

/// v vᵀ.
fn square(v: DVec3) -> DMat3 {
    DMat3::from_cols(v * v.x, v * v.y, v * v.z)
}

/// Unit directions that span a patch with the edge, on one side of the surface.
fn upright(edge: DVec3, [first, second]: [DVec3; 2], face_normal: DVec3) -> [DVec3; 2] {
    // Where triangles disagree about outside, normals may too.
    let second = if first.dot(second) < 0.0 { -second } else { second };
    let along = edge.normalize_or_zero();
    let stands = |n: DVec3| n.cross(along).length() > UPRIGHT || (along == DVec3::ZERO && n != DVec3::ZERO);
    match (stands(first), stands(second)) {
        (true, true) => return [first, second],
        (true, false) => return [first; 2],
        (false, true) => return [second; 2],
        (false, false) => {}
    }
    let face = face_normal.normalize_or_zero();
    if stands(face) {
        return [face; 2];
    }
    // For a needle without area any direction is correct.
    [along
        .try_normalize()
        .map_or(DVec3::Z, |along| along.any_orthonormal_vector()); 2]
}

#[cfg(test)]
mod tests {
    use glam::{DAffine3, DMat3, DQuat, DVec3};

    use super::Quad;

    /// Gauss's rule of three points, exact to the fifth degree; this integrand has the fourth.
    const GAUSS: [(f64, f64); 3] = [
        (-0.387_298_334_620_741_7, 5.0 / 18.0),
        (0.0, 8.0 / 18.0),
        (0.387_298_334_620_741_7, 5.0 / 18.0),
    ];

    #[test]
    fn the_closed_form_is_the_integral_over_the_bilinear_patch() {
        let (a, b) = (DVec3::new(0.3, -0.2, 1.0), DVec3::new(1.1, 0.4, 0.7));
        let (na, nb) = (
            DVec3::new(0.1, 0.2, 1.0).normalize(),
            DVec3::new(-0.5, 0.3, 1.0).normalize(),
        );
        let height = 0.8;
        let quad = Quad::over(a, b, [na, nb], DVec3::Z, height);
        let motion = |angle: f64, shift: DVec3| {
            let axis = DVec3::new(0.48, 0.6, 0.64);
            DAffine3::from_mat3_translation(DMat3::from_quat(DQuat::from_axis_angle(axis, angle)), shift)
        };
        let stretched = DAffine3::from_mat3_translation(DMat3::from_diagonal(DVec3::new(2.0, -0.3, 0.0)), DVec3::X);
        for (one, other) in [
            (motion(0.0, DVec3::ZERO), motion(1.0, DVec3::X)),
            (motion(3.0, DVec3::Y), motion(-1.0, DVec3::Z)),
            (motion(0.4, DVec3::Y), stretched),
        ] {
            let corner = |p: DVec3, n: DVec3, side: f64| {
                let f = p + n * (0.5 * height * side);
                one.transform_point3(f) - other.transform_point3(f)
            };
            let corners = [
                [corner(a, na, -1.0), corner(a, na, 1.0)],
                [corner(b, nb, -1.0), corner(b, nb, 1.0)],
            ];
            let mut integral = 0.0;
            for (s, ws) in GAUSS {
                for (t, wt) in GAUSS {
                    let across = |ends: [DVec3; 2]| ends[0] * (0.5 - t) + ends[1] * (0.5 + t);
                    let gap = across(corners[0]) * (0.5 - s) + across(corners[1]) * (0.5 + s);
                    integral += ws * wt * gap.length_squared();
                }
            }
            let d = one.matrix3 - other.matrix3;
            let gap = one.transform_point3(quad.middle) - other.transform_point3(quad.middle);
            let g = d * quad.spread;
            let closed = gap.length_squared() + (0..3).map(|k| g.col(k).dot(d.col(k))).sum::<f64>();
            assert!((closed - integral).abs() < 1e-12 * integral, "{closed} {integral}");
        }
    }

    #[test]
    fn a_patch_is_spanned_whatever_the_normals_are() {
        let (a, b) = (DVec3::ZERO, DVec3::X);
        for normals in [
            [DVec3::ZERO; 2],
            [DVec3::Z, DVec3::ZERO],
            [DVec3::ZERO, DVec3::Y],
            [DVec3::Z, DVec3::NEG_Z],
            [DVec3::X, DVec3::X],
        ] {
            for face in [DVec3::ZERO, DVec3::Y, DVec3::X] {
                let spread = Quad::over(a, b, normals, face, 0.1).spread;
                let across = spread.y_axis.y + spread.z_axis.z;
                assert!(across > 0.5 * 0.01 / 12.0 && spread.is_finite(), "{normals:?} {face}");
            }
        }
    }
}
