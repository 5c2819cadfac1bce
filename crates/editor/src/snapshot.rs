//! The state of an editor at one moment, for writing or showing it elsewhere while the person continues to work.

use std::sync::Arc;

use glam::DVec3;
use pliant_mesh::Model;

use crate::document::Matching;
use crate::tool::ToolSettings;
use crate::view::{Camera, Look};
use crate::workspace::WorkspaceSnapshot;
use crate::{Beginning, MeshReference, Project, geometry_hash};

/// An immutable copy of the document and its display. Making one is cheap: its long vectors are shared.
#[derive(Clone, Debug)]
pub struct Snapshot {
    pub(crate) work: WorkspaceSnapshot,
    pub(crate) camera: Camera,
    pub(crate) look: Look,
    pub(crate) settings: ToolSettings,
}

impl Snapshot {
    /// The project of this state. This takes some tens of milliseconds on a large mesh.
    pub fn project(&self, mesh: MeshReference) -> Project {
        Project::of(&self.work.document, &self.work.model, Some(&self.camera), mesh)
    }

    /// The document on its mesh when that is read again, after another program has changed the file or with another
    /// joining of its vertices, and the number of vertices of the new mesh without a counterpart. `saved` are the
    /// file's displacements at its last save (an entry per surface vertex), if there was one.
    pub fn on_changed_mesh(&self, model: &Model, saved: Option<&[DVec3]>) -> (Beginning, usize) {
        let matching = Matching::of(&self.work.model, model, saved);
        let document = self.work.document.onto(&matching, saved);
        let mesh = MeshReference {
            path: None,
            name: None,
            geometry: geometry_hash(model),
        };
        let project = Project::of(&document, model, Some(&self.camera), mesh);
        (project.into(), matching.unmatched())
    }

    /// The mesh.
    pub fn model(&self) -> &Arc<Model> {
        &self.work.model
    }
}
