//! Symmetry: paint and poses on one side of a plane are repeated on the other side.
//!
//! The plane is the shape's own, or is normal to an axis of the world. A job finds it, and the pairs of vertices across
//! it, once for a file; a stroke only looks them up.

use std::sync::Arc;

use super::mirror::{mirror_plane, rest_bvh};
use super::state::Workspace;
use crate::jobs::{BothSides, Symmetry};

impl Workspace {
    /// Both sides, once they are found.
    pub(crate) fn both_sides(&self) -> Option<&Arc<BothSides>> {
        self.both_sides.as_ref()
    }

    /// The plane, found or still being searched for.
    pub(crate) fn symmetry(&self) -> Symmetry {
        self.symmetry
    }
}

/// Applies every action on both sides of a plane, once that is found, or on one side alone.
pub(crate) fn set_symmetry(workspace: &mut Workspace, symmetry: Symmetry) {
    if workspace.symmetry == symmetry {
        return;
    }
    workspace.jobs.stop_asking(|slots| &mut slots.symmetry);
    workspace.symmetry = Symmetry::None;
    workspace.both_sides = None;
    let Some(model) = workspace.model().cloned() else {
        return;
    };
    let given = match symmetry {
        Symmetry::None => return,
        Symmetry::Found => None,
        Symmetry::Axis(axis) => mirror_plane(workspace, axis),
    };
    let bvh = rest_bvh(workspace);
    workspace.symmetry = symmetry;
    let work = Box::new(move |progress: &_, cancel: &_| {
        Ok(BothSides::find(&model, bvh, given, progress, cancel)?.map(Arc::new))
    });
    workspace.jobs.ask(|slots| &mut slots.symmetry, work);
}

/// Stores the result.
pub(crate) fn take_symmetry(workspace: &mut Workspace) {
    let found = workspace.jobs.computed.slots.symmetry.take().flatten();
    if found.is_none() {
        workspace.symmetry = Symmetry::None;
        workspace.refuse("This shape has no plane of symmetry: choose an axis, or paint one side at a time.");
    }
    workspace.both_sides = found;
}
