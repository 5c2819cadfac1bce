//! What an editor has and shows at one moment, to be written elsewhere or shown beside while the person goes on.

use std::sync::Arc;

use pliant_mesh::Model;

use crate::tool::ToolSettings;
use crate::view::{Camera, Look};
use crate::workspace::WorkspaceSnapshot;
use crate::{MeshReference, Project};

/// A document that nobody changes any more, and how it is shown. Taking one costs next to nothing: its long vectors
/// are shared.
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
