//! The times of machines with narrower vectors: the examples `linear` and `steps` of `deform` with each kind of vectors
//! of this processor. Its caches stay the same.
//!
//! The variable `PLIANT_VECTORS` does the same for any other section, for example
//! `PLIANT_VECTORS=avx2 cargo xtask bench peers`.

use super::meshes::{creature_off, sizes};
use super::scale::Scale;
use super::table::{Row, release, rows_of};

/// The names for `PLIANT_VECTORS`.
const VECTORS: [&str; 3] = ["avx512", "avx2", "baseline"];

/// One row per size, vectors and method.
pub fn rows(scale: Scale) -> Result<Vec<Row>, String> {
    let all = std::thread::available_parallelism().map_or(1, usize::from).to_string();
    let programs: [(&str, &[&str]); 2] = [("linear", &[]), ("steps", &["arap", "spokes-and-rims"])];
    let mut rows = Vec::new();
    for (example, words) in programs {
        for &vertices in &sizes(scale)[1..] {
            let file = creature_off(vertices)?.display().to_string();
            for vectors in VECTORS {
                let mut command = release("pliant-deform", ["--example", example]);
                command.args([&file, &all]).args(words);
                command.env("PLIANT_VECTORS", vectors);
                let named = Row::default().text("vectors", vectors);
                match rows_of(&mut command) {
                    Ok(measured) => rows.extend(measured.into_iter().map(|row| named.clone().and(row))),
                    Err(sentence) => rows.push(named.text("says", &sentence)),
                }
            }
        }
    }
    Ok(rows)
}
