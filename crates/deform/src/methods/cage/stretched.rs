//! The moving faces of a cage for Green coordinates: each face's normal n times its stretch s, and the derivatives of
//! this vector by the face's corners.
//!
//! With a face's edges u, v at rest and u', v' after the motion [LLC08, equation 9],
//!
//! s = √(|u'|² |v|² − 2 (u'·v') (u·v) + |v'|² |u|²) / (√2 |u × v|) and n = (u' × v') / |u' × v'|.
//!
//! Its derivative is d(s n) = n ds + s dn, with dn = (I − n nᵀ) (du' × v' + u' × dv') / |u' × v'|.

use glam::{DMat3, DVec3};

use crate::space::hand_field::outer;

/// A moved face of less than this share of its area at rest hardly has a normal: there the derivative is that of a face
/// of this area.
const COLLAPSED: f64 = 1e-3;

/// A face at rest.
#[derive(Clone, Copy, Debug)]
pub(super) struct RestFace {
    corners: [u32; 3],
    edges: [DVec3; 2],
    /// Twice its area.
    area: f64,
}

/// s n of a moved face, and its derivatives by the two edges from the first corner.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Slopes([DMat3; 2]);

impl RestFace {
    /// The face of these corners of these vertices.
    pub fn of(corners: [u32; 3], vertices: &[DVec3]) -> Self {
        let edges = edges(corners, vertices);
        Self {
            corners,
            edges,
            area: edges[0].cross(edges[1]).length().max(f64::MIN_POSITIVE),
        }
    }

    /// s n after the vertices moved.
    pub fn stretched_normal(&self, moved: &[DVec3]) -> DVec3 {
        let [u, v] = edges(self.corners, moved);
        u.cross(v).normalize_or_zero() * self.stretch([u, v])
    }

    /// The derivatives of s n after the vertices moved.
    pub fn slopes(&self, moved: &[DVec3]) -> Slopes {
        let [u, v] = edges(self.corners, moved);
        let stretch = self.stretch([u, v]);
        let across = u.cross(v);
        let normal = across.normalize_or_zero();
        let turned = (DMat3::IDENTITY - outer(normal, normal)) * (stretch / across.length().max(COLLAPSED * self.area));
        let [of_u, of_v] = self.stretching([u, v]);
        Slopes([
            outer(normal, of_u) - turned * cross_by(v),
            outer(normal, of_v) + turned * cross_by(u),
        ])
    }

    /// The change of its angles, and its derivatives by the corners: q − 1/q with q = s / √J, where J is the growth of
    /// its area. It is zero if the face is only turned and scaled, and grows without bound as the face collapses.
    pub fn shear(&self, moved: &[DVec3]) -> (f64, [DVec3; 3]) {
        let [u, v] = edges(self.corners, moved);
        let across = u.cross(v);
        let normal = across.normalize_or_zero();
        let area = across.length().max(COLLAPSED * COLLAPSED * self.area);
        let stretch = self.stretch([u, v]).max(COLLAPSED);
        let q = (stretch / (area / self.area).sqrt()).max(1.0);
        // The derivative of log q.
        let [of_u, of_v] = self.stretching([u, v]).map(|own| own / stretch);
        let of_u = of_u - v.cross(normal) * (0.5 / area);
        let of_v = of_v - normal.cross(u) * (0.5 / area);
        let [of_u, of_v] = [of_u, of_v].map(|own| own * (q + q.recip()));
        (q - q.recip(), [-(of_u + of_v), of_u, of_v])
    }

    /// Twice its area at rest.
    pub fn area(&self) -> f64 {
        self.area
    }

    /// The derivatives of s by the edges.
    fn stretching(&self, [u, v]: [DVec3; 2]) -> [DVec3; 2] {
        let [u_rest, v_rest] = self.edges;
        let factor = 1.0 / (2.0 * self.area * self.area * self.stretch([u, v]).max(COLLAPSED));
        let mixed = u_rest.dot(v_rest);
        [
            (u * v_rest.length_squared() - v * mixed) * factor,
            (v * u_rest.length_squared() - u * mixed) * factor,
        ]
    }

    /// s.
    fn stretch(&self, [u, v]: [DVec3; 2]) -> f64 {
        let [u_rest, v_rest] = self.edges;
        let square = u.length_squared() * v_rest.length_squared() - 2.0 * u.dot(v) * u_rest.dot(v_rest)
            + v.length_squared() * u_rest.length_squared();
        (square.max(0.0) / 2.0).sqrt() / self.area
    }
}

impl Slopes {
    /// The derivatives by each of the face's corners.
    pub fn by_corners(&self) -> [DMat3; 3] {
        let [u, v] = self.0;
        [-(u + v), u, v]
    }
}

/// The edges from the first corner.
fn edges([a, b, c]: [u32; 3], vertices: &[DVec3]) -> [DVec3; 2] {
    let [a, b, c] = [a, b, c].map(|vertex| vertices[vertex as usize]);
    [b - a, c - a]
}

/// The matrix of x ↦ a × x.
fn cross_by(a: DVec3) -> DMat3 {
    DMat3::from_cols(a.cross(DVec3::X), a.cross(DVec3::Y), a.cross(DVec3::Z))
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::RestFace;

    #[test]
    fn slopes_are_the_derivatives_of_the_stretched_normal() {
        let rest = [[0.1, 0.2, 0.3], [1.4, 0.1, -0.2], [0.3, 1.1, 0.6]].map(DVec3::from_array);
        let moves = [
            [[0.0; 3]; 3],
            [[0.3, 0.1, -0.2], [0.1, -0.4, 0.9], [-0.7, 0.2, 0.3]],
            [[0.0, 2.0, 0.0], [-1.3, 0.4, 0.8], [0.9, 0.7, -0.8]],
        ];
        let step = 1e-6;
        for moves in moves {
            let face = RestFace::of([0, 1, 2], &rest);
            let moved: [DVec3; 3] = std::array::from_fn(|corner| rest[corner] + DVec3::from_array(moves[corner]));
            let slopes = face.slopes(&moved).by_corners();
            let (_, shear) = face.shear(&moved);
            for (corner, slope) in slopes.iter().enumerate() {
                for axis in 0..3 {
                    let at = |sign: f64| {
                        let mut moved = moved;
                        moved[corner][axis] += sign * step;
                        face.stretched_normal(&moved)
                    };
                    let difference = (at(1.0) - at(-1.0)) / (2.0 * step);
                    let error = slope.col(axis).distance(difference);
                    assert!(error < 1e-8, "{corner} {axis}: {error:e}");
                    let at = |sign: f64| {
                        let mut moved = moved;
                        moved[corner][axis] += sign * step;
                        face.shear(&moved).0
                    };
                    let difference = (at(1.0) - at(-1.0)) / (2.0 * step);
                    let error = (shear[corner][axis] - difference).abs();
                    assert!(error < 1e-6 * (1.0 + difference.abs()), "{corner} {axis}: {error:e}");
                }
            }
        }
    }
}
