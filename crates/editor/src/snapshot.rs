//! The state of an editor at one moment, for writing or showing it elsewhere while the person continues to work.

use std::sync::Arc;

use glam::DVec3;
use pliant_mesh::Model;

use crate::document::{Document, Dye, Matching, Pose};
use crate::view::Camera;
use crate::{Beginning, MeshReference, Project, geometry_hash};

/// An immutable copy of the document and its display. Making one is cheap: its long vectors are shared.
#[derive(Clone, Debug)]
pub struct Snapshot {
    pub(crate) document: Document,
    pub(crate) model: Arc<Model>,
    pub(crate) camera: Camera,
    /// The shown state, if the document is that outside a work pose.
    pub(crate) work_pose: Option<Pose>,
}

impl Snapshot {
    /// The project of this state. This takes some tens of milliseconds on a large mesh.
    pub fn project(&self, mesh: MeshReference) -> Project {
        let project = Project::of(&self.document, &self.model, Some(&self.camera), mesh);
        project.in_work_pose(self.work_pose.as_ref())
    }

    /// The same without the kept dye that a file has already, whose colours were saved with `saved`: an entry per surface
    /// vertex.
    #[must_use]
    pub fn without_saved_dye(&self, saved: &[Dye]) -> Self {
        let mut without = self.clone();
        without.document.set_fluid(self.document.fluid().without_saved(saved));
        without
    }

    /// The dye that was kept as vertex colours, of each surface vertex.
    pub fn kept_dye(&self) -> Option<&Arc<Vec<Dye>>> {
        self.document.fluid().kept.as_ref()
    }

    /// The document on its mesh when that is read again, after another program has changed the file or with another
    /// joining of its vertices, and the number of vertices of the new mesh without a counterpart. `saved` are the
    /// file's displacements at its last save (an entry per surface vertex), if there was one.
    pub fn on_changed_mesh(&self, model: &Model, saved: Option<&[DVec3]>) -> (Beginning, usize) {
        let matching = Matching::of(&self.model, model, saved);
        let document = self.document.onto(&matching, saved);
        let mesh = MeshReference {
            path: None,
            name: None,
            geometry: geometry_hash(model),
        };
        let project = Project::of(&document, model, Some(&self.camera), mesh);
        let project = project.in_work_pose(self.work_pose.as_ref());
        (project.into(), matching.unmatched())
    }

    /// The shape, as displacements of the surface's vertices from the file's.
    pub fn displacements(&self) -> &[DVec3] {
        self.document.from_file()
    }

    /// The mesh.
    pub fn model(&self) -> &Arc<Model> {
        &self.model
    }
}
