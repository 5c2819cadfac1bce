//! The camera: its eye circles a target, in f64, so that it also works at geographic coordinates.
//!
//! View space looks along −z with x to the right and y up. Clip space has x and y in −1..1, y up, and reversed depth:
//! 1 at the near plane and 0 infinitely far away, which spreads f32 depth evenly over any distance.

use std::f64::consts::{FRAC_PI_2, FRAC_PI_4, PI};

use glam::{DMat3, DMat4, DVec2, DVec3, DVec4};

/// The axis of the world that points up on the screen.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default, Hash)]
pub enum UpAxis {
    /// Up in glTF.
    #[default]
    Y,
    /// Up in most scans and in CAD.
    Z,
}

impl UpAxis {
    /// The unit vector up.
    pub(crate) fn vector(self) -> DVec3 {
        match self {
            Self::Y => DVec3::Y,
            Self::Z => DVec3::Z,
        }
    }
}

/// A side to look from.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Hash)]
pub enum NamedView {
    /// From the front: along −z if y is up, along +y if z is up.
    Front,
    /// From behind.
    Back,
    /// From the left of the target, that is from −x.
    Left,
    /// From +x.
    Right,
    /// From above.
    Top,
    /// From below.
    Bottom,
    /// From the front, the right and above.
    ThreeQuarter,
}

impl NamedView {
    /// Every view with the name that the command line uses.
    pub const NAMES: [(&'static str, Self); 7] = [
        ("front", Self::Front),
        ("back", Self::Back),
        ("left", Self::Left),
        ("right", Self::Right),
        ("top", Self::Top),
        ("bottom", Self::Bottom),
        ("three-quarter", Self::ThreeQuarter),
    ];

    /// Yaw and pitch in radians.
    pub(super) fn angles_rad(self) -> (f64, f64) {
        match self {
            Self::Front => (0.0, 0.0),
            Self::Back => (PI, 0.0),
            Self::Left => (-FRAC_PI_2, 0.0),
            Self::Right => (FRAC_PI_2, 0.0),
            Self::Top => (0.0, FRAC_PI_2),
            Self::Bottom => (0.0, -FRAC_PI_2),
            Self::ThreeQuarter => (0.6, 0.35),
        }
    }
}

/// The appearance of depth.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default, Hash)]
pub enum Projection {
    /// Distant objects look smaller.
    #[default]
    Perspective,
    /// They do not, for comparing lengths. Objects at the target's depth have the size that they have in perspective.
    Orthographic,
}

/// The effect of dragging the view.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default, Hash)]
pub enum Orbit {
    /// It turns about the up axis and tips; the horizon stays level.
    #[default]
    Turntable,
    /// It rolls like a ball under the pointer.
    Trackball,
}

/// An eye that circles a target.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Camera {
    /// The target, in world space.
    pub target: DVec3,
    /// From the eye to the target, in world units, positive.
    pub distance: f64,
    /// Turn about the up axis; 0 looks from the front, growing towards the right-hand side.
    pub yaw_rad: f64,
    /// Height above the horizon, −π/2 to π/2.
    pub pitch_rad: f64,
    /// Turn about the line of sight; 0 keeps the horizon level, growing turns the picture clockwise.
    pub roll_rad: f64,
    /// The angle of the view's height; an orthographic view shows the same height at the target's depth.
    pub fov_y_rad: f64,
    /// The appearance of depth.
    pub projection: Projection,
    /// The axis of the world that points up on the screen.
    pub up: UpAxis,
    /// The size of the last framed object, in world units: bounds zooming.
    pub scale: f64,
}

impl Default for Camera {
    fn default() -> Self {
        let (yaw_rad, pitch_rad) = NamedView::ThreeQuarter.angles_rad();
        Self {
            target: DVec3::ZERO,
            distance: 3.0,
            yaw_rad,
            pitch_rad,
            roll_rad: 0.0,
            fov_y_rad: FRAC_PI_4 * 0.9,
            projection: Projection::Perspective,
            up: UpAxis::Y,
            scale: 1.0,
        }
    }
}

/// A half line in world space.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Ray {
    /// Its origin.
    pub origin: DVec3,
    /// A unit vector.
    pub direction: DVec3,
}

impl Camera {
    /// Returns true if it is a valid view: everything finite, distances above zero.
    pub(crate) fn is_usable(&self) -> bool {
        self.target.is_finite()
            && [self.yaw_rad, self.pitch_rad, self.roll_rad]
                .iter()
                .all(|angle| angle.is_finite())
            && [self.distance, self.scale]
                .iter()
                .all(|length| length.is_finite() && *length > 0.0)
            && self.fov_y_rad > 0.0
            && self.fov_y_rad < PI
    }

    /// World from view: its columns are the view's right, up and backward axes and the eye.
    pub fn world_from_view(&self) -> DMat4 {
        let axes = self.axes();
        let eye = self.eye();
        DMat4::from_cols(
            axes.x_axis.extend(0.0),
            axes.y_axis.extend(0.0),
            axes.z_axis.extend(0.0),
            eye.extend(1.0),
        )
    }

    /// View from world.
    pub fn view_from_world(&self) -> DMat4 {
        let view_from_world = self.axes().transpose();
        let shift = view_from_world * -self.eye();
        DMat4::from_cols(
            view_from_world.x_axis.extend(0.0),
            view_from_world.y_axis.extend(0.0),
            view_from_world.z_axis.extend(0.0),
            shift.extend(1.0),
        )
    }

    /// Clip from view for a viewport of this size: reversed depth; infinitely far in perspective, else a generous
    /// distance before and behind the target.
    pub fn clip_from_view(&self, viewport_px: DVec2) -> DMat4 {
        let focal = 1.0 / (0.5 * self.fov_y_rad).tan();
        let aspect = viewport_px.x / viewport_px.y;
        match self.projection {
            Projection::Perspective => DMat4::from_cols(
                DVec4::new(focal / aspect, 0.0, 0.0, 0.0),
                DVec4::new(0.0, focal, 0.0, 0.0),
                DVec4::new(0.0, 0.0, 0.0, -1.0),
                DVec4::new(0.0, 0.0, self.near(), 0.0),
            ),
            Projection::Orthographic => {
                let scale = focal / self.distance;
                let depth_scale = 0.5 / self.reach();
                DMat4::from_cols(
                    DVec4::new(scale / aspect, 0.0, 0.0, 0.0),
                    DVec4::new(0.0, scale, 0.0, 0.0),
                    DVec4::new(0.0, 0.0, depth_scale, 0.0),
                    DVec4::new(0.0, 0.0, (self.distance + self.reach()) * depth_scale, 1.0),
                )
            }
        }
    }

    /// Clip from world for a viewport of this size. For GPU positions relative to a centre, multiply by the
    /// translation to that centre before rounding to f32.
    pub fn clip_from_world(&self, viewport_px: DVec2) -> DMat4 {
        self.clip_from_view(viewport_px) * self.view_from_world()
    }

    /// The distance of the near plane.
    pub fn near(&self) -> f64 {
        (self.distance * 1e-3).max(self.scale * 1e-6)
    }

    /// The range before and behind the target that an orthographic view shows.
    fn reach(&self) -> f64 {
        1.5 * self.scale + 3.0 * self.distance * (0.5 * self.fov_y_rad).tan()
    }

    /// The eye's position, in world space.
    pub fn eye(&self) -> DVec3 {
        self.target + self.axes().z_axis * self.distance
    }

    /// The direction in which the eye looks, a unit vector.
    pub fn forward(&self) -> DVec3 {
        -self.axes().z_axis
    }

    /// The unit vector towards the eye from a point of the world.
    pub fn towards_eye(&self, world: DVec3) -> DVec3 {
        let backward = self.axes().z_axis;
        match self.projection {
            Projection::Perspective => (self.eye() - world).normalize_or(backward),
            Projection::Orthographic => backward,
        }
    }

    /// The view's right, up and backward axes in world space, as columns: a rotation.
    pub fn axes(&self) -> DMat3 {
        let level = self.level_axes();
        let (sin, cos) = self.roll_rad.sin_cos();
        DMat3::from_cols(
            level.x_axis * cos + level.y_axis * sin,
            level.y_axis * cos - level.x_axis * sin,
            level.z_axis,
        )
    }

    /// The axes without roll.
    pub(super) fn level_axes(&self) -> DMat3 {
        let (sin_yaw, cos_yaw) = self.yaw_rad.sin_cos();
        let (sin_pitch, cos_pitch) = self.pitch_rad.sin_cos();
        // With y up: the eye is at (sin yaw cos pitch, sin pitch, cos yaw cos pitch) from the target.
        let right = DVec3::new(cos_yaw, 0.0, -sin_yaw);
        let backward = DVec3::new(sin_yaw * cos_pitch, sin_pitch, cos_yaw * cos_pitch);
        let up = backward.cross(right);
        let axes = DMat3::from_cols(right, up, backward);
        match self.up {
            UpAxis::Y => axes,
            // (x, y, z) with y up becomes (x, −z, y) with z up.
            UpAxis::Z => {
                let turn = |v: DVec3| DVec3::new(v.x, -v.z, v.y);
                DMat3::from_cols(turn(axes.x_axis), turn(axes.y_axis), turn(axes.z_axis))
            }
        }
    }

    /// The ray through a point of the viewport.
    pub fn ray(&self, position_px: DVec2, viewport_px: DVec2) -> Ray {
        let offset = DVec2::new(position_px.x - 0.5 * viewport_px.x, 0.5 * viewport_px.y - position_px.y);
        let slope = offset / self.focal_px(viewport_px);
        let axes = self.axes();
        match self.projection {
            Projection::Perspective => Ray {
                origin: self.eye(),
                direction: axes * slope.extend(-1.0).normalize(),
            },
            Projection::Orthographic => Ray {
                origin: self.target + axes * (slope * self.distance).extend(self.reach()),
                direction: -axes.z_axis,
            },
        }
    }

    /// World units that one point of the screen spans at the depth of `world` (never below that of the near plane).
    pub fn world_per_px(&self, world: DVec3, viewport_px: DVec2) -> f64 {
        let depth = match self.projection {
            Projection::Perspective => (world - self.eye()).dot(self.forward()).max(self.near()),
            Projection::Orthographic => self.distance,
        };
        depth / self.focal_px(viewport_px)
    }

    /// Points of the screen per unit of view-space slope.
    pub(crate) fn focal_px(&self, viewport_px: DVec2) -> f64 {
        0.5 * viewport_px.y / (0.5 * self.fov_y_rad).tan()
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test that can't go on fails")]
pub(super) mod tests {
    use glam::{DVec2, DVec3};

    use super::{Camera, NamedView, Projection, UpAxis};

    pub(in crate::view) const VIEWPORT_PX: DVec2 = DVec2::new(800.0, 500.0);

    pub(in crate::view) fn cameras() -> Vec<Camera> {
        let mut cameras = Vec::new();
        let kinds =
            [UpAxis::Y, UpAxis::Z].map(|up| [Projection::Perspective, Projection::Orthographic].map(|p| (up, p)));
        for (up, projection) in kinds.into_iter().flatten() {
            for (number, (_, view)) in NamedView::NAMES.into_iter().enumerate() {
                let mut camera = Camera {
                    up,
                    projection,
                    target: DVec3::new(5e5, -3.0, 4e6),
                    ..Camera::default()
                };
                camera.look_from(view);
                camera.roll_rad = 0.3 * number as f64;
                cameras.push(camera);
            }
        }
        cameras
    }

    #[test]
    fn a_projected_point_lies_on_its_ray() {
        for camera in cameras() {
            let world = camera.target + DVec3::new(0.3, -0.2, 0.4);
            let pixel = camera.project(world, VIEWPORT_PX).unwrap();
            let ray = camera.ray(pixel, VIEWPORT_PX);
            let off = (world - ray.origin).cross(ray.direction).length();
            assert!(off < 1e-8, "{off}");
        }
    }

    #[test]
    fn clip_space_agrees_with_projection_and_depth_is_reversed() {
        for camera in cameras() {
            let near = camera.target + DVec3::new(0.1, 0.1, 0.1);
            // It is also within the range of an orthographic view.
            let far = near + camera.forward() * 2.0;
            let [near_clip, far_clip] = [near, far].map(|p| {
                let clip = camera.clip_from_world(VIEWPORT_PX) * p.extend(1.0);
                clip.truncate() / clip.w
            });
            let pixel = camera.project(near, VIEWPORT_PX).unwrap();
            let expected = DVec2::new(pixel.x / 400.0 - 1.0, 1.0 - pixel.y / 250.0);
            assert!(near_clip.truncate().distance(expected) < 1e-6);
            assert!(1.0 > near_clip.z && near_clip.z > far_clip.z && far_clip.z > 0.0);
        }
    }

    #[test]
    fn both_projections_agree_at_the_targets_depth() {
        for camera in cameras() {
            let other = match camera.projection {
                Projection::Perspective => Projection::Orthographic,
                Projection::Orthographic => Projection::Perspective,
            };
            let flat = Camera {
                projection: other,
                ..camera
            };
            let axes = camera.axes();
            let world = camera.target + axes.x_axis * 0.4 - axes.y_axis * 0.3;
            let [a, b] = [camera, flat].map(|camera| camera.project(world, VIEWPORT_PX).unwrap());
            assert!(a.distance(b) < 1e-5, "{a} {b}");
        }
    }
}
