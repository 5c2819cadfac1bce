//! Changes of the mesh as steps of the history.

use std::sync::Arc;

use glam::DVec3;

use super::control_selection::ControlSelection;
use super::state::Workspace;
use super::stitching_request::Stitching;
use crate::document::{Content, Versions};
use crate::jobs::Symmetry;
use crate::stitching::{MeshChange, NewMesh};

/// Asks for a change of the mesh.
pub(crate) fn stitch(workspace: &mut Workspace, change: MeshChange) {
    workspace.stitching = Some(Stitching { change, taken_at: None });
}

/// The change that was asked for, once.
pub(crate) fn take_stitching(workspace: &mut Workspace) -> Option<MeshChange> {
    let now = present(workspace);
    let stitching = workspace.stitching.as_mut()?;
    if stitching.taken_at.replace(now).is_some() {
        return None;
    }
    Some(stitching.change.clone())
}

/// Differs for every other state of the document.
fn present(workspace: &Workspace) -> (u64, Versions) {
    (workspace.history.revision(), *workspace.document.versions())
}

/// Takes the end of a change of the mesh: the new mesh, or the reason why there is none.
pub(crate) fn take_stitched(workspace: &mut Workspace, result: Result<NewMesh, String>) {
    let Some(stitching) = workspace.stitching.take() else {
        return;
    };
    match result {
        Ok(_) if stitching.taken_at != Some(present(workspace)) => {
            let name = stitching.change.name();
            workspace.refuse(format!(
                "The document was changed in the meantime, so the new mesh was dropped: choose {name} again."
            ));
        }
        Ok(new) => workspace.replace_mesh(stitching.change.name(), new),
        Err(sentence) => workspace.refuse(sentence),
    }
}

impl Workspace {
    /// Replaces the mesh and the document on it, as one step of the history.
    fn replace_mesh(&mut self, name: &str, new: NewMesh) {
        self.jobs.drop_solves();
        self.history.sync(&self.document);
        let before = Content::clone(&self.document);
        self.document.replace(new.document);
        self.history
            .push_mesh(name.to_owned(), new.model, before, &self.document);
        self.follow_mesh();
    }

    /// Follows the history to its present mesh. Results for another mesh are dropped.
    pub(super) fn follow_mesh(&mut self) {
        let Some(mesh) = self.history.mesh() else { return };
        if self.model().is_some_and(|model| Arc::ptr_eq(model, mesh)) {
            return;
        }
        self.jobs.open(Arc::clone(mesh));
        self.begin_mesh();
    }

    /// Forgets everything that belongs to another mesh.
    pub(super) fn begin_mesh(&mut self) {
        self.original = Arc::new(vec![DVec3::ZERO; self.document.paint.len()]);
        self.controls = ControlSelection::default();
        self.descent = None;
        self.mirroring = None;
        self.symmetry = Symmetry::None;
        self.both_sides = None;
        self.stitching = None;
        self.flow.reset();
        self.seen = *self.document.versions();
        self.shape_revision += 1;
        self.colours.change_all();
    }
}
