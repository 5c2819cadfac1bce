//! The state of an editor at one moment, to be written or shown elsewhere while the person goes on.

use std::sync::Arc;

use pliant_mesh::Model;

use crate::tool::ToolSettings;
use crate::view::{Camera, Look};
use crate::workspace::WorkspaceSnapshot;
use crate::{MeshReference, Project};

/// An immutable copy of the document, and how it is shown. Taking one is cheap: its long vectors are shared.
#[derive(Clone, Debug)]
pub struct Snapshot {
    pub(crate) work: WorkspaceSnapshot,
    pub(crate) camera: Camera,
    pub(crate) look: Look,
    pub(crate) settings: ToolSettings,
}

impl Snapshot {
    /// The project of this state. Takes some tens of milliseconds on a large mesh.
    pub fn project(&self, mesh: MeshReference) -> Project {
        Project::of(&self.work.document, &self.work.model, Some(&self.camera), mesh)
    }

    /// The mesh.
    pub fn model(&self) -> &Arc<Model> {
        &self.work.model
    }
}
