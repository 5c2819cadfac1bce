//! The meshes for measurements, made once and kept in `target/bench`.

use std::fmt::Write;
use std::path::PathBuf;

use super::scale::Scale;
use super::table::{folder, write};
use crate::assets::{creature_of, glb};

/// Sizes of the creature, in vertices.
pub fn sizes(scale: Scale) -> &'static [usize] {
    match scale {
        Scale::Usual => &[10_000, 50_000, 200_000],
        Scale::Full => &[10_000, 50_000, 200_000, 1_000_000],
    }
}

/// The creature with about this many triangles, as GLB.
///
/// # Errors
/// One sentence if it can't be made or written.
pub fn creature_glb(triangles: usize) -> Result<PathBuf, String> {
    let path = folder().join(format!("creature-{triangles}.glb"));
    if !path.exists() {
        write(&path, &glb::write(&creature_of(triangles)?, "creature"))?;
    }
    Ok(path)
}

/// The creature with about this many vertices, as OFF, which examples can read in a few lines.
///
/// # Errors
/// One sentence if it can't be made or written.
pub fn creature_off(vertices: usize) -> Result<PathBuf, String> {
    let path = folder().join(format!("creature-{vertices}.off"));
    if path.exists() {
        return Ok(path);
    }
    // A closed surface has about two triangles per vertex.
    let mesh = creature_of(2 * vertices)?;
    let mut text = format!("OFF\n{} {} 0\n", mesh.positions.len(), mesh.triangles.len());
    for p in &mesh.positions {
        let _ = writeln!(text, "{} {} {}", p.x, p.y, p.z);
    }
    for [a, b, c] in &mesh.triangles {
        let _ = writeln!(text, "3 {a} {b} {c}");
    }
    write(&path, text.as_bytes())?;
    Ok(path)
}
