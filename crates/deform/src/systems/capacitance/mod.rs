//! The thin plate solved with the factor of the Laplacian instead of its own, in a fraction of the memory.
//!
//! At order 2 the rows of A = Bᵀ N⁻¹ B belong to solved vertices (f) and to the constrained ones beside them (c):
//!
//! A = P N⁻¹ P + Cᵀ D C, with P = −L_ff, C = L_cf, N = M / (k_b s) at f and D = k_b s M⁻¹ at c.
//!
//! The first term is a plate whose rim is supported but free to turn: its inverse is P⁻¹ N P⁻¹, two Poisson solves. The
//! clamping of the rim has the rank of the rim's vertices. The springs of soft handles are further rows of C, with
//! their strengths in D. By Woodbury's identity
//!
//! A⁻¹ = B − B Cᵀ S⁻¹ C B, with B = P⁻¹ N P⁻¹ and the *capacitance matrix* S = D⁻¹ + C B Cᵀ,
//!
//! the capacitance matrix method [BDGG71], which [Bjo83] uses for the biharmonic equation. S is never formed. It is
//! solved by conjugate directions ([`directions`]) for all right-hand sides together. They are as long as the rim, use
//! the plate near the rim as preconditioner ([`near_rim`]), and are kept for the next right-hand side.
//!
//! On scans the factor of P has 0.4 times as many numbers as that of A, because its separators are one vertex wide
//! instead of two. Multigrid with point smoothers on A itself was tried first, and lost: see `bench/measurements.md`.

mod directions;
mod near_rim;
mod rows;

use std::sync::{Arc, PoisonError, RwLock};

use pliant_mesh::Cancel;
use rayon::prelude::*;

use self::directions::{Directions, norms, orthonormalised};
use self::near_rim::NearRim;
use self::rows::CapacitanceRows;
use crate::budget::{Budget, bytes_of};
use crate::numerical::rows::CHUNK;
use crate::sparse::refactorisation::RenewableFactor;
use crate::sparse::solve::PartRows;
use crate::systems::operator::BilaplacianOperator;

/// The most applications of S in a solve.
const ROUNDS: usize = 100;

/// The most directions that are kept.
const MOST_KEPT: usize = 2000;

/// The factor of P, and the data that make it solve with A. All vectors are scaled by T, the scale of P's columns.
#[derive(Debug)]
pub(crate) struct Capacitance {
    factored: Arc<RenewableFactor>,
    /// T N T.
    middle: Vec<f64>,
    /// D^½ C T.
    rows: CapacitanceRows,
    near_rim: Option<NearRim>,
    /// The parts of the factor that the rows' columns depend on.
    beside_rim: Vec<bool>,
    kept: RwLock<Directions>,
    most_kept: usize,
    /// True if new directions are kept.
    is_learning: bool,
}

/// The scratch memory of a solve's passes, so that it is mapped once: at millions of vertices a page fault costs more
/// than the arithmetic on its page.
#[derive(Default)]
struct SolveMemory<const K: usize> {
    columns: Vec<[f64; K]>,
    part_rows: PartRows<K>,
}

impl Capacitance {
    /// Returns true if this operator's inverse is of the form above.
    pub fn applies_to(operator: &BilaplacianOperator) -> bool {
        operator.power == 2 && operator.stretching == 0.0 && operator.bending > 0.0 && operator.natural.is_none()
    }

    /// Solves with the factor of P, whose columns are the local vertices `columns`.
    pub fn new(
        operator: &BilaplacianOperator,
        (columns, column_of): (&[u32], &[u32]),
        factored: RenewableFactor,
        budget: Budget,
        cancel: &Cancel,
    ) -> Self {
        let scale = factored.scale();
        let resistance = |local: usize| {
            operator.bending * operator.cell_stiffness(local) * operator.laplacian.inverse_areas()[local]
        };
        let middle = columns.iter().zip(scale);
        let middle = middle.map(|(&local, scale)| scale * scale / resistance(local as usize));
        let middle = middle.collect();
        let rows = CapacitanceRows::of(operator, column_of, scale, resistance);
        let near_rim = NearRim::of(operator, (columns, column_of, scale), &rows, budget, cancel);
        // A direction and its image.
        let each = bytes_of(rows.len().max(1), 2 * size_of::<f64>());
        let left = budget.bytes.saturating_sub(near_rim.as_ref().map_or(0, NearRim::bytes));
        Self {
            middle,
            most_kept: ((left / each) as usize).min(MOST_KEPT),
            beside_rim: factored.factor.parts_above(rows.columns()),
            near_rim,
            rows,
            kept: RwLock::default(),
            is_learning: true,
            factored: Arc::new(factored),
        }
    }

    /// The factor of P.
    pub fn factored(&self) -> &Arc<RenewableFactor> {
        &self.factored
    }

    /// The number of stored entries.
    pub fn stored(&self) -> usize {
        let kept = self.kept.read().unwrap_or_else(PoisonError::into_inner);
        let near_rim = self.near_rim.as_ref().map_or(0, NearRim::stored);
        self.factored.factor.stored() + near_rim + self.middle.len() + 2 * kept.len() * self.rows.len()
    }

    /// From now on solves keep nothing, so that they may run at once and in any order.
    pub fn settle(&mut self) {
        self.is_learning = false;
    }

    /// Returns true if solves must follow each other in a fixed order, because each one learns from earlier ones.
    pub fn is_learning(&self) -> bool {
        self.is_learning
    }

    /// A sentence on the way of solving.
    pub fn sentence(&self) -> String {
        let kept = self.kept.read().unwrap_or_else(PoisonError::into_inner);
        format!(
            "the factor of {} free vertices does not fit the free memory, so they were solved with the Laplacian's \
             factor ({} MiB) and {} conjugate directions for {} vertices at the rim",
            self.middle.len(),
            (8 * self.factored.factor.stored()) >> 20,
            kept.len(),
            self.rows.len(),
        )
    }

    /// x ← (T A T)⁻¹ x in the scaled columns, leaving the share `left` of the rim's right-hand side.
    pub fn solve<const K: usize>(&self, x: &mut [[f64; K]], left: f64, cancel: &Cancel) {
        let mut memory = SolveMemory::default();
        if self.rows.len() == 0 {
            return self.solve_supported(x, &mut memory);
        }
        let load = x.to_vec();
        self.solve_supported_beside_rim(x, &mut memory);
        let pulls = self.solve_rim(self.rows.product(x), left, &mut memory, cancel);
        x.copy_from_slice(&load);
        drop(load);
        self.rows.subtract_transposed(&pulls, x);
        self.solve_supported(x, &mut memory);
    }

    /// x ← F⁻¹ (T N T) F⁻¹ x with the factor F, for the plate whose rim is free to turn.
    fn solve_supported<const K: usize>(&self, x: &mut [[f64; K]], memory: &mut SolveMemory<K>) {
        self.solve_load(x, memory);
        self.factored.factor.solve_within(None, x, &mut memory.part_rows);
    }

    /// Like [`Capacitance::solve_supported`], but right only in the columns in which rows have entries.
    fn solve_supported_beside_rim<const K: usize>(&self, x: &mut [[f64; K]], memory: &mut SolveMemory<K>) {
        self.solve_load(x, memory);
        let parts = Some(&*self.beside_rim);
        self.factored.factor.solve_within(parts, x, &mut memory.part_rows);
    }

    /// x ← (T N T) F⁻¹ x.
    fn solve_load<const K: usize>(&self, x: &mut [[f64; K]], memory: &mut SolveMemory<K>) {
        self.factored.factor.solve_within(None, x, &mut memory.part_rows);
        x.par_iter_mut()
            .with_min_len(CHUNK)
            .zip(&self.middle)
            .for_each(|(x, middle)| *x = x.map(|value| value * middle));
    }

    /// (1 + D^½ C B Cᵀ D^½) q.
    fn apply<const K: usize>(&self, q: &[[f64; K]], memory: &mut SolveMemory<K>) -> Vec<[f64; K]> {
        let mut x = std::mem::take(&mut memory.columns);
        x.clear();
        x.resize(self.middle.len(), [0.0; K]);
        self.rows.subtract_transposed(q, &mut x);
        self.solve_supported_beside_rim(&mut x, memory);
        let mut image = self.rows.product(&x);
        memory.columns = x;
        for (image, q) in image.iter_mut().zip(q) {
            for k in 0..K {
                image[k] = q[k] - image[k];
            }
        }
        image
    }

    /// Solves (1 + D^½ C B Cᵀ D^½) y = r until no residual is larger than the share `end` of its right-hand side.
    fn solve_rim<const K: usize>(
        &self,
        mut r: Vec<[f64; K]>,
        end: f64,
        memory: &mut SolveMemory<K>,
        cancel: &Cancel,
    ) -> Vec<[f64; K]> {
        let kept = self.kept.read().unwrap_or_else(PoisonError::into_inner);
        let mut own = Directions::default();
        let mut y = vec![[0.0; K]; r.len()];
        let whole = norms(&r);
        kept.project(0, &mut y, &mut r);
        for _ in 0..ROUNDS {
            let left = norms(&r);
            let is_open: [bool; K] = std::array::from_fn(|k| left[k] > end * whole[k]);
            if cancel.is_cancelled() || !is_open.contains(&true) {
                break;
            }
            let factor: [f64; K] = std::array::from_fn(|k| if is_open[k] { left[k].recip() } else { 0.0 });
            let mut block: Vec<[f64; K]> = r.iter().map(|r| std::array::from_fn(|k| r[k] * factor[k])).collect();
            if let Some(near_rim) = &self.near_rim {
                near_rim.precondition(&mut block);
            }
            // One pass leaves the rounding; two are enough.
            for _ in 0..2 {
                kept.remove_from(&mut block);
                own.remove_from(&mut block);
            }
            let image = self.apply(&block, memory);
            let before = own.len();
            own.extend(orthonormalised(&block, &image));
            if own.len() == before {
                break;
            }
            own.project(before, &mut y, &mut r);
        }
        drop(kept);
        if self.is_learning && !cancel.is_cancelled() {
            let mut kept = self.kept.write().unwrap_or_else(PoisonError::into_inner);
            let room = self.most_kept.saturating_sub(kept.len());
            kept.extend(own.first(room));
        }
        y
    }
}
