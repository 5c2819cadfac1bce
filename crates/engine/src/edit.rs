//! The file of an edit or of a project.

use std::path::{Path, PathBuf};

use pliant_editor::{Beginning, Project};

use crate::watch::Watch;
use crate::{EngineError, control_mesh, examples, files, is_project};

/// Reads the file of an edit or of a project, and the cages that it names. With it the paths of all files that it names;
/// examples are read once the mesh is ([`examples::bring`]).
///
/// # Errors
/// A file that can't be read, or what its format does not have, naming the file.
pub fn read_edit(path: &Path, watch: &Watch) -> Result<(Beginning, Vec<PathBuf>), EngineError> {
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
    let mut named = control_mesh::bring(&mut edit, path, watch)?;
    named.extend(examples::files(&mut edit, path));
    Ok((edit, named))
}
