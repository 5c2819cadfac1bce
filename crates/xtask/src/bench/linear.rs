//! The bi-Laplacian, step by step, with the example `linear` of `deform`.

use super::meshes::{creature_off, sizes};
use super::scale::Scale;
use super::table::{Row, measured};

/// One row per size, for one and for all threads.
pub fn rows(scale: Scale) -> Result<Vec<Row>, String> {
    let all = std::thread::available_parallelism().map_or(1, usize::from);
    let mut rows = Vec::new();
    for &vertices in sizes(scale) {
        let file = creature_off(vertices)?;
        for threads in [1, all] {
            // Each mesh has a separate process, so that the peak memory is this mesh's.
            let arguments = [file.display().to_string(), threads.to_string()];
            rows.extend(measured("pliant-deform", "linear", &arguments)?);
        }
    }
    Ok(rows)
}
