//! The limited-memory quasi-Newton direction (Nocedal & Wright, algorithm 7.4) in inner products alone.
//!
//! The preconditioner P majorises the energy's Hessian, so the first inverse is its inverse, unscaled, and the last
//! steps' curvature corrects it: with no memory the direction is exactly a global step of the plain local/global method.
//!
//! With mapped gradients z = P⁻¹ g known at both ends of a step, P⁻¹ y is their difference, and the direction is a sum
//! of z, steps s and mapped changes P⁻¹ y whose factors follow from products s · g, y · z = P⁻¹ y · g, s · y and y ·
//! P⁻¹ y. So two fields a step are remembered, and an iteration reads them twice (products, sum), where the two loops
//! read four times and write their field in between. All fields here are single precision, in units of a length of the
//! model: a direction needs no more digits, and what it is measured by, slope and energy, is not computed from them.

use pulp::{Arch, Simd, WithSimd};
use rayon::prelude::*;

use super::cells::Quad;
use crate::operators::CHUNK;
use crate::sparse::substitution::Row;
use crate::sums::CHUNKS_A_TASK;

/// Steps that are remembered. On the survey's bar, cylinder and cactus and a 43k scan 5, 8, 14 and 24 took the same
/// iterations within 4%, and 3 a fifth to two fifths more.
const MEMORY: usize = 5;

/// A pair whose curvature is below this share of its lengths says nothing.
const FLAT: f64 = 1e-12;

/// A field of the solved vertices.
pub(crate) type Field = Vec<Row<f32>>;

/// The last steps and what is known of them at the present point.
#[derive(Debug, Default)]
pub(crate) struct History {
    /// The oldest first.
    pairs: Vec<Pair>,
    /// A step whose end is not mapped yet.
    pending: Option<Pair>,
    /// Forgotten pairs' fields, to be used again.
    spare: Vec<Pair>,
    /// Of each pair: s · g and P⁻¹ y · g at the last point asked for.
    step_gradient: Vec<f64>,
    change_mapped: Vec<f64>,
    /// y of the pending pair.
    change: Field,
    /// The present point's gradient and mapped gradient, and the last one's.
    pub gradient: Field,
    pub mapped: Field,
    last_mapped: Field,
}

#[derive(Debug, Default)]
struct Pair {
    step: Field,
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

    /// Whether nothing is remembered.
    pub fn is_empty(&self) -> bool {
        self.pairs.is_empty()
    }

    /// Forgets a step whose end was left before it was mapped.
    pub fn drop_pending(&mut self) {
        self.spare.extend(self.pending.take());
    }

    /// Remembers the step −`length` · `direction`, which changed the gradient from `old` to `new`, times `factor` in
    /// this memory's units; its end is to be mapped next.
    pub fn stepped(&mut self, length: f64, direction: &Field, old: &[Quad], new: &[Quad], factor: f64) {
        let mut pair = self.spare.pop().unwrap_or_default();
        for field in [&mut pair.step, &mut self.change, &mut pair.mapped] {
            field.resize(direction.len(), Row::default());
        }
        let sums = pair
            .step
            .par_chunks_mut(CHUNK)
            .zip(self.change.par_chunks_mut(CHUNK))
            .zip(direction.par_chunks(CHUNK))
            .zip(old.par_chunks(CHUNK).zip(new.par_chunks(CHUNK)))
            .with_min_len(CHUNKS_A_TASK)
            .map(|(((step, change), direction), (old, new))| {
                for (place, direction) in direction.iter().enumerate() {
                    for k in 0..4 {
                        step[place][k] = (-length * f64::from(direction[k])) as f32;
                        change[place][k] = ((new[place][k] - old[place][k]) * factor) as f32;
                    }
                }
                [dot(step, change), dot(step, step), dot(change, change)]
            })
            .collect::<Vec<_>>();
        let [curvature, steps, changes] = sums.iter().fold([0.0; 3], |sum, part| add(sum, *part));
        let enough = FLAT * (steps * changes).sqrt();
        // The last point's mapped gradient is needed once more; a pair that is not kept drops it.
        std::mem::swap(&mut self.mapped, &mut self.last_mapped);
        if curvature.is_nan() || curvature <= enough {
            self.spare.push(pair);
            return;
        }
        pair.steps_change.clear();
        pair.changes_mapped.clear();
        pair.steps_change.push(curvature);
        self.pending = Some(pair);
    }

    /// Takes in `gradient` and `mapped`, the present point's, and gives the factors of its direction.
    pub fn factors(&mut self) -> Factors {
        let before = (self.step_gradient.clone(), self.change_mapped.clone());
        let mut pending = self.pending.take();
        let mut own_mapped = 0.0;
        if let Some(pair) = &mut pending {
            own_mapped = self.map_change(pair);
        }
        let count = self.pairs.len() + usize::from(pending.is_some());
        let all: Vec<&Pair> = self.pairs.iter().chain(&pending).collect();
        let partial: Vec<[[f64; 2]; MEMORY + 1]> = (0..self.gradient.len().div_ceil(CHUNK))
            .into_par_iter()
            .with_min_len(CHUNKS_A_TASK)
            .map(|chunk| {
                let range = chunk * CHUNK..((chunk + 1) * CHUNK).min(self.gradient.len());
                let gradient = &self.gradient[range.clone()];
                let mut sums = [[0.0; 2]; MEMORY + 1];
                for (sums, pair) in sums.iter_mut().zip(&all) {
                    *sums = [
                        dot(&pair.step[range.clone()], gradient),
                        dot(&pair.mapped[range.clone()], gradient),
                    ];
                }
                sums
            })
            .collect();
        self.step_gradient.clear();
        self.change_mapped.clear();
        for k in 0..count {
            self.step_gradient.push(partial.iter().map(|sums| sums[k][0]).sum());
            self.change_mapped.push(partial.iter().map(|sums| sums[k][1]).sum());
        }
        if let Some(mut pair) = pending {
            let curvature = pair.steps_change[0];
            pair.steps_change.clear();
            for k in 0..self.pairs.len() {
                pair.steps_change.push(self.step_gradient[k] - before.0[k]);
                pair.changes_mapped.push(self.change_mapped[k] - before.1[k]);
            }
            pair.steps_change.push(curvature);
            pair.changes_mapped.push(own_mapped);
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

    /// P⁻¹ y of a pending pair, and y · P⁻¹ y.
    fn map_change(&self, pair: &mut Pair) -> f64 {
        let partial: Vec<f64> = pair
            .mapped
            .par_chunks_mut(CHUNK)
            .zip(self.change.par_chunks(CHUNK))
            .zip(self.mapped.par_chunks(CHUNK).zip(self.last_mapped.par_chunks(CHUNK)))
            .with_min_len(CHUNKS_A_TASK)
            .map(|((difference, change), (new, old))| {
                for ((difference, new), old) in difference.iter_mut().zip(new).zip(old) {
                    for k in 0..4 {
                        difference[k] = new[k] - old[k];
                    }
                }
                dot(difference, change)
            })
            .collect();
        partial.iter().sum()
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

    /// The direction uphill in this memory's units, and its products with the gradient and itself.
    pub fn direction(&self, factors: &Factors, direction: &mut Field) -> [f64; 2] {
        direction.resize(self.mapped.len(), Row::default());
        let partial: Vec<[f64; 2]> = direction
            .par_chunks_mut(CHUNK)
            .enumerate()
            .with_min_len(CHUNKS_A_TASK)
            .map(|(chunk, direction)| {
                let range = chunk * CHUNK..chunk * CHUNK + direction.len();
                direction.copy_from_slice(&self.mapped[range.clone()]);
                for (k, pair) in self.pairs.iter().enumerate() {
                    let (step, change) = (factors.steps[k] as f32, factors.changes[k] as f32);
                    let fields = pair.step[range.clone()].iter().zip(&pair.mapped[range.clone()]);
                    for (own, (s, y)) in direction.iter_mut().zip(fields) {
                        for k in 0..4 {
                            own[k] += step * s[k] + change * y[k];
                        }
                    }
                }
                [dot(direction, &self.gradient[range]), dot(direction, direction)]
            })
            .collect();
        partial
            .iter()
            .fold([0.0; 2], |sum, part| [sum[0] + part[0], sum[1] + part[1]])
    }
}

/// By what the memory's fields enter a direction.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Factors {
    steps: [f64; MEMORY],
    changes: [f64; MEMORY],
}

fn add(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

/// a · b, summed in double precision.
fn dot(a: &[Row<f32>], b: &[Row<f32>]) -> f64 {
    Arch::new().dispatch(Dot { a, b })
}

struct Dot<'a> {
    a: &'a [Row<f32>],
    b: &'a [Row<f32>],
}

impl WithSimd for Dot<'_> {
    type Output = f64;

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> f64 {
        let mut sums = [[0.0_f64; 4]; 4];
        let (a, a_rest) = self.a.as_chunks::<4>();
        let (b, b_rest) = self.b.as_chunks::<4>();
        for (a, b) in a.iter().zip(b) {
            for row in 0..4 {
                for k in 0..4 {
                    sums[row][k] += f64::from(a[row][k]) * f64::from(b[row][k]);
                }
            }
        }
        for (a, b) in a_rest.iter().zip(b_rest) {
            for k in 0..4 {
                sums[0][k] += f64::from(a[k]) * f64::from(b[k]);
            }
        }
        let mut sum = 0.0;
        for row in sums {
            sum += (row[0] + row[1]) + (row[2] + row[3]);
        }
        sum
    }
}
