//! The frames of the open sequence with the edit, written by the function of `pliant sequence`.

use std::path::Path;

use pliant_editor::Beginning;
use pliant_engine::files::{Staging, shown};
use pliant_engine::{EditJob, EngineError, Sequence, memory, sequence};
use pliant_mesh::Cancel;

use super::save_request::FramesToWrite;

/// Writes all frames to `path`, or nothing, and returns notes for a person.
///
/// # Errors
/// Any refusal of a frame, of the edit or of a result, and a folder with something in it: its files could be meant to stay.
pub(super) fn write(frames: &FramesToWrite, path: &Path, cancel: &Cancel) -> Result<Vec<String>, EngineError> {
    if std::fs::read_dir(path).is_ok_and(|mut entries| entries.next().is_some()) {
        return Err(EngineError::Arguments(format!(
            "the folder {} is not empty: give the frames another name",
            shown(path)
        )));
    }
    let edit_path = Path::new("the present edit");
    // The very edit that *Export edit…* writes.
    let edit = Beginning::parse(&frames.edit.to_json()).map_err(|source| EngineError::Edit {
        edit: edit_path.to_owned(),
        source,
    })?;
    let stem = path.file_stem().unwrap_or_default().to_string_lossy();
    let job = Sequence {
        job: EditJob {
            file: &frames.sequence,
            edit: &edit,
            edit_path,
            output: path,
            report: None,
            weld: None,
            budget: memory::budget(),
        },
        mesh: frames.cached_mesh.as_deref(),
        fps: frames.fps,
        name: &stem,
        frames: frames.existing,
    };
    let report = sequence(&job, &frames.watch.stopped_by(cancel), &Staging::default())?;
    let mut notes = report.warnings;
    if report.bent_frames == 0 {
        notes.push("No key reaches a frame, so all frames are as they were.".to_owned());
    }
    Ok(notes)
}
