//! The document as it stands, to be written elsewhere while the person goes on.

use std::sync::Arc;

use pliant_mesh::Model;

use crate::document::Document;
use crate::editor::Editor;
use crate::{Camera, MeshReference, Project, geometry_hash};

/// A document that nobody changes any more. Taking one costs next to nothing: its long vectors are shared.
#[derive(Clone, Debug)]
pub struct Snapshot {
    document: Document,
    model: Arc<Model>,
    camera: Camera,
}

/// What a snapshot differs by: equal states have equal ones within a session.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub struct SnapshotKey {
    steps: u64,
    shape: u64,
    regions: u64,
}

impl Snapshot {
    /// The project of this state. Takes some tens of milliseconds on a large mesh.
    pub fn project(&self, mesh: MeshReference) -> Project {
        Project::of(&self.document, &self.model, Some(&self.camera), mesh)
    }

    /// The mesh.
    pub fn model(&self) -> &Arc<Model> {
        &self.model
    }
}

impl Editor {
    /// The document as it stands, with what is being dragged; `None` before the first file.
    pub fn snapshot(&self) -> Option<Snapshot> {
        Some(Snapshot {
            document: self.document.clone(),
            model: Arc::clone(self.engine.model.as_ref()?),
            camera: self.camera,
        })
    }

    /// Another value for every other state of the document.
    pub fn snapshot_key(&self) -> SnapshotKey {
        SnapshotKey {
            steps: self.history.revision(),
            shape: self.shape_counter,
            regions: self.regions_revision,
        }
    }

    /// A digest of the document, to tell whether two are the same to the bit; `None` before the first file.
    pub fn document_hash(&self) -> Option<String> {
        let snapshot = self.snapshot()?;
        let geometry = geometry_hash(&snapshot.model);
        Some(snapshot.project(MeshReference { path: None, geometry }).document_hash())
    }
}
