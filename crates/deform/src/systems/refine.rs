//! Solving with a factor that is only approximately the operator's.
//!
//! The residual is computed by the operator itself, by differences along edges, which is exact on constants, unlike the
//! assembled matrix. Plain refinement with it reduces a factor's error of 1e-5 to 1e-10 in one step. If the error falls
//! slowly or not at all (a stiff patch held by soft ones, a vertex held by one neighbour, a regularised factor), the
//! factor is wrong in a few directions only, and conjugate gradients with the factor as preconditioner need about one
//! step for each of them.

use pliant_mesh::Cancel;
use rayon::prelude::*;

use crate::numerical::rows::CHUNK;
use crate::sparse::matrix::CONSTRAINED;
use crate::sparse::system_error::SystemError;
use crate::systems::factored::BilaplacianSystem;

/// The most corrections of a solve, the first one included.
const STEPS: usize = 8;

/// The end of refinement.
#[derive(Clone, Copy, Debug)]
struct Accuracy {
    /// The fewest corrections.
    steps: usize,
    /// The next correction would be below this share of the solution.
    error: f64,
}

/// For a single solve: the second correction shows how good the first one was.
const FULL: Accuracy = Accuracy { steps: 2, error: 1e-10 };

/// For a frame: one correction is enough if the check found that the factor leaves so little. Positions saved in f32
/// are rounded by more.
const FRAME: Accuracy = Accuracy { steps: 1, error: 5e-8 };

/// A correction that is not smaller than this share of the last one needs conjugate gradients.
const SLOW: f64 = 0.03;

/// Steps of conjugate gradients within one correction.
const GRADIENT_STEPS: usize = 48;

/// Conjugate gradients end when the squared norm of the error has fallen by this factor.
const GRADIENT_DROP: f64 = 1e-18;

/// The share of its right-hand side that an iterative first correction may leave: a round more than for 1e-8 mostly
/// saves a whole further correction, and 3e-10 saves no more.
const FIRST: f64 = 1e-9;

/// The same for further corrections, which are small.
const FURTHER: f64 = 1e-3;

/// The outcome of a solve.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(crate) struct Outcome {
    /// An estimate of the remaining error, relative to the largest value: infinite if the result is not finite or the
    /// solve was cancelled.
    pub error: f64,
    /// The share of the error that a correction by the factor leaves, as far as this solve showed: 1 if conjugate
    /// gradients were needed.
    pub contraction: f64,
}

/// The allowed error of the constant.
pub(crate) const TOLERANCE: f64 = 1e-7;

/// A factored system whose solutions are refined with its own residual.
pub(crate) trait Refined {
    /// The place in a field of each column of the factor.
    fn places(&self) -> &[u32];

    /// The column of each place, [`CONSTRAINED`] if it is not solved. The places of springs come last.
    fn column_of(&self) -> &[u32];

    /// The number of rows of a field.
    fn field_len(&self) -> usize;

    /// S: the scale of each column.
    fn scale(&self) -> &[f64];

    /// S (b − A d) on the columns, b being prescribed by the rows of `d` that are not solved.
    fn scaled_residual<const K: usize>(&self, d: &[[f64; K]]) -> Vec<[f64; K]>;

    /// Like [`Refined::scaled_residual`], for a `d` that is zero on the columns.
    fn scaled_residual_from_zero<const K: usize>(&self, d: &[[f64; K]]) -> Vec<[f64; K]> {
        self.scaled_residual(d)
    }

    /// x ← (S A S)⁻¹ x, up to the error of the factor; undefined once cancelled. A solution by iteration may leave the
    /// share `left` of the right-hand side.
    fn solve_factored<const K: usize>(&self, x: &mut [[f64; K]], left: f64, cancel: &Cancel);

    /// A lower bound, known before any correction, of the share of the error that a correction leaves.
    fn least_contraction(&self) -> f64 {
        0.0
    }
}

impl Refined for BilaplacianSystem {
    fn places(&self) -> &[u32] {
        self.columns()
    }

    fn column_of(&self) -> &[u32] {
        Self::column_of(self)
    }

    fn field_len(&self) -> usize {
        self.operator.field_len()
    }

    fn scale(&self) -> &[f64] {
        Self::scale(self)
    }

    fn scaled_residual<const K: usize>(&self, d: &[[f64; K]]) -> Vec<[f64; K]> {
        Self::scaled_residual(self, d)
    }

    fn scaled_residual_from_zero<const K: usize>(&self, d: &[[f64; K]]) -> Vec<[f64; K]> {
        Self::scaled_residual_from_zero(self, d)
    }

    fn solve_factored<const K: usize>(&self, x: &mut [[f64; K]], left: f64, cancel: &Cancel) {
        self.solution().solve(x, left, cancel);
    }

    fn least_contraction(&self) -> f64 {
        if self.solution().is_iterative() { FURTHER } else { 0.0 }
    }
}

/// Fills in the solved rows of `d` from the others, as exactly as a single solve needs; `contraction` is an earlier
/// solve's result, or 0.
pub(crate) fn solve_fully<S: Refined, const K: usize>(
    system: &S,
    d: &mut [[f64; K]],
    contraction: f64,
    cancel: &Cancel,
) -> Outcome {
    solve(system, None, d, (contraction, FULL), cancel)
}

/// Like [`solve_fully`], as exactly as a frame needs.
pub(crate) fn solve_for_frames<S: Refined, const K: usize>(
    system: &S,
    d: &mut [[f64; K]],
    contraction: f64,
    cancel: &Cancel,
) -> Outcome {
    solve(system, None, d, (contraction, FRAME), cancel)
}

/// The largest error of a solution that should be 1 everywhere, the last one of each row, and its place.
pub(crate) fn missed_constant<S: Refined, const K: usize>(system: &S, d: &[[f64; K]]) -> (f64, u32) {
    let mut worst = (0.0, 0);
    for &place in system.places() {
        let error = (d[place as usize][K - 1] - 1.0).abs();
        if error > worst.0 || error.is_nan() {
            worst = (error, place);
        }
    }
    worst
}

impl BilaplacianSystem {
    /// Fills in the solved vertices of `d` from its constrained ones, with the check's contraction.
    pub fn solve<const K: usize>(&self, d: &mut [[f64; K]], cancel: &Cancel) -> Outcome {
        solve_fully(self, d, self.contraction, cancel)
    }

    /// Like [`BilaplacianSystem::solve`], for A d = b with a load b for each column of the factor.
    pub fn solve_loaded<const K: usize>(&self, load: &[[f64; K]], d: &mut [[f64; K]], cancel: &Cancel) -> Outcome {
        solve(self, Some(load), d, (self.contraction, FULL), cancel)
    }

    /// Like [`BilaplacianSystem::solve`], for A d = b with a load b for each column of the factor, as exactly as a
    /// frame needs.
    pub fn solve_frame<const K: usize>(&self, load: &[[f64; K]], d: &mut [[f64; K]]) -> Outcome {
        let accuracy = (self.contraction, FRAME);
        solve(self, Some(load), d, accuracy, &Cancel::new())
    }

    /// Solves like [`BilaplacianSystem::solve`] and stores the speed of refinement. The last function of `d` is 1 at
    /// every constrained place, so its solution is known to be 1: if the result differs, the factor is unusable.
    pub fn check<const K: usize>(&mut self, d: &mut [[f64; K]], cancel: &Cancel) -> Result<f64, SystemError> {
        let outcome = solve_fully(self, d, 0.0, cancel);
        self.contraction = outcome.contraction;
        cancel.check().map_err(|_| SystemError::Cancelled)?;
        let worst = missed_constant(self, d);
        if worst.0 <= TOLERANCE {
            Ok(outcome.error)
        } else {
            Err(SystemError::Inaccurate {
                vertex: self.operator.laplacian.vertices()[worst.1 as usize],
                error: worst.0,
            })
        }
    }
}

/// Fills in the solved vertices of the fields `d` from their other entries and the load, if there is one.
///
/// `contraction` is an earlier solve's result. A right-hand side with little in a direction in which the factor is
/// wrong alone would not reveal the error, and would keep a large part of it.
fn solve<S: Refined, const K: usize>(
    system: &S,
    load: Option<&[[f64; K]]>,
    d: &mut [[f64; K]],
    (contraction, accuracy): (f64, Accuracy),
    cancel: &Cancel,
) -> Outcome {
    for (row, &column) in d.iter_mut().zip(system.column_of()) {
        if column != CONSTRAINED {
            *row = [0.0; K];
        }
    }
    let mut outcome = Outcome {
        error: f64::INFINITY,
        contraction,
    };
    let mut last = f64::INFINITY;
    // The number of corrections, including the next, that use conjugate gradients.
    let mut gradients = 0;
    for step in 1..=STEPS {
        if cancel.is_cancelled() {
            break;
        }
        let mut x = if step == 1 {
            system.scaled_residual_from_zero(d)
        } else {
            system.scaled_residual(d)
        };
        let loaded = x.par_iter_mut().zip(load.unwrap_or_default()).zip(system.scale());
        loaded.with_min_len(CHUNK).for_each(|((x, load), scale)| {
            for k in 0..K {
                x[k] += load[k] * scale;
            }
        });
        if gradients > 0 {
            x = conjugate_gradients(system, x, cancel);
        } else {
            system.solve_factored(&mut x, if step == 1 { FIRST } else { FURTHER }, cancel);
        }
        let Some((correction, size)) = correct(system, d, &x) else {
            return Outcome {
                error: f64::INFINITY,
                ..outcome
            };
        };
        if correction == 0.0 {
            return Outcome { error: 0.0, ..outcome };
        }
        let relative = correction / size;
        if step >= accuracy.steps {
            if gradients == 0 {
                let shown = (relative / last).max(system.least_contraction());
                outcome.contraction = outcome.contraction.max(shown).min(1.0);
            }
            outcome.error = relative * if gradients > 0 { SLOW } else { outcome.contraction };
            let stalled = gradients > 1 && relative > 0.5 * last;
            if outcome.error < accuracy.error || stalled {
                return outcome;
            }
        }
        if gradients > 0 || outcome.contraction > SLOW {
            outcome.contraction = 1.0;
            gradients += 1;
        }
        last = relative;
    }
    outcome
}

/// Adds S x to `d`; returns the largest change and the largest value, or `None` if one is not finite.
fn correct<S: Refined, const K: usize>(system: &S, d: &mut [[f64; K]], x: &[[f64; K]]) -> Option<(f64, f64)> {
    let scale = system.scale();
    let chunk = |(targets, columns): (&mut [[f64; K]], &[u32])| {
        let (mut correction, mut size) = (0.0_f64, 0.0_f64);
        for (target, &column) in targets.iter_mut().zip(columns) {
            if column == CONSTRAINED {
                continue;
            }
            for k in 0..K {
                let change = x[column as usize][k] * scale[column as usize];
                target[k] += change;
                if !target[k].is_finite() {
                    return None;
                }
                correction = correction.max(change.abs());
                size = size.max(target[k].abs());
            }
        }
        Some((correction, size))
    };
    d.par_chunks_mut(CHUNK)
        .zip(system.column_of().par_chunks(CHUNK))
        .map(chunk)
        .try_reduce(|| (0.0, 0.0), |a, b| Some((a.0.max(b.0), a.1.max(b.1))))
}

/// Solves S A S x = r for each of the K right-hand sides, from zero.
fn conjugate_gradients<S: Refined, const K: usize>(system: &S, mut r: Vec<[f64; K]>, cancel: &Cancel) -> Vec<[f64; K]> {
    let mut x = vec![[0.0; K]; r.len()];
    let mut z = r.clone();
    system.solve_factored(&mut z, FIRST, cancel);
    let mut p = z.clone();
    let mut rho = dots(&r, &z);
    let first = rho;
    let mut scattered = vec![[0.0; K]; system.field_len()];
    for _ in 0..GRADIENT_STEPS {
        if cancel.is_cancelled() || (0..K).all(|k| rho[k].is_nan() || rho[k] <= GRADIENT_DROP * first[k]) {
            break;
        }
        for ((&place, &scale), p) in system.places().iter().zip(system.scale()).zip(&p) {
            scattered[place as usize] = p.map(|value| value * scale);
        }
        // The residual has the opposite sign: this is −S A S p.
        let minus_ap = system.scaled_residual(&scattered);
        let curvature = dots(&p, &minus_ap).map(|value| -value);
        // A column that is solved, or whose direction has no curvature left, no longer changes.
        let alpha: [f64; K] = std::array::from_fn(|k| if curvature[k] > 0.0 { rho[k] / curvature[k] } else { 0.0 });
        for (i, minus_ap) in minus_ap.iter().enumerate() {
            for k in 0..K {
                x[i][k] += alpha[k] * p[i][k];
                r[i][k] += alpha[k] * minus_ap[k];
            }
        }
        z.copy_from_slice(&r);
        system.solve_factored(&mut z, FIRST, cancel);
        let next = dots(&r, &z);
        let beta: [f64; K] = std::array::from_fn(|k| if rho[k] > 0.0 { next[k] / rho[k] } else { 0.0 });
        for (p, z) in p.iter_mut().zip(&z) {
            for k in 0..K {
                p[k] = z[k] + beta[k] * p[k];
            }
        }
        rho = next;
    }
    x
}

/// One dot product per column, summed in order.
fn dots<const K: usize>(a: &[[f64; K]], b: &[[f64; K]]) -> [f64; K] {
    let mut sums = [0.0; K];
    for (a, b) in a.iter().zip(b) {
        for k in 0..K {
            sums[k] += a[k] * b[k];
        }
    }
    sums
}
