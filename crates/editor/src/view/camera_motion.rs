//! The camera's motion: it orbits, pans and zooms, frames objects, and looks from named sides.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use glam::{DMat3, DQuat, DVec2, DVec3};

use super::{Camera, NamedView, Orbit, Projection, UpAxis};
use crate::timeline::BodyMotion;

/// The limit of the turntable's tip up and down: the poles themselves.
const MAX_PITCH_RAD: f64 = FRAC_PI_2;
/// The turn of the eye per point of dragging.
const ORBIT_RAD_PER_PX: f64 = 0.007;
/// The zoom of one notch of the wheel.
const ZOOM_PER_LINE: f64 = 1.15;

/// The size of the picture relative to the framed object.
const FRAME_MARGIN: f64 = 1.15;

/// The number of vertices that determine the middle of a picture.
const FRAME_SAMPLE: usize = 20_000;

impl Camera {
    /// Circles the target as the pointer moves by `delta_px`.
    pub fn orbit(&mut self, orbit: Orbit, delta_px: DVec2) {
        match orbit {
            Orbit::Turntable => self.turn(delta_px * ORBIT_RAD_PER_PX),
            Orbit::Trackball => self.roll_ball(delta_px * ORBIT_RAD_PER_PX),
        }
    }

    /// Turns the table to the right and tips it down, by radians, and levels the horizon.
    pub fn turn(&mut self, angles_rad: DVec2) {
        self.roll_rad = 0.0;
        self.yaw_rad = (self.yaw_rad - angles_rad.x).rem_euclid(TAU);
        self.pitch_rad = (self.pitch_rad + angles_rad.y).clamp(-MAX_PITCH_RAD, MAX_PITCH_RAD);
    }

    /// Turns about the view's own axes, by radians, without keeping up.
    fn roll_ball(&mut self, angles_rad: DVec2) {
        let turn = DQuat::from_scaled_axis(DVec3::new(-angles_rad.y, -angles_rad.x, 0.0));
        self.set_axes(self.axes() * DMat3::from_quat(turn));
    }

    /// Looks along other axes from the same distance to the target.
    fn set_axes(&mut self, turned: DMat3) {
        let backward = match self.up {
            UpAxis::Y => turned.z_axis,
            UpAxis::Z => DVec3::new(turned.z_axis.x, turned.z_axis.z, -turned.z_axis.y),
        };
        self.pitch_rad = backward.y.clamp(-1.0, 1.0).asin();
        self.yaw_rad = backward.x.atan2(backward.z).rem_euclid(TAU);
        let level = self.level_axes();
        self.roll_rad = turned.x_axis.dot(level.y_axis).atan2(turned.x_axis.dot(level.x_axis));
    }

    /// The camera that sees a body after its motion `to` as this one sees it after its motion `from`.
    pub(super) fn carried(&self, from: &BodyMotion, to: &BodyMotion) -> Self {
        let mut camera = Self {
            target: to.before(from.moved(self.target)),
            ..*self
        };
        let turn = (to.turn().inverse() * from.turn()).normalize();
        let up = self.up.vector();
        if turn.xyz() == DVec3::ZERO {
            return camera;
        }
        match turn.xyz().cross(up) == DVec3::ZERO {
            true => {
                let angle = 2.0 * turn.xyz().dot(up).atan2(turn.w);
                camera.yaw_rad = (self.yaw_rad + angle).rem_euclid(TAU);
            }
            false => camera.set_axes(DMat3::from_quat(turn) * self.axes()),
        }
        camera
    }

    /// Looks from the opposite side.
    pub fn turn_around(&mut self) {
        self.yaw_rad = (self.yaw_rad + PI).rem_euclid(TAU);
        self.pitch_rad = -self.pitch_rad;
        self.roll_rad = -self.roll_rad;
    }

    /// Moves eye and target across the view, so that points at `anchor`'s depth stay under the pointer.
    pub fn pan(&mut self, delta_px: DVec2, anchor: DVec3, viewport_px: DVec2) {
        let axes = self.axes();
        let scale = self.world_per_px(anchor, viewport_px);
        self.target += (axes.y_axis * delta_px.y - axes.x_axis * delta_px.x) * scale;
    }

    /// Comes closer by `factor` (above 1) or backs away, with `anchor` staying at its place on the screen.
    pub fn zoom(&mut self, factor: f64, anchor: DVec3) {
        let wanted = self.distance / factor;
        let distance = wanted.clamp(self.scale * 1e-4, self.scale * 1e3);
        let shrink = distance / self.distance;
        self.target = anchor + (self.target - anchor) * shrink;
        self.distance = distance;
    }

    /// Zooms by wheel notches.
    pub fn zoom_lines(&mut self, lines: f64, anchor: DVec3) {
        self.zoom(ZOOM_PER_LINE.powf(lines.clamp(-20.0, 20.0)), anchor);
    }

    /// Looks at all of `positions` from the present side, as close as they allow, with a margin; nothing happens if
    /// there are none. A single place is shown at the scale of the last framing.
    pub fn frame(&mut self, positions: &[DVec3], viewport_px: DVec2) {
        let view_from_world = self.axes().transpose();
        let Some(first) = positions.first() else { return };
        // Positions are relative to one of them, so that no digits are lost at geographic coordinates.
        let seen = |position: &DVec3| view_from_world * (*position - *first);
        let (least, most) = positions
            .iter()
            .map(seen)
            .fold((DVec3::MAX, DVec3::MIN), |(least, most), position| {
                (least.min(position), most.max(position))
            });
        let size = (most - least).length();
        if !size.is_finite() {
            return;
        }
        let mut centre = 0.5 * (least + most);
        let slope_y = (0.5 * self.fov_y_rad).tan() / FRAME_MARGIN;
        let slope_x = slope_y * viewport_px.x / viewport_px.y;
        let least = if size > 0.0 { 1e-3 * size } else { self.scale };
        // Without perspective near objects do not look larger.
        let nearness = match self.projection {
            Projection::Perspective => 1.0,
            Projection::Orthographic => 0.0,
        };
        let distance = |centre: DVec3, stride: usize| {
            let nearest = positions.iter().step_by(stride).map(|position| {
                // It is `distance − seen.z` before the eye, which must see it within the slopes.
                let seen = seen(position) - centre;
                nearness * seen.z + (seen.x.abs() / slope_x).max(seen.y.abs() / slope_y)
            });
            nearest.fold(least, f64::max)
        };
        // Near parts look larger: their share of the picture moves the middle. A sample measures the shift.
        let stride = positions.len() / FRAME_SAMPLE + 1;
        for _ in 0..3 {
            let from_eye = distance(centre, stride);
            let slopes = positions.iter().step_by(stride).map(|position| {
                let seen = seen(position) - centre;
                seen.truncate() / (from_eye - nearness * seen.z).max(1e-9 * from_eye)
            });
            let (low, high) = slopes.fold((DVec2::MAX, DVec2::MIN), |(low, high), slope| {
                (low.min(slope), high.max(slope))
            });
            centre += (0.5 * from_eye * (low + high)).extend(0.0);
        }
        self.target = *first + view_from_world.transpose() * centre;
        self.distance = distance(centre, 1);
    }

    /// Looks from a named side.
    pub fn look_from(&mut self, view: NamedView) {
        (self.yaw_rad, self.pitch_rad) = view.angles_rad();
        self.roll_rad = 0.0;
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test that can't go on fails")]
mod tests {
    use glam::{DVec2, DVec3};

    use super::super::camera::tests::{VIEWPORT_PX, cameras};
    use super::super::camera::{Camera, NamedView, Orbit, UpAxis};

    #[test]
    fn zoom_keeps_the_anchor_where_it_appears() {
        for mut camera in cameras() {
            let anchor = camera.target + DVec3::new(0.2, 0.3, -0.1);
            let before = camera.project(anchor, VIEWPORT_PX).unwrap();
            camera.zoom_lines(3.0, anchor);
            let after = camera.project(anchor, VIEWPORT_PX).unwrap();
            assert!(before.distance(after) < 1e-5);
        }
    }

    #[test]
    fn pan_keeps_the_anchor_under_the_pointer() {
        for mut camera in cameras() {
            let anchor = camera.target;
            let before = camera.project(anchor, VIEWPORT_PX).unwrap();
            let delta_px = DVec2::new(40.0, -25.0);
            camera.pan(delta_px, anchor, VIEWPORT_PX);
            assert!(camera.project(anchor, VIEWPORT_PX).unwrap().distance(before + delta_px) < 1e-5);
        }
    }

    #[test]
    fn framing_shows_everything_as_large_as_it_can_be() {
        let positions = [
            DVec3::new(-1.0, 7.0, -3.0),
            DVec3::new(2.0, 9.0, 40.0),
            DVec3::new(1.0, 8.5, 10.0),
            DVec3::new(0.0, 5.0, 2.0),
        ];
        for far in [DVec3::ZERO, DVec3::new(4.0e6, -3.0e6, 100.0)] {
            let positions = positions.map(|position| position + far);
            for mut camera in cameras() {
                for viewport_px in [VIEWPORT_PX, DVec2::new(300.0, 900.0)] {
                    camera.frame(&positions, viewport_px);
                    let fills = positions.iter().map(|&position| {
                        let pixel = camera.project(position, viewport_px).unwrap();
                        (2.0 * pixel / viewport_px - 1.0).abs().max_element()
                    });
                    let fills = fills.fold(0.0, f64::max);
                    assert!(fills < 1.0 && fills > 0.8, "{fills}");
                }
            }
        }
    }

    #[test]
    fn a_ball_rolls_about_the_views_own_axes_from_anywhere() {
        for mut camera in cameras() {
            let before = camera.axes();
            camera.orbit(Orbit::Trackball, DVec2::new(30.0, 0.0));
            let after = camera.axes();
            assert!(
                after.y_axis.distance(before.y_axis) < 1e-9,
                "sideways it turns about what is up on the screen"
            );
            assert!((after.z_axis.dot(before.z_axis) - (30.0 * super::ORBIT_RAD_PER_PX).cos()).abs() < 1e-9);
            camera.orbit(Orbit::Trackball, DVec2::new(-30.0, 0.0));
            camera.orbit(Orbit::Trackball, DVec2::new(0.0, 400.0));
            assert!(
                camera.axes().x_axis.distance(before.x_axis) < 1e-9,
                "over the pole and on"
            );
            camera.orbit(Orbit::Trackball, DVec2::new(0.0, -400.0));
            for axis in 0..3 {
                assert!(camera.axes().col(axis).distance(before.col(axis)) < 1e-9);
            }
            camera.turn_around();
            assert!(camera.forward().distance(before.z_axis) < 1e-9);
        }
    }

    #[test]
    fn named_views_look_along_their_axis() {
        let mut camera = Camera::default();
        camera.look_from(NamedView::Front);
        assert!(camera.forward().distance(DVec3::NEG_Z) < 1e-12);
        camera.look_from(NamedView::Right);
        assert!(camera.forward().distance(DVec3::NEG_X) < 1e-12);
        camera.up = UpAxis::Z;
        camera.look_from(NamedView::Front);
        assert!(camera.forward().distance(DVec3::Y) < 1e-12);
        assert!(camera.axes().y_axis.distance(DVec3::Z) < 1e-12);
    }
}
