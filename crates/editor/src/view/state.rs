//! The view: camera, viewport and look. A person chooses it, and it belongs to no document.

use glam::{DVec2, DVec3};

use super::camera::{Camera, NamedView, Orbit, Ray, UpAxis};
use super::camera_history::{CameraHistory, CameraStep};
use super::look::Look;
use crate::timeline::BodyMotion;

/// The camera, and the look of the surface.
#[derive(Debug)]
pub(crate) struct View {
    /// In the space of the shown body, which its path may have carried to another place of the world.
    camera: Camera,
    /// The same camera in the world.
    world: Camera,
    /// The motion of the body along its path; `None` until it is known.
    body: Option<BodyMotion>,
    history: CameraHistory,
    viewport_px: DVec2,
    /// Grows when camera or viewport changed.
    revision: u64,
    /// True if the camera has not been moved since everything was framed.
    is_framed: bool,
    orbit: Orbit,
    pub(crate) look: Look,
}

impl Default for View {
    fn default() -> Self {
        Self {
            camera: Camera::default(),
            world: Camera::default(),
            body: None,
            history: CameraHistory::default(),
            viewport_px: DVec2::new(1280.0, 800.0),
            revision: 0,
            is_framed: true,
            orbit: Orbit::default(),
            look: Look::default(),
        }
    }
}

impl View {
    pub(crate) fn camera(&self) -> &Camera {
        &self.camera
    }

    /// The ray through a point of the viewport in the world, where bodies are at the places to which their paths carry
    /// them.
    pub(crate) fn world_ray(&self, position_px: DVec2) -> Ray {
        self.world.ray(position_px, self.viewport_px)
    }

    /// The motion of the body along its path.
    pub(crate) fn body(&self) -> BodyMotion {
        self.body.unwrap_or(BodyMotion::STILL)
    }

    /// The camera in the world.
    pub(crate) fn world_camera(&self) -> &Camera {
        &self.world
    }

    /// Follows the body's motion along its path: the camera stays in the world. When the motion becomes known, the body
    /// is already in the picture, and the camera stays with it.
    pub(crate) fn follow_body(&mut self, body: Option<BodyMotion>) {
        if body == self.body {
            return;
        }
        let had = std::mem::replace(&mut self.body, body);
        if had.is_some() && body.is_some() {
            self.camera = self.world.carried(&BodyMotion::STILL, &self.body());
            self.revision += 1;
        } else {
            self.world = self.camera.carried(&self.body(), &BodyMotion::STILL);
        }
    }

    /// The view's size in points.
    pub(crate) fn viewport_px(&self) -> DVec2 {
        self.viewport_px
    }

    /// The effect of dragging.
    pub(crate) fn orbit(&self) -> Orbit {
        self.orbit
    }

    pub(crate) fn revision(&self) -> u64 {
        self.revision
    }

    /// Returns true if a change of the view's size frames everything again.
    pub(crate) fn is_framed(&self) -> bool {
        self.is_framed
    }

    /// The places in the camera's history.
    pub(crate) fn history(&self) -> &CameraHistory {
        &self.history
    }

    /// Sets the size; false if it is invalid, or the present one.
    pub(crate) fn resize(&mut self, size_px: DVec2) -> bool {
        let is_usable = size_px.is_finite() && size_px.x >= 1.0 && size_px.y >= 1.0;
        let is_other = is_usable && size_px != self.viewport_px;
        if is_other {
            self.viewport_px = size_px;
            self.revision += 1;
        }
        is_other
    }

    /// Changes the camera's projection without moving it.
    pub(crate) fn adjust(&mut self, change: impl FnOnce(&mut Camera)) {
        let before = self.camera;
        change(&mut self.camera);
        if self.camera != before {
            self.world = self.camera.carried(&self.body(), &BodyMotion::STILL);
            self.revision += 1;
        }
    }

    /// Moves the camera away from the framing of everything.
    pub(crate) fn travel(&mut self, change: impl FnOnce(&mut Camera)) {
        self.adjust(change);
        self.is_framed = false;
    }

    /// Chooses the effect of dragging; a turntable has a level horizon.
    pub(crate) fn set_orbit(&mut self, orbit: Orbit) {
        self.orbit = orbit;
        if orbit == Orbit::Turntable {
            self.adjust(|camera| camera.roll_rad = 0.0);
        }
    }

    /// Frames all of these points, which are everything: the camera frames them again when the view changes its size.
    pub(crate) fn frame_all(&mut self, positions: &[DVec3]) {
        let viewport_px = self.viewport_px;
        self.adjust(|camera| camera.frame(positions, viewport_px));
        self.is_framed = true;
    }

    /// Frames these points, with a margin of their own size on every side to show their surroundings.
    pub(crate) fn frame(&mut self, positions: &[DVec3]) {
        let viewport_px = self.viewport_px;
        self.travel(|camera| {
            camera.frame(positions, viewport_px);
            camera.distance *= 3.0;
        });
    }

    /// Looks from a side of the world.
    pub(crate) fn look_from(&mut self, side: NamedView) {
        let mut world = self.world;
        world.look_from(side);
        let camera = world.carried(&BodyMotion::STILL, &self.body());
        self.travel(|present| *present = camera);
    }

    /// Frames a point.
    pub(crate) fn approach(&mut self, point: DVec3) {
        self.travel(|camera| {
            camera.target = point;
            camera.distance = 0.15 * camera.scale;
        });
    }

    /// Begins a file of this size and up axis without a place to go back to.
    pub(crate) fn open(&mut self, scale: Option<f64>, up: UpAxis) {
        self.body = None;
        self.world = self.camera;
        self.adjust(|camera| {
            camera.up = up;
            camera.scale = scale.unwrap_or(camera.scale);
        });
        self.history = CameraHistory::default();
    }

    /// Goes back to an earlier view, or forth again.
    pub(crate) fn step(&mut self, step: CameraStep) {
        if let Some(camera) = self.history.step(step, self.world) {
            let camera = camera.carried(&BodyMotion::STILL, &self.body());
            self.travel(|present| *present = camera);
        }
    }

    /// Notes that no gesture moves the camera.
    pub(crate) fn rest(&mut self) {
        self.history.rest(self.world);
    }
}
