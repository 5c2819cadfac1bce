//! Reading and saving files, with the example `files` of `io`.

use super::meshes::creature_glb;
use super::scale::Scale;
use super::table::{Row, measured};

/// One row per size and kind of file. Reading uses all threads.
pub fn rows(scale: Scale) -> Result<Vec<Row>, String> {
    let sizes: &[usize] = match scale {
        Scale::Usual => &[60_000, 600_000],
        Scale::Full => &[60_000, 600_000, 5_000_000],
    };
    let mut rows = Vec::new();
    for &triangles in sizes {
        let mut arguments = vec![creature_glb(triangles)?.display().to_string()];
        arguments.extend(["ply", "stl", "obj", "off"].map(str::to_owned));
        rows.extend(measured("pliant-io", "files", &arguments)?);
    }
    Ok(rows)
}
