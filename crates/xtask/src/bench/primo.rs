//! Coupled prisms on the survey's scenes, with the example `primo` of `deform`.

use super::beside::data;
use super::scale::Scale;
use super::table::{Row, measured};

/// One row per scene, on all threads; none if the survey's scenes are missing.
pub fn rows(_: Scale) -> Result<Vec<Row>, String> {
    let all = std::thread::available_parallelism().map_or(1, usize::from);
    let folder = data().join("survey");
    let mut rows = Vec::new();
    for scene in ["bar", "cylinder", "cactus", "plane"] {
        let scene = folder.join(scene);
        if scene.with_extension("off").exists() {
            let arguments = [scene.display().to_string(), all.to_string()];
            rows.extend(measured("pliant-deform", "primo", &arguments)?);
        }
    }
    Ok(rows)
}
