//! The drawn shape and the view of it, as data of a job.

use std::sync::Arc;

use glam::{DVec2, DVec3};
use pliant_mesh::Model;

use crate::pickable::Pickable;
use crate::view::{Camera, Picking, View};
use crate::workspace::Workspace;

/// Everything that rays from the view need, at one moment.
pub(super) struct DrawnShape {
    pub(super) model: Arc<Model>,
    displacements: Arc<Vec<DVec3>>,
    pickable: Pickable,
    camera: Camera,
    viewport_px: DVec2,
    is_current: bool,
}

impl DrawnShape {
    /// The present one; `None` while its hierarchy is not ready.
    pub(super) fn of(workspace: &Workspace, view: &View) -> Option<Self> {
        Some(Self {
            model: Arc::clone(workspace.model()?),
            displacements: Arc::clone(workspace.document.from_file()),
            pickable: workspace.computed().pickable().cloned()?,
            camera: *view.camera(),
            viewport_px: view.viewport_px(),
            is_current: workspace.jobs.is_picking_current(),
        })
    }

    /// Rays from the view.
    pub(super) fn picking(&self) -> Picking<'_> {
        Picking::of(
            &self.model,
            &self.displacements,
            &self.pickable,
            (&self.camera, self.viewport_px),
            self.is_current,
        )
    }
}
