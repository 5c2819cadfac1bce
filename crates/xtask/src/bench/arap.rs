//! As-rigid-as-possible deformation compared with libigl, with the example `arap` of `deform` and `tests/peer/arap.py`:
//! the scenes of [BS08] and a scan.
//!
//! libigl runs 400 iterations; `reach` is the time after which Pliant's energy is below that of its result. An
//! iteration is a local and a global step in both. The times do not include binding, which has its own column.

use std::path::{Path, PathBuf};

use super::beside::{data, peers};
use super::scale::Scale;
use super::table::{Row, folder, measured};
use crate::process::output;

/// One row per scene and program.
pub fn rows(scale: Scale) -> Result<Vec<Row>, String> {
    let data = data();
    if !data.is_dir() {
        return Ok(vec![Row::default().text("says", "not here: the folder PLIANT_DATA")]);
    }
    let mut scenes = Vec::new();
    for name in ["bar", "cylinder", "cactus"] {
        scenes.push(copied(&data.join("survey"), name)?);
    }
    let peers = peers();
    scenes.extend(scan(&peers, &data, 0));
    if scale == Scale::Full {
        scenes.extend(scan(&peers, &data, 1));
    }
    let script = crate::root::root().join("tests/peer/arap.py").display().to_string();
    let all = std::thread::available_parallelism().map_or(1, usize::from);
    let mut rows = Vec::new();
    for off in scenes {
        let (off, shape) = (off.display().to_string(), off.with_extension("libigl.off"));
        let reached = shape.display().to_string();
        let peer = output("python3", &[&script, &off, &reached]).and_then(|line| Row::parse(&line));
        let libigl = Row::default().text("program", "libigl");
        rows.push(match peer {
            Some(row) => libigl.and(row),
            None => libigl.text("says", "not installed: pip install libigl numpy"),
        });
        for energy in ["spokes-and-rims", "smooth"] {
            let mut arguments = vec![off.clone(), all.to_string(), energy.to_owned()];
            if energy == "spokes-and-rims" && shape.is_file() {
                arguments.push(reached.clone());
            }
            let ours = measured("pliant-deform", "arap", &arguments)?;
            rows.extend(
                ours.into_iter()
                    .map(|row| Row::default().text("program", "Pliant").and(row)),
            );
        }
    }
    Ok(rows)
}

/// Copies a scene of the survey to the folder of measurements, where other shapes may be written next to it.
pub(super) fn copied(survey: &Path, name: &str) -> Result<PathBuf, String> {
    let folder = folder();
    for extension in ["off", "sel", "def"] {
        let file = format!("{name}.{extension}");
        std::fs::create_dir_all(&folder)
            .and_then(|()| std::fs::copy(survey.join(&file), folder.join(&file)))
            .map_err(|e| format!("{file} can't be copied: {e}."))?;
    }
    Ok(folder.join(format!("{name}.off")))
}

/// The armadillo as an OFF file, subdivided `level` times; `None` if the peers' script can't run.
fn scan(peers: &Path, data: &Path, level: usize) -> Option<PathBuf> {
    let off = folder().join(format!("armadillo-{level}.off"));
    if !off.exists() {
        let (script, edit) = (peers.join("scene.py"), off.with_extension("edit.json"));
        let mesh = data.join("scans/armadillo.obj");
        let level = level.to_string();
        let words = [script.as_path(), &mesh, Path::new(&level), &off, &edit].map(|p| p.display().to_string());
        output("python3", &words.each_ref().map(String::as_str))?;
    }
    Some(off)
}
