//! Another sequence, whose handles lead those of the edited one.

use std::path::Path;

use pliant_editor::EditFile;

use super::source::{Source, cache_format};
use crate::EngineError;
use crate::control_mesh::OF_EDIT;
use crate::edit_job::EditJob;
use crate::files::{OutputFolder, refuse_shared};
use crate::loading::Loaded;
use crate::path_text::shown;

/// The sequence that an edit names in `mix`, if it does. It has `count` frames of the mesh `first`.
///
/// # Errors
/// A folder or a cache that can't be read, with another number of frames, or which the output would overwrite.
pub(super) fn leading_sequence(
    job: &EditJob<'_>,
    edit: &EditFile,
    (first, count): (&Loaded, usize),
) -> Result<Option<Source>, EngineError> {
    let Some(mix) = &edit.mix else { return Ok(None) };
    let path = job.edit_path.with_file_name(&mix.sequence);
    let source = other_sequence(&path, first, (job.file, count))?;
    match cache_format(&path) {
        Some(_) => refuse_shared(("--output", job.output), [(OF_EDIT, &*path)])?,
        None => drop(OutputFolder::of(job.output, (OF_EDIT, &path))?),
    }
    Ok(Some(source))
}

/// The sequence at `path` of the mesh `first`, which can lead handles of the sequence at `of` with `count` frames.
///
/// # Errors
/// A folder or a cache that can't be read, or with another number of frames.
pub(super) fn other_sequence(path: &Path, first: &Loaded, (of, count): (&Path, usize)) -> Result<Source, EngineError> {
    let source = Source::of(path, first)?;
    match source.count() == count {
        true => Ok(source),
        false => Err(EngineError::Unsupported(format!(
            "{} has {} frames, and {} has {count}: mix it with a sequence that has as many frames",
            shown(path),
            source.count(),
            shown(of)
        ))),
    }
}
