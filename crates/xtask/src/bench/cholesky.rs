//! The sparse Cholesky factorisation against faer's, with the example `cholesky` of `deform`: the same matrices, order
//! and threads, with every vector level that the processor has and with those up to AVX2.
//!
//! Both solvers take turns, and a ratio is the median over the turns: other work on the machine slows both of a turn
//! alike.

use std::path::Path;

use super::meshes::creature_off;
use super::scale::Scale;
use super::table::{Row, rows_of};
use crate::process::cargo;

/// The number of turns of each solver.
const TURNS: usize = 5;

/// The compared columns.
const MEASURED: [&str; 5] = ["symbolic", "numeric", "solve3", "factor_mb", "more_mb"];

/// A row for each size, vector level, number of threads and solver, and a row with the ratios of each pair.
pub fn rows(scale: Scale) -> Result<Vec<Row>, String> {
    // The sizes are those of the other measurements' meshes, and a million: nearly all of these vertices are free.
    let sizes: &[usize] = match scale {
        Scale::Usual => &[46_000, 184_000],
        Scale::Full => &[46_000, 184_000, 1_000_000],
    };
    let all = std::thread::available_parallelism().map_or(1, usize::from);
    let mut rows = Vec::new();
    for &vertices in sizes {
        let file = creature_off(vertices)?;
        for vectors in [&["--features", "avx512"][..], &["--no-default-features"]] {
            for threads in [1, all] {
                rows.extend(compared(&file, vectors, threads)?);
            }
        }
    }
    Ok(rows)
}

/// The medians of ours and of faer's, and of their ratios.
fn compared(file: &Path, vectors: &[&str], threads: usize) -> Result<[Row; 3], String> {
    let mut turns = Vec::new();
    for _ in 0..TURNS {
        turns.push([
            measured(file, vectors, threads, "ours")?,
            measured(file, vectors, threads, "faer")?,
        ]);
    }
    let medians = |solver: usize| {
        median_row(&turns[0][solver], |name| {
            turns.iter().map(|turn| number(&turn[solver], name)).collect()
        })
    };
    let ratios = |name: &str| {
        turns
            .iter()
            .map(|[ours, faer]| number(ours, name) / number(faer, name))
            .collect()
    };
    let ratio = median_row(&turns[0][0], ratios)
        .with_text("solver", "ours/faer")
        .with_text("residual", "");
    Ok([medians(0), medians(1), ratio])
}

/// `like` with the medians of `values` for each measured column.
fn median_row(like: &Row, values: impl Fn(&str) -> Vec<f64>) -> Row {
    MEASURED.iter().fold(like.clone(), |row, name| {
        let mut values = values(name);
        values.sort_by(f64::total_cmp);
        row.with_number(name, values[values.len() / 2])
    })
}

fn number(row: &Row, name: &str) -> f64 {
    row.get(name).and_then(|value| value.parse().ok()).unwrap_or(f64::NAN)
}

/// One solver's row, from a separate process, so that its peak of memory is its own.
fn measured(file: &Path, vectors: &[&str], threads: usize, solver: &str) -> Result<Row, String> {
    let mut command = cargo(&["run", "--locked", "--quiet", "--release", "--package", "pliant-deform"]);
    command.args(["--example", "cholesky"]).args(vectors).arg("--");
    command.arg(file).args([&threads.to_string(), solver]);
    let row = rows_of(&mut command)?.pop();
    row.ok_or_else(|| format!("The example `cholesky` printed no row for {}.", file.display()))
}
