//! The smooth energy's barrier against a limb that is pinched where it is twisted.
//!
//! A membrane whose rotations are free resists a shear the less, the narrower it is. So a limb that is twisted by half a
//! turn would narrow where it is thinnest, to a point in the end, and put all of the turn there. Each cell therefore
//! also pays
//!
//! ψ = μ A φ(x) h(σ²), φ(x) = (x̂ − x)³ / (x + ε) for x < x̂, otherwise 0, h(σ²) = y² / (y² + k), y = max(σ² − 1, 0),
//!
//! x being its area over its rest area, and σ its largest stretch. A limb's inner side in a bend loses area as well, but
//! is stretched in no direction, and pays nothing: without h it would buckle.
//!
//! With the two largest eigenvalues λ of the rest matrix S⁰ and their eigenvectors u and v, which span the cell, its mean
//! gradient takes u to a = S p, with p = u / λ_u, and v to b = S q. So x = |a × b|, and σ² is the larger eigenvalue of
//! the matrix of a and b's products: ½ (t + √(t² − 4 x²)), with t = |a|² + |b|². S may be multiplied from the right by a
//! matrix that commutes with S⁰, as the one is to which a bending cell's rotation is fitted.
//!
//! The table of `bench/measurements.md` has the choice of the constants.

use pulp::Simd;

use crate::numerical::lane_fits::Fits;
use crate::numerical::lanes::{LANES, Lanes, Vector};

/// μ.
pub(super) const STRENGTH: f64 = 20.0;

/// x̂: the share of its area below which a cell may pay.
const RESISTS: f64 = 0.9;

/// ε: the energy stays finite where targets leave a cell no area.
const LEAST: f64 = 0.02;

/// k: the square of the y at which half of φ counts.
const STRETCHED: f64 = 0.3;

/// Added to t² − 4 x², whose root has no derivative at 0.
const ROUND: f64 = 1e-6;

/// Added to x where it divides a × b, which is 0 then.
const TINY: f64 = 1e-30;

/// A cell's p and q, and μ A, A being its area times its stiffness. **f32**: they define the energy, which is computed
/// in f64.
pub(crate) type Facing = [f32; 7];

/// Eight cells' barriers.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Barriers {
    pub facing: [Lanes; 7],
    /// ψ.
    pub energy: Lanes,
}

impl Barriers {
    /// Finds the cells' energies, and takes dψ/dS from their turns.
    #[inline(always)]
    pub fn resist<S: Simd>(&mut self, simd: S, fits: &mut Fits) {
        for place in 0..LANES / S::F64_LANES {
            let [p0, p1, p2, q0, q1, q2, weight] = Vector::each(simd, &self.facing, place);
            let s = fits.matrices(simd, place);
            let (mut a, mut b) = ([weight; 3], [weight; 3]);
            for k in 0..3 {
                a[k] = s[0][k] * p0 + s[1][k] * p1 + s[2][k] * p2;
                b[k] = s[0][k] * q0 + s[1][k] * q1 + s[2][k] * q2;
            }
            let across = cross(a, b);
            let area = dot(across, across).sqrt();
            let zero = Vector::splat(simd, 0.0);
            if (!area.less(Vector::splat(simd, RESISTS))).is_full() {
                zero.put(&mut self.energy, place);
                continue;
            }
            let Slopes {
                energy,
                by_area,
                by_square,
            } = Slopes::of(simd, area, dot(a, a) + dot(b, b));
            (weight * energy).put(&mut self.energy, place);
            let push = weight * by_area / (area + Vector::splat(simd, TINY));
            let pull = weight * (by_square + by_square);
            let (by_a, by_b) = (cross(b, across), cross(across, a));
            for (column, (p, q)) in [(p0, q0), (p1, q1), (p2, q2)].into_iter().enumerate() {
                let mut turn = Vector::each(simd, &fits.turn[column], place);
                for k in 0..3 {
                    turn[k] = turn[k] - (push * by_a[k] + pull * a[k]) * p - (push * by_b[k] + pull * b[k]) * q;
                }
                Vector::put_each(turn, &mut fits.turn[column], place);
            }
        }
    }
}

/// φ h and its derivatives by x and by t.
struct Slopes<S: Simd> {
    energy: Vector<S>,
    by_area: Vector<S>,
    by_square: Vector<S>,
}

impl<S: Simd> Slopes<S> {
    #[inline(always)]
    fn of(simd: S, area: Vector<S>, square: Vector<S>) -> Self {
        let (zero, one, two) = (
            Vector::splat(simd, 0.0),
            Vector::splat(simd, 1.0),
            Vector::splat(simd, 2.0),
        );
        let short = Vector::splat(simd, RESISTS) - area;
        let short = short.or(zero.less(short), zero);
        let ratio = short / (area + Vector::splat(simd, LEAST));
        let collapse = short * short * ratio;
        let slope = -(ratio * (Vector::splat(simd, 3.0) * short + short * ratio));
        let apart = square * square - (area + area) * (area + area);
        let apart = (apart.or(zero.less(apart), zero) + Vector::splat(simd, ROUND)).sqrt();
        let beyond = Vector::splat(simd, 0.5) * (square + apart) - one;
        let beyond = beyond.or(zero.less(beyond), zero);
        let k = Vector::splat(simd, STRETCHED);
        let below = k + beyond * beyond;
        let share = beyond * beyond / below;
        let by_stretch = collapse * (two * k * beyond / (below * below));
        Self {
            energy: collapse * share,
            by_area: slope * share - by_stretch * two * area / apart,
            by_square: by_stretch * Vector::splat(simd, 0.5) * (one + square / apart),
        }
    }
}

#[inline(always)]
fn cross<S: Simd>(a: [Vector<S>; 3], b: [Vector<S>; 3]) -> [Vector<S>; 3] {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

#[inline(always)]
fn dot<S: Simd>(a: [Vector<S>; 3], b: [Vector<S>; 3]) -> Vector<S> {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

#[cfg(test)]
mod tests {
    use glam::DVec3;
    use pliant_mesh::shapes;

    use super::{LEAST, RESISTS, STRENGTH, STRETCHED};
    use crate::coarse::domain::Domain;
    use crate::methods::arap::bending::{add, stiffness, ties};
    use crate::methods::arap::cells::quad;
    use crate::methods::arap::rims;
    use crate::methods::arap::shape::{Guesses, Scratch, Shape};

    /// The smooth energy of a unit square that is stretched by these factors along its sides.
    fn stretched(along: f64, across: f64) -> f64 {
        let model = shapes::model(shapes::grid(6, 7));
        let (surface, topology) = (&model.surface, &model.topology);
        let order: Vec<u32> = (0..surface.positions.len() as u32).collect();
        let domain = Domain::of(surface, topology, &order);
        let ties = ties(surface, topology, &domain, stiffness(surface, &domain, 0.01));
        let mut cells = rims::cells(surface, topology, &vec![1.0; order.len()], &domain, &ties);
        add(&mut cells, &ties);
        let mut shape = Shape::at_rest(order.len(), domain.cell_count, domain.solved_count);
        for (own, &vertex) in shape.displacements.iter_mut().zip(&domain.vertices) {
            let p: DVec3 = surface.positions[vertex as usize];
            *own = quad(p * DVec3::new(along - 1.0, across - 1.0, 0.0), 0.0);
        }
        cells.measure(&mut shape, Guesses::Own, &mut Scratch::default());
        shape.energy
    }

    #[test]
    fn only_an_area_that_shrinks_while_it_is_stretched_pays_as_its_formula_says() {
        for (along, across) in [
            (1.3, 0.5),
            (0.2, 1.5),
            (0.5, 0.9),
            (1.4, 0.7),
            (1.0, 0.01),
            (2.0, 1.0),
            (1.2, 0.0),
        ] {
            let area: f64 = along * across;
            let beyond = f64::max(along, across).powi(2) - 1.0;
            let share = beyond.max(0.0).powi(2) / (beyond.max(0.0).powi(2) + STRETCHED);
            let barrier = STRENGTH * (RESISTS - area).max(0.0).powi(3) / (area + LEAST) * share;
            let expected = 0.5 * ((along - 1.0).powi(2) + (across - 1.0).powi(2)) + barrier;
            let found = stretched(along, across);
            assert!(
                (found - expected).abs() < 1e-5 * expected,
                "{along} {across}: {found} {expected}"
            );
        }
    }
}
