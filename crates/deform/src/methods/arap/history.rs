//! The limited-memory quasi-Newton direction [NW06, algorithm 7.4] in inner products alone.
//!
//! The preconditioner P majorises the energy's Hessian, so the first inverse is its inverse, unscaled, and the last
//! steps' curvature corrects it: without history the direction is exactly a global step of the plain local/global
//! method.
//!
//! With mapped gradients z = P⁻¹ g known at both ends of a step, P⁻¹ y is their difference, and the direction is a sum
//! of z, steps s and mapped changes P⁻¹ y whose factors follow from products s · g, y · z = P⁻¹ y · g, s · y and y ·
//! P⁻¹ y. So two fields per step are remembered, and an iteration reads them twice (products, sum); the usual two loops
//! read four times and write their field in between. All fields here are single precision, in units of a length of the
//! model: a direction needs no more digits, and slope and energy are not computed from them. The time of an iteration
//! is that of reading its fields from memory, so they have three numbers per vertex, not four.

use pliant_mesh::vectors;
use pulp::{Simd, WithSimd};
use rayon::prelude::*;

use crate::numerical::rows::CHUNK;
use crate::numerical::sums::CHUNKS_A_TASK;

/// The number of remembered steps. On the bar, cylinder and cactus of [BS08] and a 43k scan, 5, 8, 14 and 24 took the
/// same iterations within 4%, and 3 a fifth to two fifths more.
const MEMORY: usize = 5;

/// A pair whose curvature is below this share of its lengths is ignored.
const FLAT: f64 = 1e-12;

/// A field of the solved vertices.
pub(crate) type Field = Vec<[f32; 3]>;

/// The last steps and their products at the present point.
#[derive(Debug, Default)]
pub(crate) struct History {
    /// The pairs, the oldest first.
    pairs: Vec<Pair>,
    /// A step whose end is not mapped yet.
    pending: Option<Pair>,
    /// Forgotten pairs' fields, to be used again.
    spare: Vec<Pair>,
    /// For each pair: s · g and P⁻¹ y · g at the last requested point.
    step_gradient: Vec<f64>,
    change_mapped: Vec<f64>,
    /// The present point's mapped gradient, and the last one's.
    pub mapped: Field,
    last_mapped: Field,
}

#[derive(Debug, Default)]
struct Pair {
    /// s = −`length` · `direction`.
    direction: Field,
    length: f64,
    /// P⁻¹ y.
    mapped: Field,
    /// s_i · y of this pair's y with each pair's s up to its own, the oldest first.
    steps_change: Vec<f64>,
    /// y_i · P⁻¹ y likewise.
    changes_mapped: Vec<f64>,
}

impl History {
    /// Forgets everything.
    pub fn clear(&mut self) {
        self.spare.append(&mut self.pairs);
        self.spare.extend(self.pending.take());
    }

    /// Returns true if nothing is remembered.
    pub fn is_empty(&self) -> bool {
        self.pairs.is_empty()
    }

    /// Forgets a step whose end was left before it was mapped.
    pub fn drop_pending(&mut self) {
        self.spare.extend(self.pending.take());
    }

    /// Remembers the step −`length` · `direction`, whose end is to be mapped next; `direction` becomes free space for
    /// another.
    pub fn stepped(&mut self, length: f64, direction: &mut Field) {
        let mut pair = self.spare.pop().unwrap_or_default();
        std::mem::swap(&mut pair.direction, direction);
        pair.length = length;
        // The last point's mapped gradient is needed a last time.
        std::mem::swap(&mut self.mapped, &mut self.last_mapped);
        self.spare.extend(self.pending.replace(pair));
    }

    /// Adds the present point's `gradient` and its mapped one; `before` was the gradient at the beginning of the last
    /// remembered step. Returns the factors of the direction.
    pub fn factors(&mut self, before: &Field, gradient: &Field) -> Factors {
        let mut pending = self.pending.take();
        let own = pending.as_mut().map(|pair| self.map_change(pair, before, gradient));
        // A pair without curvature is ignored.
        let is_enough = |own: &Products| own.curvature > FLAT * (own.steps * own.changes).sqrt();
        if !own.as_ref().is_some_and(is_enough) {
            self.spare.extend(pending.take());
        }
        let last = (self.step_gradient.clone(), self.change_mapped.clone());
        let all: Vec<&Pair> = self.pairs.iter().chain(&pending).collect();
        let partial: Vec<[[f64; 2]; MEMORY + 1]> = (0..gradient.len().div_ceil(CHUNK))
            .into_par_iter()
            .with_min_len(CHUNKS_A_TASK)
            .map(|chunk| {
                let range = chunk * CHUNK..((chunk + 1) * CHUNK).min(gradient.len());
                let gradient = &gradient[range.clone()];
                let mut sums = [[0.0; 2]; MEMORY + 1];
                for (sums, pair) in sums.iter_mut().zip(&all) {
                    *sums = [
                        -pair.length * dot(&pair.direction[range.clone()], gradient),
                        dot(&pair.mapped[range.clone()], gradient),
                    ];
                }
                sums
            })
            .collect();
        let count = all.len();
        self.step_gradient.clear();
        self.change_mapped.clear();
        for k in 0..count {
            self.step_gradient.push(partial.iter().map(|sums| sums[k][0]).sum());
            self.change_mapped.push(partial.iter().map(|sums| sums[k][1]).sum());
        }
        if let Some((mut pair, own)) = pending.zip(own) {
            pair.steps_change.clear();
            pair.changes_mapped.clear();
            for k in 0..self.pairs.len() {
                pair.steps_change.push(self.step_gradient[k] - last.0[k]);
                pair.changes_mapped.push(self.change_mapped[k] - last.1[k]);
            }
            pair.steps_change.push(own.curvature);
            pair.changes_mapped.push(own.mapped);
            self.pairs.push(pair);
            if self.pairs.len() > MEMORY {
                self.forget_oldest();
            }
        }
        self.two_loops()
    }

    fn forget_oldest(&mut self) {
        let oldest = self.pairs.remove(0);
        self.spare.push(oldest);
        self.step_gradient.remove(0);
        self.change_mapped.remove(0);
        for pair in &mut self.pairs {
            pair.steps_change.remove(0);
            pair.changes_mapped.remove(0);
        }
    }

    /// P⁻¹ y of a pending pair, and its products with itself.
    fn map_change(&self, pair: &mut Pair, before: &Field, gradient: &Field) -> Products {
        let length = pair.length;
        pair.mapped.resize(gradient.len(), [0.0; 3]);
        let partial: Vec<Products> = pair
            .mapped
            .par_chunks_mut(CHUNK)
            .zip(pair.direction.par_chunks(CHUNK))
            .zip(self.mapped.par_chunks(CHUNK).zip(self.last_mapped.par_chunks(CHUNK)))
            .zip(gradient.par_chunks(CHUNK).zip(before.par_chunks(CHUNK)))
            .with_min_len(CHUNKS_A_TASK)
            .map(|(((mapped, direction), (new_mapped, old_mapped)), (new, old))| {
                difference(mapped, new_mapped, old_mapped);
                let mut scratch = [[0.0; 3]; CHUNK];
                let change = &mut scratch[..new.len()];
                difference(change, new, old);
                Products {
                    curvature: -length * dot(direction, change),
                    mapped: dot(mapped, change),
                    steps: length * length * dot(direction, direction),
                    changes: dot(change, change),
                }
            })
            .collect();
        let sum = |of: fn(&Products) -> f64| partial.iter().map(of).sum();
        Products {
            curvature: sum(|own| own.curvature),
            mapped: sum(|own| own.mapped),
            steps: sum(|own| own.steps),
            changes: sum(|own| own.changes),
        }
    }

    fn two_loops(&self) -> Factors {
        let count = self.pairs.len();
        let mut factors = Factors::default();
        let curvature = |k: usize| self.pairs[k].steps_change[k];
        let mut alphas = [0.0; MEMORY];
        for i in (0..count).rev() {
            let later: f64 = (i + 1..count).map(|j| alphas[j] * self.pairs[j].steps_change[i]).sum();
            alphas[i] = (self.step_gradient[i] - later) / curvature(i);
        }
        for i in 0..count {
            let mapped = |j: usize| {
                let (first, second) = (i.min(j), i.max(j));
                self.pairs[second].changes_mapped[first]
            };
            let bent: f64 = (0..count).map(|j| alphas[j] * mapped(j)).sum();
            let earlier: f64 = (0..i).map(|j| factors.steps[j] * self.pairs[i].steps_change[j]).sum();
            let beta = (self.change_mapped[i] - bent + earlier) / curvature(i);
            factors.steps[i] = alphas[i] - beta;
            factors.changes[i] = -alphas[i];
        }
        factors
    }

    /// The direction uphill in this memory's units, and its product with the gradient.
    pub fn direction(&self, factors: &Factors, gradient: &Field, direction: &mut Field) -> f64 {
        direction.resize(self.mapped.len(), [0.0; 3]);
        let partial: Vec<f64> = direction
            .par_chunks_mut(CHUNK)
            .enumerate()
            .with_min_len(CHUNKS_A_TASK)
            .map(|(chunk, direction)| {
                let range = chunk * CHUNK..chunk * CHUNK + direction.len();
                direction.copy_from_slice(&self.mapped[range.clone()]);
                for (k, pair) in self.pairs.iter().enumerate() {
                    vectors().dispatch(AddPair {
                        to: direction.as_flattened_mut(),
                        fields: [&pair.direction, &pair.mapped].map(|field| field[range.clone()].as_flattened()),
                        factors: [-pair.length * factors.steps[k], factors.changes[k]].map(|factor| factor as f32),
                    });
                }
                dot(direction, &gradient[range])
            })
            .collect();
        partial.iter().sum()
    }
}

/// to ← to + Σ factor · field.
struct AddPair<'a> {
    to: &'a mut [f32],
    fields: [&'a [f32]; 2],
    factors: [f32; 2],
}

impl WithSimd for AddPair<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let Self {
            to,
            fields: [a, b],
            factors: [by_a, by_b],
        } = self;
        for ((to, a), b) in to.iter_mut().zip(a).zip(b) {
            *to += by_a * a + by_b * b;
        }
    }
}

/// The factors of the memory's fields in a direction.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Factors {
    steps: [f64; MEMORY],
    changes: [f64; MEMORY],
}

/// A pair's products with itself: s · y, y · P⁻¹ y, s · s and y · y.
#[derive(Clone, Copy, Debug)]
struct Products {
    curvature: f64,
    mapped: f64,
    steps: f64,
    changes: f64,
}

/// `to` ← a − b.
fn difference(to: &mut [[f32; 3]], a: &[[f32; 3]], b: &[[f32; 3]]) {
    let terms = a.as_flattened().iter().zip(b.as_flattened());
    for (to, (a, b)) in to.as_flattened_mut().iter_mut().zip(terms) {
        *to = a - b;
    }
}

/// a · b. **f32**: products and the sums of eight of them, like the fields themselves; the rest is summed in double
/// precision.
fn dot(a: &[[f32; 3]], b: &[[f32; 3]]) -> f64 {
    vectors().dispatch(Dot {
        a: a.as_flattened(),
        b: b.as_flattened(),
    })
}

struct Dot<'a> {
    a: &'a [f32],
    b: &'a [f32],
}

/// The number of adjacent numbers in a sum of products, and of products in a single-precision sum.
const WIDTH: usize = 16;
const DEPTH: usize = 8;

impl WithSimd for Dot<'_> {
    type Output = f64;

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> f64 {
        let mut sums = [0.0_f64; WIDTH];
        let (a, a_rest) = self.a.as_chunks::<{ WIDTH * DEPTH }>();
        let (b, b_rest) = self.b.as_chunks::<{ WIDTH * DEPTH }>();
        for (a, b) in a.iter().zip(b) {
            let mut short = [0.0_f32; WIDTH];
            for (a, b) in a.as_chunks::<WIDTH>().0.iter().zip(b.as_chunks::<WIDTH>().0) {
                for k in 0..WIDTH {
                    short[k] += a[k] * b[k];
                }
            }
            for k in 0..WIDTH {
                sums[k] += f64::from(short[k]);
            }
        }
        let rest: f64 = a_rest.iter().zip(b_rest).map(|(a, b)| f64::from(a * b)).sum();
        let mut width = WIDTH;
        while width > 1 {
            width /= 2;
            for k in 0..width {
                sums[k] += sums[k + width];
            }
        }
        sums[0] + rest
    }
}
