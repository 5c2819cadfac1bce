//! The sparse Cholesky factorisation beside faer's, by the example `cholesky` of `deform`: the same matrices, order and
//! threads, with every vector level that the processor has and with those up to AVX2.

use super::Scale;
use super::meshes::{creature_off, sizes};
use super::table::{Row, rows_of};
use crate::process::cargo;

/// A row for each size, vector level, number of threads and solver.
pub fn rows(scale: Scale) -> Result<Vec<Row>, String> {
    let all = std::thread::available_parallelism().map_or(1, usize::from);
    let mut rows = Vec::new();
    for &vertices in sizes(scale) {
        let file = creature_off(vertices)?;
        for vectors in [&["--features", "avx512"][..], &["--no-default-features"]] {
            for threads in [1, all] {
                for solver in ["ours", "faer"] {
                    let mut command = cargo(&["run", "--locked", "--quiet", "--release", "--package", "pliant-deform"]);
                    command.args(["--example", "cholesky"]).args(vectors).arg("--");
                    command.arg(&file).args([&threads.to_string(), solver]);
                    rows.extend(rows_of(&mut command)?);
                }
            }
        }
    }
    Ok(rows)
}
