//! The editor on 400k triangles: what each event takes without a window and what a hundred strokes leave in memory, by the
//! example `editor_times` of `app`; and the window's longest frames, drawing apart, by `window_times`.

use super::Scale;
use super::meshes::creature_glb;
use super::table::{Row, measured};

/// A row for each kind of event and of work in the window; one size, whatever the scale.
pub fn rows(_: Scale) -> Result<Vec<Row>, String> {
    let mut rows = measured("pliant-app", "editor_times", &[])?;
    let file = creature_glb(400_000)?.display().to_string();
    rows.extend(measured("pliant-app", "window_times", &[file])?);
    Ok(rows)
}
