//! The mesh from which the present one was made by cutting, filling or joining, and the way back to it.

use std::collections::BTreeSet;
use std::sync::{Arc, Weak};

use glam::DVec3;
use pliant_mesh::Model;

use crate::document::Matching;
use crate::snapshot::Snapshot;

/// A mesh and its shape before a change of its triangles. It does not keep the mesh: that is there while undo leads to it.
/// Cloning shares it.
#[derive(Clone, Debug)]
pub struct Former {
    model: Weak<Model>,
    /// Matches the vertices of the changed mesh to its own.
    matching: Arc<Matching>,
    /// Its shape, as displacements from its file's.
    shape: Arc<Vec<DVec3>>,
    /// Its parts that were turned inside out.
    inside_out: Arc<BTreeSet<u32>>,
}

impl Former {
    /// The mesh of a snapshot, of which `new` is made.
    pub(crate) fn of(snapshot: &Snapshot, to_new: &Matching, new: &Model) -> Self {
        Self {
            model: Arc::downgrade(&snapshot.model),
            matching: Arc::new(to_new.inverse(&snapshot.model, new)),
            shape: Arc::clone(snapshot.document.from_file()),
            inside_out: Arc::clone(snapshot.document.inside_out()),
        }
    }

    /// A document of the changed mesh on this one: its regions, handles and later shape stay, as far as this mesh has
    /// their vertices. `None` if the mesh is there no longer.
    pub fn restore(&self, snapshot: &Snapshot) -> Option<Snapshot> {
        let model = self.model.upgrade()?;
        let document = snapshot
            .document
            .onto_former_mesh(&self.matching, &self.shape, &self.inside_out);
        Some(Snapshot {
            document,
            model,
            camera: snapshot.camera,
            work_pose: None,
        })
    }
}
