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
            let number = |value: f64| Vector::splat(simd, value);
            let (zero, two, half) = (number(0.0), number(2.0), number(0.5));
            let (mut a, mut b) = ([zero; 3], [zero; 3]);
            for k in 0..3 {
                a[k] = s[0][k] * p0 + s[1][k] * p1 + s[2][k] * p2;
                b[k] = s[0][k] * q0 + s[1][k] * q1 + s[2][k] * q2;
            }
            let across = [
                a[1] * b[2] - a[2] * b[1],
                a[2] * b[0] - a[0] * b[2],
                a[0] * b[1] - a[1] * b[0],
            ];
            let area = (across[0] * across[0] + across[1] * across[1] + across[2] * across[2]).sqrt();
            let short = number(RESISTS) - area;
            let is_short = zero.less(short);
            if (!is_short).is_full() {
                zero.put(&mut self.energy, place);
                continue;
            }
            let short = short.or(is_short, zero);
            let ratio = short / (area + number(LEAST));
            let collapse = short * short * ratio;
            let slope = -(ratio * (number(3.0) * short + short * ratio));
            let square = a[0] * a[0] + a[1] * a[1] + a[2] * a[2] + b[0] * b[0] + b[1] * b[1] + b[2] * b[2];
            let apart = square * square - number(4.0) * area * area;
            let apart = (apart.or(zero.less(apart), zero) + number(ROUND)).sqrt();
            let beyond = half * (square + apart) - number(1.0);
            let beyond = beyond.or(zero.less(beyond), zero);
            let k = number(STRETCHED);
            let below = k + beyond * beyond;
            let share = beyond * beyond / below;
            let share_slope = two * k * beyond / (below * below);
            (weight * collapse * share).put(&mut self.energy, place);
            // −dψ/dx / |a × b| and −dψ/d(|a|² + |b|²) · 2.
            let by_stretch = collapse * share_slope;
            let by_area = slope * share - by_stretch * two * area / apart;
            let push = -(weight * by_area) / (area + number(1e-30));
            let pull = -(weight * by_stretch * (number(1.0) + square / apart));
            let by_a = [
                push * (b[1] * across[2] - b[2] * across[1]) + pull * a[0],
                push * (b[2] * across[0] - b[0] * across[2]) + pull * a[1],
                push * (b[0] * across[1] - b[1] * across[0]) + pull * a[2],
            ];
            let by_b = [
                push * (across[1] * a[2] - across[2] * a[1]) + pull * b[0],
                push * (across[2] * a[0] - across[0] * a[2]) + pull * b[1],
                push * (across[0] * a[1] - across[1] * a[0]) + pull * b[2],
            ];
            for (column, (p, q)) in [(p0, q0), (p1, q1), (p2, q2)].into_iter().enumerate() {
                let mut turn = Vector::each(simd, &fits.turn[column], place);
                for k in 0..3 {
                    turn[k] = turn[k] + by_a[k] * p + by_b[k] * q;
                }
                Vector::put_each(turn, &mut fits.turn[column], place);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec3;
    use pliant_mesh::shapes;

    use super::{LEAST, RESISTS, STRENGTH, STRETCHED};
    use crate::arap::bending::{add, stiffness, ties};
    use crate::arap::cells::quad;
    use crate::arap::rims;
    use crate::arap::shape::{Guesses, Scratch, Shape};
    use crate::coarse::domain::Domain;

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
