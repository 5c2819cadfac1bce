//! The editor on 400k triangles: the time of each event without a window and the memory of a hundred strokes, with the
//! example `editor_times` of `app`; and the window's longest frames without drawing, with `window_times`.

use super::meshes::creature_glb;
use super::scale::Scale;
use super::table::{Row, measured};

/// One row per kind of event and of work in the window; one size at every scale.
pub fn rows(_: Scale) -> Result<Vec<Row>, String> {
    let mut rows = measured("pliant-app", "editor_times", &[])?;
    let file = creature_glb(400_000)?.display().to_string();
    rows.extend(measured("pliant-app", "window_times", &[file])?);
    Ok(rows)
}
