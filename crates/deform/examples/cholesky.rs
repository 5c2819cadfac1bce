//! Times the sparse Cholesky factorisation beside faer's: `cholesky MESH.off THREADS ours|faer`.
//!
//! Both factor the bi-Laplacian of the edit that peers are timed on, in the same elimination order and on as many
//! threads; a process for each, so that its peak of memory is its own. faer factors on all threads and solves on one,
//! which is quicker. Ours allocates its factor in every numeric factorisation, faer writes into an existing one. One
//! JSON object; times are medians in milliseconds, sizes in megabytes; `more_mb` is the peak beyond the matrix.
#![allow(clippy::print_stdout, clippy::unwrap_used, reason = "a program that measures")]

mod common;

use std::path::Path;

use common::{forget_peak, median, name, one_handle, peak_mb, peers_edit, pool, read, timed};
use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::llt::factor::LltRegularization;
use faer::prelude::Mat;
use faer::sparse::linalg::SupernodalThreshold;
use faer::sparse::linalg::cholesky::{CholeskySymbolicParams, SymmetricOrdering, factorize_symbolic_cholesky};
use faer::sparse::{SparseColMatRef, SymbolicSparseColMatRef};
use faer::{Conj, Par, Side};
use pliant_deform::stages::{Matrix, Operator};
use pliant_deform::{Bilaplacian, Method};
use pliant_mesh::{Cancel, Progress};

fn main() {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let [file, threads, solver] = &words[..] else {
        panic!("usage: cholesky MESH.off THREADS ours|faer");
    };
    let threads: usize = threads.parse().unwrap();
    let pool = pool(threads);
    pool.install(|| {
        let file = Path::new(file);
        let (operator, matrix) = system(file);
        let sorted = (solver == "faer").then(|| Sorted::of(&matrix));
        forget_peak();
        let before_mb = peak_mb();
        let times = if matrix.column_count() > 500_000 { 3 } else { 5 };
        let found = match &sorted {
            Some(sorted) => by_faer(sorted, threads, times),
            None => by_ours(&operator, &matrix, times),
        };
        println!(
            "{{\"mesh\": \"{}\", \"vectors\": \"{}\", \"threads\": {threads}, \"solver\": \"{solver}\", \"free\": {}, \
             \"symbolic\": {:.1}, \"numeric\": {:.1}, \"solve3\": {:.1}, \"factor_mb\": {:.1}, \"more_mb\": {:.0}, \
             \"residual\": {:.1e}}}",
            name(file),
            if cfg!(feature = "avx512") { "all" } else { "to AVX2" },
            matrix.column_count(),
            found.symbolic_ms,
            found.numeric_ms,
            found.solve_ms,
            8e-6 * found.stored as f64,
            peak_mb() - before_mb,
            residual(&matrix, &found.solution),
        );
    });
}

/// The costs and the result of a solver.
struct Found {
    symbolic_ms: f64,
    numeric_ms: f64,
    solve_ms: f64,
    /// The number of the factor's entries.
    stored: usize,
    /// The size of the matrix and three right-hand sides that are one everywhere.
    solution: Vec<[f64; 3]>,
}

fn system(file: &Path) -> (Operator, Matrix) {
    let model = read(file);
    let (roles, _) = peers_edit(&model);
    let (progress, cancel) = (Progress::new(), Cancel::new());
    let options = Bilaplacian::default();
    let method = Method::from(options.clone());
    let ordering = method.ordering(&model.topology, &progress, &cancel).unwrap().unwrap();
    let stiffness = vec![1.0; roles.len()];
    let problem = one_handle(&model, &roles, &stiffness, &method);
    let operator = Operator::of(&problem, &options, &ordering).unwrap();
    let matrix = operator.assemble().unwrap();
    (operator, matrix)
}

fn by_ours(operator: &Operator, matrix: &Matrix, times: usize) -> Found {
    let (symbolic_ms, _) = medians(times, || operator.analyse(matrix).unwrap());
    let mut numeric = Vec::new();
    let mut factor = operator.analyse(matrix).unwrap();
    for _ in 0..times {
        factor = operator.analyse(matrix).unwrap();
        numeric.push(timed(|| factor.fill(matrix).unwrap()).0);
    }
    let (solve_ms, solution) = medians(times, || {
        let mut x = vec![[1.0; 3]; matrix.column_count()];
        factor.solve(&mut x);
        x
    });
    Found {
        symbolic_ms,
        numeric_ms: median(&mut numeric),
        solve_ms,
        stored: factor.stored(),
        solution,
    }
}

/// The matrix as faer takes it: its lower triangle, and the pattern of its upper triangle, with ascending rows.
struct Sorted {
    offsets: Vec<u32>,
    rows: Vec<u32>,
    values: Vec<f64>,
    upper_offsets: Vec<u32>,
    upper_rows: Vec<u32>,
}

impl Sorted {
    fn of(matrix: &Matrix) -> Self {
        let (offsets, rows, values) = matrix.lower_columns();
        let mut sorted = Self {
            offsets: offsets.to_vec(),
            rows: Vec::with_capacity(rows.len()),
            values: Vec::with_capacity(values.len()),
            upper_offsets: vec![0],
            upper_rows: Vec::with_capacity(rows.len()),
        };
        let mut upper = vec![Vec::new(); matrix.column_count()];
        for (number, column) in (0..).zip(offsets.windows(2)) {
            let mut entries: Vec<usize> = (column[0] as usize..column[1] as usize).collect();
            entries.sort_unstable_by_key(|&entry| rows[entry]);
            sorted.rows.extend(entries.iter().map(|&entry| rows[entry]));
            sorted.values.extend(entries.iter().map(|&entry| values[entry]));
            entries
                .iter()
                .for_each(|&entry| upper[rows[entry] as usize].push(number));
        }
        for column in upper {
            sorted.upper_rows.extend(column);
            sorted.upper_offsets.push(sorted.upper_rows.len() as u32);
        }
        sorted
    }
}

fn by_faer(matrix: &Sorted, threads: usize, times: usize) -> Found {
    let count = matrix.offsets.len() - 1;
    let pattern = SymbolicSparseColMatRef::new_checked(count, count, &matrix.offsets, None, &matrix.rows);
    let lower = SparseColMatRef::new(pattern, &matrix.values);
    let upper = SymbolicSparseColMatRef::new_checked(count, count, &matrix.upper_offsets, None, &matrix.upper_rows);
    let par = if threads == 1 { Par::Seq } else { Par::rayon(threads) };
    // The order is made already; ours is never simplicial either.
    let params = || CholeskySymbolicParams {
        supernodal_flop_ratio_threshold: SupernodalThreshold::FORCE_SUPERNODAL,
        ..Default::default()
    };
    // Without a permutation the symbolic step takes the upper triangle and the numeric one the lower.
    let analyse = || factorize_symbolic_cholesky(upper, Side::Upper, SymmetricOrdering::Identity, params()).unwrap();
    let (symbolic_ms, symbolic) = medians(times, analyse);
    let mut numbers = vec![0.0; symbolic.len_val()];
    let mut memory = MemBuffer::new(symbolic.factorize_numeric_llt_scratch::<f64>(par, Default::default()));
    let (numeric_ms, ()) = medians(times, || {
        let regularization = LltRegularization::default();
        let stack = MemStack::new(&mut memory);
        symbolic
            .factorize_numeric_llt(
                &mut numbers,
                lower,
                Side::Lower,
                regularization,
                par,
                stack,
                Default::default(),
            )
            .unwrap();
    });
    let factor = faer::sparse::linalg::cholesky::LltRef::new(&symbolic, &numbers);
    let mut memory = MemBuffer::new(symbolic.solve_in_place_scratch::<f64>(3, Par::Seq));
    let (solve_ms, solution) = medians(times, || {
        let mut x = Mat::from_fn(count, 3, |_, _| 1.0);
        factor.solve_in_place_with_conj(Conj::No, x.as_mut(), Par::Seq, MemStack::new(&mut memory));
        x
    });
    Found {
        symbolic_ms,
        numeric_ms,
        solve_ms,
        stored: numbers.len(),
        solution: (0..count).map(|i| [0, 1, 2].map(|k| solution[(i, k)])).collect(),
    }
}

/// The largest |A x − 1|: both solved the same system.
fn residual(matrix: &Matrix, x: &[[f64; 3]]) -> f64 {
    let (offsets, rows, values) = matrix.lower_columns();
    let mut left = vec![1.0; x.len()];
    for column in 0..x.len() {
        for entry in offsets[column] as usize..offsets[column + 1] as usize {
            let (row, value) = (rows[entry] as usize, values[entry]);
            left[row] -= value * x[column][0];
            if row != column {
                left[column] -= value * x[row][0];
            }
        }
    }
    left.iter().fold(0.0, |most, value: &f64| most.max(value.abs()))
}

fn medians<T>(times: usize, mut run: impl FnMut() -> T) -> (f64, T) {
    let mut taken = Vec::new();
    let mut last = None;
    for _ in 0..times {
        drop(last.take());
        let (ms, found) = timed(&mut run);
        taken.push(ms);
        last = Some(found);
    }
    (median(&mut taken), last.unwrap())
}
