//! A camera prepared for millions of points: its axes and lengths, computed once.

use glam::{DMat3, DVec2, DVec3};

use super::camera::{Camera, Projection};

/// A camera's projection of points in a viewport.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Sight {
    view_from_world: DMat3,
    eye: DVec3,
    /// The common depth of all points, for a view in which distance does not matter.
    fixed_depth: Option<f64>,
    focal_px: f64,
    middle_px: DVec2,
}

impl Sight {
    pub(crate) fn of(camera: &Camera, viewport_px: DVec2) -> Self {
        Self {
            view_from_world: camera.axes().transpose(),
            eye: camera.eye(),
            fixed_depth: match camera.projection {
                Projection::Perspective => None,
                Projection::Orthographic => Some(camera.distance),
            },
            focal_px: camera.focal_px(viewport_px),
            middle_px: 0.5 * viewport_px,
        }
    }

    /// The place of a world point in the viewport; `None` behind the eye.
    pub(crate) fn project(&self, world: DVec3) -> Option<DVec2> {
        let in_view = self.view_from_world * (world - self.eye);
        let depth = self.fixed_depth.unwrap_or(-in_view.z);
        if depth <= 0.0 {
            return None;
        }
        let offset = in_view.truncate() * (self.focal_px / depth);
        Some(self.middle_px + DVec2::new(offset.x, -offset.y))
    }

    /// The direction from a point towards the eye, of any length.
    pub(crate) fn towards_eye(&self, world: DVec3) -> DVec3 {
        match self.fixed_depth {
            None => self.eye - world,
            Some(_) => self.view_from_world.row(2),
        }
    }
}

impl Camera {
    /// The place of a world point in the viewport; `None` behind the eye.
    pub fn project(&self, world: DVec3, viewport_px: DVec2) -> Option<DVec2> {
        Sight::of(self, viewport_px).project(world)
    }
}
