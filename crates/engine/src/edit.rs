//! The file of an edit or of a project.

use std::path::Path;

use pliant_editor::{Beginning, Project};

use crate::watch::Watch;
use crate::{EngineError, control_mesh, files, is_project};

/// Reads the file of an edit or of a project, and the cages that it names; examples are read after the mesh
/// ([`examples::bring`](crate::examples::bring)).
///
/// # Errors
/// A file that can't be read, or a member that its format does not have, naming the file.
pub fn read_edit(path: &Path, watch: &Watch) -> Result<Beginning, EngineError> {
    watch.note_read("--edit", path);
    let text = files::read_text(path)?;
    let read = if is_project(path) {
        Project::parse(&text).map(Beginning::from)
    } else {
        Beginning::parse(&text)
    };
    let mut edit = read.map_err(|source| EngineError::Edit {
        edit: path.to_owned(),
        source,
    })?;
    control_mesh::bring(&mut edit, path, watch)?;
    Ok(edit)
}
