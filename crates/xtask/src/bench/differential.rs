//! The differential methods and the kinds of detail during a drag, with the example `differential` of `deform`.

use super::meshes::{creature_off, sizes};
use super::scale::Scale;
use super::table::{Row, measured};

/// One row per size and method, with all threads.
pub fn rows(scale: Scale) -> Result<Vec<Row>, String> {
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    let mut rows = Vec::new();
    for &vertices in sizes(scale) {
        let file = creature_off(vertices)?;
        rows.extend(measured(
            "pliant-deform",
            "differential",
            &[file.display().to_string(), threads.to_string()],
        )?);
    }
    Ok(rows)
}
