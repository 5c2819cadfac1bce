//! The control points that the surface hides: of two near the pointer the visible one is taken.

use glam::DVec3;

use crate::view::View;
use crate::workspace::Workspace;

/// The control points that the surface hides, stored because each takes a ray.
#[derive(Debug, Default)]
pub(super) struct HiddenPoints {
    seen_from: Option<(u64, u64, bool)>,
    positions: Vec<DVec3>,
    are_hidden: Vec<bool>,
}

impl HiddenPoints {
    /// For each point, true if it is hidden.
    pub(super) fn are_hidden(&self) -> &[bool] {
        &self.are_hidden
    }

    /// Tests again if positions, view or surface have changed.
    pub(super) fn look(&mut self, positions: &[DVec3], workspace: &Workspace, view: &View) {
        let is_current = workspace.jobs.is_picking_current();
        let seen_from = Some((view.revision(), workspace.shape_revision(), is_current));
        if self.seen_from == seen_from && self.positions == positions {
            return;
        }
        let picking = workspace.picking(view);
        let camera = view.camera();
        let is_hidden = |position: &DVec3| {
            let px = camera.project(*position, view.viewport_px())?;
            let ray = camera.ray(px, view.viewport_px());
            let hit = picking.as_ref()?.along(ray)?;
            let depth = |point: DVec3| (point - ray.origin).dot(ray.direction);
            Some(depth(hit.point) < depth(*position) * (1.0 - 1e-6))
        };
        self.are_hidden.clear();
        self.are_hidden
            .extend(positions.iter().map(|position| is_hidden(position).unwrap_or(false)));
        self.positions = positions.to_vec();
        self.seen_from = seen_from;
    }
}
