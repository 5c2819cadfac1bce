//! The open file.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use pliant_engine::files::is_same;
use pliant_engine::{Loaded, OpenSequence};
use pliant_picture::drawing::Drawing;

use crate::files::names::file_name;
use crate::window::files::in_file::InFile;
use crate::window::files::rest_mesh::RestMesh;

/// The open file.
pub struct OpenFile {
    /// The path from which it was read, or to which it was last saved; none for the built-in sample.
    pub path: Option<PathBuf>,
    /// The file as stored when it was opened, and its vertex sets: every save patches it.
    pub loaded: Arc<Loaded>,
    /// The names of its morph targets.
    pub morph_targets: Vec<String>,
    /// Its data for the renderer.
    pub drawing: Arc<Drawing>,
    /// The mesh as it was read, and its present place.
    pub mesh: RestMesh,
    /// The project that it was opened from or saved to.
    pub project: Option<PathBuf>,
    /// The sequence of whose frames it is one.
    pub sequence: Option<Arc<OpenSequence>>,
    /// What the file at `path` holds of it.
    pub in_file: InFile,
    /// True if a person agreed to replace `path`, or saved it here under a new name.
    pub may_write_over: bool,
}

impl OpenFile {
    /// The name to show.
    pub fn name(&self) -> String {
        let own = self.path.as_deref().unwrap_or(&self.loaded.path);
        file_name(self.sequence.as_ref().map_or(own, |sequence| sequence.path()))
    }

    /// Returns true if a path leads to the file that was read or last saved.
    pub fn is_at(&self, path: &Path) -> bool {
        self.path.as_deref().is_some_and(|own| is_same(own, path))
    }

    /// Returns true if a path leads to the project.
    pub fn is_project_at(&self, path: &Path) -> bool {
        self.project.as_deref().is_some_and(|own| is_same(own, path))
    }
}
