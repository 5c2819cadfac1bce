//! Another sequence, whose handles lead those of the edited one.

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
    let source = Source::of(&path, first)?;
    if source.count() != count {
        return Err(EngineError::Unsupported(format!(
            "{} has {} frames, and {} has {count}: give `mix` a sequence with as many frames",
            shown(&path),
            source.count(),
            shown(job.file)
        )));
    }
    match cache_format(&path) {
        Some(_) => refuse_shared(("--output", job.output), [(OF_EDIT, &*path)])?,
        None => drop(OutputFolder::of(job.output, (OF_EDIT, &path))?),
    }
    Ok(Some(source))
}
