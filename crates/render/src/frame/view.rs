//! The point of view: two matrices and the eye, from any camera.

use glam::{Mat4, Vec3, Vec4, Vec4Swizzles};

/// A point of view. World space is relative to the caller's f64 centre; matrices multiply column vectors.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct View {
    /// Clip space (x right, y up, depth reversed: z/w is 1 at the near plane and 0 far away) from world.
    pub clip_from_world: Mat4,
    /// View space (x right, y up, the eye looks down −z; rigid, no scale) from world.
    pub view_from_world: Mat4,
    /// The eye in world space: (position, 1) in perspective, (direction towards the eye, 0) in an orthographic view.
    pub eye: Vec4,
}

impl View {
    /// A view from a projection and a camera. Detects whether the projection is a perspective one.
    ///
    /// `clip_from_view` must reverse depth (see [`View::clip_from_world`]), as [`View::perspective`] and
    /// [`View::orthographic`] do.
    pub fn new(clip_from_view: Mat4, view_from_world: Mat4) -> Self {
        let world_from_view = view_from_world.inverse();
        let is_perspective = clip_from_view.row(3).xyz() != Vec3::ZERO;
        let eye = if is_perspective {
            world_from_view * Vec4::W
        } else {
            world_from_view * Vec4::Z
        };
        Self {
            clip_from_world: clip_from_view * view_from_world,
            view_from_world,
            eye,
        }
    }

    /// A perspective view without a far plane. `fov_y_rad` is the full vertical field of view, `aspect` is width over
    /// height, and `near` is the distance of the near plane (more than zero; about a thousandth of the scene's size).
    pub fn perspective(fov_y_rad: f32, aspect: f32, near: f32, view_from_world: Mat4) -> Self {
        let y_scale = 1.0 / (0.5 * fov_y_rad).tan();
        let clip_from_view = Mat4::from_cols(
            Vec4::new(y_scale / aspect, 0.0, 0.0, 0.0),
            Vec4::new(0.0, y_scale, 0.0, 0.0),
            Vec4::new(0.0, 0.0, 0.0, -1.0),
            Vec4::new(0.0, 0.0, near, 0.0),
        );
        Self::new(clip_from_view, view_from_world)
    }

    /// An orthographic view that shows `half_height` world units above and below the centre, from `near` to `far` in
    /// front of the eye (`near` may be negative; `far` must be larger).
    pub fn orthographic(half_height: f32, aspect: f32, near: f32, far: f32, view_from_world: Mat4) -> Self {
        let depth_scale = 1.0 / (far - near);
        let clip_from_view = Mat4::from_cols(
            Vec4::new(1.0 / (half_height * aspect), 0.0, 0.0, 0.0),
            Vec4::new(0.0, 1.0 / half_height, 0.0, 0.0),
            Vec4::new(0.0, 0.0, depth_scale, 0.0),
            Vec4::new(0.0, 0.0, far * depth_scale, 1.0),
        );
        Self::new(clip_from_view, view_from_world)
    }

    /// View space from world for an eye at `eye` that looks at `target`, with `up` (not parallel to the view direction)
    /// pointing up in the picture.
    pub fn look_at(eye: Vec3, target: Vec3, up: Vec3) -> Mat4 {
        let back = (eye - target).normalize();
        let right = up.cross(back).normalize();
        let up = back.cross(right);
        let world_from_view = Mat4::from_cols(right.extend(0.0), up.extend(0.0), back.extend(0.0), eye.extend(1.0));
        world_from_view.inverse()
    }

    /// Returns true if the view is a perspective one.
    pub fn is_perspective(&self) -> bool {
        self.eye.w != 0.0
    }

    /// The view of one tile: the part of size `tile_px` at `origin_px` from the upper left corner of a picture of
    /// `size_px`.
    pub fn tile(&self, size_px: [u32; 2], origin_px: [u32; 2], tile_px: [u32; 2]) -> Self {
        let share = |axis: usize| size_px[axis] as f32 / tile_px[axis] as f32;
        let middle = |axis: usize| (2.0 * origin_px[axis] as f32 + tile_px[axis] as f32) / size_px[axis] as f32 - 1.0;
        let (x_scale, y_scale) = (share(0), share(1));
        let tile_from_clip = Mat4::from_cols(
            Vec4::new(x_scale, 0.0, 0.0, 0.0),
            Vec4::new(0.0, y_scale, 0.0, 0.0),
            Vec4::Z,
            Vec4::new(-middle(0) * x_scale, middle(1) * y_scale, 0.0, 1.0),
        );
        Self {
            clip_from_world: tile_from_clip * self.clip_from_world,
            ..*self
        }
    }

    /// Projects a point in world space: pixels from the upper left corner of a picture of `size_px`, and depth (1 near,
    /// 0 far). `None` behind the eye.
    pub fn pixel_from_world(&self, position: Vec3, size_px: [u32; 2]) -> Option<Vec3> {
        let clip = self.clip_from_world * position.extend(1.0);
        if clip.w <= 0.0 {
            return None;
        }
        let ndc = clip.xyz() / clip.w;
        Some(Vec3::new(
            (0.5 + 0.5 * ndc.x) * size_px[0] as f32,
            (0.5 - 0.5 * ndc.y) * size_px[1] as f32,
            ndc.z,
        ))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn depth_is_reversed_and_the_eye_is_found_in_both_projections() {
        let view_from_world = View::look_at(Vec3::new(3.0, 2.0, 5.0), Vec3::new(0.5, 0.0, 0.0), Vec3::Y);
        let towards = (Vec3::new(3.0, 2.0, 5.0) - Vec3::new(0.5, 0.0, 0.0)).normalize();
        let perspective = View::perspective(0.8, 1.5, 0.01, view_from_world);
        let parallel = View::orthographic(2.0, 1.5, 0.0, 20.0, view_from_world);
        assert!((perspective.eye - Vec4::new(3.0, 2.0, 5.0, 1.0)).length() < 1e-5);
        assert!((parallel.eye - towards.extend(0.0)).length() < 1e-5);
        for view in [perspective, parallel] {
            let near = view.pixel_from_world(towards, [300, 200]);
            let far = view.pixel_from_world(-towards, [300, 200]);
            let (Some(near), Some(far)) = (near, far) else {
                panic!("both lie before the eye")
            };
            assert!(near.z > far.z && far.z > 0.0 && near.z < 1.0);
        }
    }

    #[test]
    fn the_target_is_in_the_middle_and_up_is_up() {
        let target = Vec3::new(0.5, 0.0, 0.0);
        let view = View::perspective(0.8, 1.5, 0.01, View::look_at(Vec3::new(3.0, 2.0, 5.0), target, Vec3::Y));
        let (Some(middle), Some(above)) = (
            view.pixel_from_world(target, [300, 200]),
            view.pixel_from_world(target + Vec3::Y, [300, 200]),
        ) else {
            panic!("both lie before the eye")
        };
        assert!((middle.x - 150.0).abs() < 1e-3 && (middle.y - 100.0).abs() < 1e-3);
        assert!(above.y < middle.y && (above.x - middle.x).abs() < 1e-3);
        assert_eq!(view.pixel_from_world(Vec3::new(30.0, 20.0, 50.0), [300, 200]), None);
    }
}
