//! The second derivatives of the elements, which the Hessian adds to JᵀJ, as a positive and a negative part.
//!
//! The Hessian of ½ w r² is w (∇r ∇rᵀ + r ∇²r). JᵀJ omits the second part, which decides where triangles are compressed
//! and hinges are far from their angle: with JᵀJ alone bent limbs of scans took hundreds of steps. It is indefinite.
//! Each element splits it into a difference of two positive matrices in closed form, so that a step can omit as much of
//! the negative one as it must (`system`).
//!
//! - An edge of length l and unit vector g: ∇²l = (I − g gᵀ) / l, positive where the edge is stretched.
//! - A triangle of area A and normal n: along n, ∇²A is the cotangent Laplacian, (∇ᵢA · ∇ⱼA) / A, positive under
//!   tension. Within the plane it is ½ S ⊗ J with the quarter turn J about n and the skew matrix S of the corners'
//!   order. (S ⊗ J)² = 3 (I − 1 1ᵀ / 3) ⊗ (I − n nᵀ), and so |S ⊗ J| is √3 times that projection.
//! - A hinge: ∇²θ is a sum of x yᵀ + y xᵀ = ½ |x| |y| (v₊ v₊ᵀ − v₋ v₋ᵀ) over pairs of orthogonal vectors, with
//!   v± = x / |x| ± y / |y|.
//!
//! The pairs of a hinge: a triangle at the edge of direction e and length l has the height h in the direction m, the
//! normal n, and the foot of the height at the share s of the edge. With w = (s − 1, −s, 1) and d = (−1, 1, 0) at the
//! edge's ends and the corner across it, it adds w⊗n with w⊗m / h², and d⊗n with w⊗e / (h l) + d⊗m / (2 l²).

use std::f64::consts::SQRT_2;

use glam::{DMat3, DVec3};
use pliant_mesh::face_normal;

/// √3.
const ROOT_3: f64 = 1.732_050_807_568_877_2;

/// A block of the positive and of the negative part.
pub(super) type Parts = [DMat3; 2];

/// The zero block of both parts.
pub(super) const NONE: Parts = [DMat3::ZERO; 2];

/// a bᵀ.
pub(super) fn outer(a: DVec3, b: DVec3) -> DMat3 {
    DMat3::from_cols(a * b.x, a * b.y, a * b.z)
}

/// Splits the product of a number and a positive matrix: the number's sign chooses the part.
fn signed(number: f64, matrix: DMat3) -> Parts {
    [matrix * number.max(0.0), matrix * (-number).max(0.0)]
}

/// The block of an edge's end with itself; the block with the other end has the opposite sign. `along` is its unit
/// vector, `pull` the derivative of its energy by its length.
pub(super) fn of_edge(along: DVec3, length: f64, pull: f64) -> Parts {
    if length > 0.0 {
        signed(pull / length, DMat3::IDENTITY - outer(along, along))
    } else {
        NONE
    }
}

/// A triangle's second derivative.
#[derive(Clone, Copy, Debug)]
pub(super) struct FaceCurvature {
    normal: DVec3,
    area: f64,
    pull: f64,
}

impl FaceCurvature {
    /// The derivative of a triangle of this area, with `pull` the derivative of its energy by the area.
    pub fn of(corners: [DVec3; 3], area: f64, pull: f64) -> Self {
        Self {
            normal: face_normal(corners),
            area,
            pull,
        }
    }

    /// The block of two corners, whose gradients of the area are given.
    pub fn block(&self, [row, column]: [usize; 2], [of_row, of_column]: [DVec3; 2]) -> Parts {
        let Self { normal, area, pull } = *self;
        let across = outer(normal, normal);
        let centred = if row == column { 2.0 / 3.0 } else { -1.0 / 3.0 };
        let size = (DMat3::IDENTITY - across) * (0.25 * ROOT_3 * pull.abs() * centred);
        let order = [0.0, 1.0, -1.0][(column + 3 - row) % 3];
        let turn = quarter_turn(normal) * (0.25 * pull * order);
        let [mut positive, mut negative] = [size + turn, size - turn];
        if area > 0.0 {
            let tension = across * (pull * of_row.dot(of_column) / area);
            if pull > 0.0 {
                positive += tension;
            } else {
                negative -= tension;
            }
        }
        [positive, negative]
    }
}

/// x ↦ x × n.
fn quarter_turn(n: DVec3) -> DMat3 {
    DMat3::from_cols(DVec3::X.cross(n), DVec3::Y.cross(n), DVec3::Z.cross(n))
}

/// A hinge's second derivative in one of its triangles: the vectors v of v vᵀ at the edge's ends and the corner across
/// it.
#[derive(Clone, Copy, Default, Debug)]
pub(super) struct Wing {
    positive: [[DVec3; 3]; 2],
    negative: [[DVec3; 3]; 2],
}

impl Wing {
    /// The derivatives in both triangles of a hinge with these corners, with `moment` the derivative of its energy by
    /// the angle. A triangle without an area has a zero derivative.
    pub fn both([a, b, c, d]: [DVec3; 4], moment: f64) -> [Self; 2] {
        [Self::of([a, b, c], 1.0, moment), Self::of([a, b, d], -1.0, moment)]
    }

    fn of([a, b, corner]: [DVec3; 3], side: f64, moment: f64) -> Self {
        let length = a.distance(b);
        let along = (b - a) / length;
        let foot = (corner - a).dot(along);
        let rise = corner - a - along * foot;
        let height = rise.length();
        let (m, s) = (rise / height, foot / length);
        let n = along.cross(m) * side;
        let (w, d) = ([s - 1.0, -s, 1.0], [-1.0, 1.0, 0.0]);
        // |w⊗n| = |w⊗m|, and |d| = √2.
        let own = (0.5 * moment.abs()).sqrt() / height;
        let other: [DVec3; 3] =
            std::array::from_fn(|k| along * (w[k] / (height * length)) + m * (0.5 * d[k] / (length * length)));
        let size = other.iter().map(|v| v.length_squared()).sum::<f64>().sqrt();
        let joint = (0.5 * moment.abs() * SQRT_2 * size).sqrt();
        let vectors = |sign: f64| {
            let first = w.map(|w| (n + m * sign) * (w * own));
            let second = std::array::from_fn(|k| (n * (d[k] / SQRT_2) + other[k] * (sign / size)) * joint);
            [first, second]
        };
        let turn = 1_f64.copysign(moment);
        let found = Self {
            positive: vectors(turn),
            negative: vectors(-turn),
        };
        let all = found.positive.iter().chain(&found.negative).flatten();
        let is_finite = all.clone().all(|v| v.is_finite());
        if is_finite { found } else { Self::default() }
    }

    /// The block of two of its three corners.
    pub fn block(&self, row: usize, column: usize) -> Parts {
        [&self.positive, &self.negative].map(|own| {
            let [first, second] = own.map(|v| outer(v[row], v[column]));
            first + second
        })
    }
}

#[cfg(test)]
mod tests {
    use glam::{DMat3, DVec3};
    use pliant_mesh::face_area;

    use super::super::{face, hinge};
    use super::{FaceCurvature, NONE, Parts, Wing, of_edge};

    const CORNERS: [DVec3; 4] = [
        DVec3::new(0.1, -0.2, 0.3),
        DVec3::new(2.0, 0.3, -0.1),
        DVec3::new(0.7, -1.1, 0.4),
        DVec3::new(0.9, 1.3, 0.6),
    ];

    /// The second derivative of `of` by two corners, from differences of its gradient.
    fn differences<const N: usize>(
        corners: [DVec3; N],
        [row, column]: [usize; 2],
        gradient: impl Fn([DVec3; N]) -> [DVec3; N],
    ) -> DMat3 {
        let step = 1e-5;
        let along = |axis: DVec3| {
            let at = |step: f64| {
                let mut moved = corners;
                moved[column] += axis * step;
                gradient(moved)[row]
            };
            (at(step) - at(-step)) / (2.0 * step)
        };
        DMat3::from_cols(along(DVec3::X), along(DVec3::Y), along(DVec3::Z))
    }

    fn assert_is(found: Parts, pull: f64, wanted: DMat3) {
        assert!(
            (found[0] - found[1]).abs_diff_eq(wanted * pull, 1e-8),
            "{found:?} {wanted}"
        );
    }

    /// True if the quadratic form with these blocks is positive for all of many vectors.
    fn are_positive(count: usize, part: usize, block: impl Fn(usize, usize) -> Parts) -> bool {
        (0..200).all(|number| {
            let noise = |k: usize| ((number * 97 + k) as f64 * 12.9898).sin();
            let vector = |k: usize| DVec3::new(noise(3 * k), noise(3 * k + 1), noise(3 * k + 2));
            let pairs = (0..count).flat_map(|row| (0..count).map(move |column| (row, column)));
            let sum: f64 = pairs
                .map(|(row, column)| vector(row).dot(block(row, column)[part] * vector(column)))
                .sum();
            sum > -1e-10
        })
    }

    #[test]
    fn the_parts_differ_by_the_second_derivative_and_are_positive() {
        let [a, b, c, _] = CORNERS;
        for pull in [0.7, -0.4] {
            let along = (b - a).normalize();
            let of_length = |[a, b]: [DVec3; 2]| [(a - b).normalize(), (b - a).normalize()];
            assert_is(
                of_edge(along, a.distance(b), pull),
                pull,
                differences([a, b], [0, 0], of_length),
            );

            let triangle = [a, b, c];
            let of_area = FaceCurvature::of(triangle, face_area(triangle), pull);
            let slopes = face::gradient(triangle);
            let face_block = |row: usize, column: usize| of_area.block([row, column], [slopes[row], slopes[column]]);
            let wings = Wing::both(CORNERS, pull);
            let hinge_block = |row: usize, column: usize| {
                let mut sum = NONE;
                for (wing, own) in wings.iter().zip([[0, 1, 2], [0, 1, 3]]) {
                    let place = |corner: usize| own.iter().position(|&k| k == corner);
                    if let (Some(row), Some(column)) = (place(row), place(column)) {
                        let [positive, negative] = wing.block(row, column);
                        sum = [sum[0] + positive, sum[1] + negative];
                    }
                }
                sum
            };
            for (row, column) in (0..4).flat_map(|row| (0..4).map(move |column| (row, column))) {
                let wanted = differences(CORNERS, [row, column], hinge::gradient);
                assert_is(hinge_block(row, column), pull, wanted);
                if row < 3 && column < 3 {
                    assert_is(
                        face_block(row, column),
                        pull,
                        differences(triangle, [row, column], face::gradient),
                    );
                }
            }
            for part in [0, 1] {
                assert!(are_positive(3, part, face_block) && are_positive(4, part, hinge_block));
            }
        }
    }
}
