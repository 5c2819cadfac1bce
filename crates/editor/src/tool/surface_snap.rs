//! An appended part that is moved onto the surface under the pointer: it stands there on its lowest point, upright on
//! the triangle.

use std::collections::BTreeSet;

use glam::{DQuat, DVec2, DVec3};

use crate::document::{Handle, HandleTransform};
use crate::view::{Pick, Ray, View};
use crate::workspace::{Workspace, held_parts, members};

/// At most this many of its own triangles are looked through.
const MOST_OWN: usize = 64;

/// A part that its handle holds whole, at the beginning of its move.
#[derive(Debug)]
pub(super) struct SurfaceSnap {
    /// The connected parts that move, by their numbers.
    own: BTreeSet<u32>,
    /// The position of the handle's pivot.
    centre: DVec3,
    /// The way from there to the foot: down to the part's lowest point along its own up axis.
    to_foot: DVec3,
    /// The part's own up axis, as it is turned now.
    up: DVec3,
}

/// The motion of a part onto the surface: a turn about its pivot, then a translation.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(super) struct Landing {
    /// It turns the part's up axis to the surface's normal.
    pub turn: DQuat,
    /// It takes the foot of the turned part to the point under the pointer.
    pub way: DVec3,
}

impl Landing {
    /// A translation alone.
    pub(super) fn without_turn(way: DVec3) -> Self {
        Self {
            turn: DQuat::IDENTITY,
            way,
        }
    }
}

impl SurfaceSnap {
    /// `None` if the handle, which is the selected one, holds no whole part. `up` is the file's up axis.
    pub(super) fn of(workspace: &Workspace, handle: &Handle, up: DVec3) -> Option<Self> {
        let own = held_parts(workspace);
        if own.is_empty() {
            return None;
        }
        let rotation = match handle.transform {
            HandleTransform::Trs { rotation, .. } => rotation,
            HandleTransform::Matrix(_) => DQuat::IDENTITY,
        };
        let (centre, up) = (handle.centre(), (rotation * up).normalize());
        let vertices = members(&workspace.document, handle.id).into_iter();
        let heights = vertices.map(|vertex| (workspace.position(vertex) - centre).dot(up));
        let lowest = heights.fold(f64::INFINITY, f64::min);
        lowest.is_finite().then_some(Self {
            own,
            centre,
            to_foot: lowest * up,
            up,
        })
    }

    /// The motion onto the other surface that is first under a point of the view; `None` if there is none.
    pub(super) fn landing(&self, workspace: &Workspace, view: &View, position_px: DVec2) -> Option<Landing> {
        let pick = self.pick(workspace, view, position_px)?;
        let turn = DQuat::from_rotation_arc(self.up, pick.normal);
        Some(Landing {
            turn,
            way: pick.point - self.centre - turn * self.to_foot,
        })
    }

    /// The first point under the pointer that is not on the part itself.
    fn pick(&self, workspace: &Workspace, view: &View, position_px: DVec2) -> Option<Pick> {
        let picking = workspace.picking(view)?;
        let mut ray = picking.camera.ray(position_px, picking.viewport_px);
        for _ in 0..MOST_OWN {
            let pick = picking.along(ray)?;
            if !self.own.contains(&picking.model.topology.component(pick.vertex)) {
                return Some(pick);
            }
            // The hierarchy may still have the part where it was, so its own distance counts.
            let hit = picking.bvh.ray(ray.origin, ray.direction)?;
            let beyond = hit.distance * (1.0 + 1e-9) + 1e-9 * picking.camera.distance;
            ray = Ray {
                origin: ray.origin + beyond * ray.direction,
                ..ray
            };
        }
        None
    }
}
