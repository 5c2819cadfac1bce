//! The handles on a handle: arrows, squares, rings and boxes of constant size on the screen.
//!
//! The same lines and triangles are drawn and hit, so the visible part is the grabbed one.

mod hit;
mod shapes;

use glam::{DQuat, DVec3};

pub(crate) use self::hit::distance_to_segment;
pub use self::hit::hit_gizmo;
pub use self::shapes::gizmo_shapes;
use super::camera::Camera;
use crate::document::HandleTransform;

/// The gizmo's mode.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default, Hash)]
pub enum GizmoMode {
    /// Everything at once.
    #[default]
    All,
    /// Arrows and squares.
    Move,
    /// Rings.
    Turn,
    /// Boxes.
    Scale,
}

/// The axes of the gizmo.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default, Hash)]
pub enum GizmoOrientation {
    /// The world's axes.
    #[default]
    World,
    /// The handle's own axes, turned with it.
    Local,
    /// The screen's axes: to the right, up, towards the eye.
    View,
}

/// The orientation of a gizmo.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct GizmoAxes {
    /// The axes of arrows, squares and rings.
    pub basis: DQuat,
    /// The handle's own, along which it scales.
    pub own: DQuat,
}

impl GizmoAxes {
    /// The world's axes for everything.
    pub const WORLD: Self = Self {
        basis: DQuat::IDENTITY,
        own: DQuat::IDENTITY,
    };

    /// The axes of a moved handle.
    pub(crate) fn of(transform: &HandleTransform, orientation: GizmoOrientation, camera: &Camera) -> Self {
        let own = match *transform {
            HandleTransform::Trs { rotation, .. } => rotation,
            HandleTransform::Matrix(_) => DQuat::IDENTITY,
        };
        Self {
            own,
            basis: match orientation {
                GizmoOrientation::World => DQuat::IDENTITY,
                GizmoOrientation::Local => own,
                GizmoOrientation::View => DQuat::from_mat3(&camera.axes()),
            },
        }
    }
}

/// A part that can be grabbed.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Hash)]
pub enum GizmoPart {
    /// Moves in the plane of the screen.
    Centre,
    /// Moves along an axis (0, 1, 2 for x, y, z).
    Arrow(usize),
    /// Moves in the plane across an axis.
    Square(usize),
    /// Turns about an axis.
    Ring(usize),
    /// Scales along the handle's own axis.
    Box(usize),
}

/// A drawn part, in world space.
#[derive(Clone, PartialEq, Debug)]
pub struct GizmoShape {
    /// Its kind.
    pub part: GizmoPart,
    /// Its colour, sRGB with alpha; brighter under the pointer.
    pub colour: [u8; 4],
    /// True if the pointer is over it or drags it.
    pub highlighted: bool,
    /// Line segments.
    pub lines: Vec<[DVec3; 2]>,
    /// Filled triangles.
    pub triangles: Vec<[DVec3; 3]>,
}

/// The unit vector of axis 0, 1 or 2.
pub(crate) fn axis_vector(axis: usize) -> DVec3 {
    DVec3::AXES[axis.min(2)]
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test that can't go on fails")]
mod tests {
    use glam::{DVec2, DVec3};

    use super::super::camera::Camera;
    use super::{GizmoAxes, GizmoMode, GizmoPart, GizmoShape, gizmo_shapes, hit_gizmo};

    const VIEWPORT_PX: DVec2 = DVec2::new(900.0, 700.0);

    fn camera(distance: f64) -> Camera {
        Camera {
            distance,
            target: DVec3::new(3.0, 1.0, -2.0),
            ..Camera::default()
        }
    }

    /// The whole gizmo from a direction, and the place of its middle on the screen.
    fn seen_from(yaw_rad: f64, pitch_rad: f64) -> (Camera, Vec<GizmoShape>, DVec2) {
        let camera = Camera {
            yaw_rad,
            pitch_rad,
            ..camera(4.0)
        };
        let centre = camera.target;
        let shapes = gizmo_shapes(GizmoMode::All, centre, GizmoAxes::WORLD, &camera, VIEWPORT_PX, None);
        let middle_px = camera.project(centre, VIEWPORT_PX).unwrap();
        (camera, shapes, middle_px)
    }

    #[test]
    fn its_size_on_the_screen_does_not_change_with_distance() {
        let mut lengths = Vec::new();
        for distance in [0.5, 4.0, 300.0] {
            let camera = camera(distance);
            let shapes = gizmo_shapes(
                GizmoMode::Move,
                camera.target,
                GizmoAxes::WORLD,
                &camera,
                VIEWPORT_PX,
                None,
            );
            let arrow = shapes.iter().find(|shape| shape.part == GizmoPart::Arrow(1)).unwrap();
            let [a, b] = arrow.lines[0].map(|end| camera.project(end, VIEWPORT_PX).unwrap());
            lengths.push(a.distance(b));
        }
        // Perspective within the gizmo itself differs a little between near and far.
        assert!(
            lengths.iter().all(|length| (length / lengths[0] - 1.0).abs() < 0.1),
            "{lengths:?}"
        );
    }

    #[test]
    fn the_square_in_the_middle_is_hit_over_twelve_points_from_every_side() {
        for (yaw_rad, pitch_rad) in [(0.0, 0.0), (0.4, 0.3), (1.2, -0.7), (2.5, 1.4)] {
            let (camera, shapes, middle_px) = seen_from(yaw_rad, pitch_rad);
            for corner in [[-6.0, -6.0], [6.0, -6.0], [-6.0, 6.0], [6.0, 6.0], [0.0, 0.0]] {
                let hit = hit_gizmo(&shapes, middle_px + DVec2::from(corner), &camera, VIEWPORT_PX);
                assert_eq!(hit, Some(GizmoPart::Centre), "{yaw_rad} {pitch_rad} {corner:?}");
            }
        }
    }

    #[test]
    fn seen_along_an_axis_nothing_lies_around_the_middle_that_turns_or_moves_in_depth() {
        for (yaw_rad, pitch_rad) in [(0.0, 0.0), (0.1, -0.1), (1.57, 0.05), (0.0, 1.5)] {
            let (camera, shapes, middle_px) = seen_from(yaw_rad, pitch_rad);
            let sight = camera.forward();
            for step in 0..48 {
                let angle_rad = f64::from(step) * std::f64::consts::TAU / 48.0;
                for distance_px in [10.0, 18.0, 26.0] {
                    let at_px = middle_px + DVec2::from_angle(angle_rad) * distance_px;
                    let case = format!("{yaw_rad} {pitch_rad}: {at_px}");
                    match hit_gizmo(&shapes, at_px, &camera, VIEWPORT_PX) {
                        Some(GizmoPart::Ring(axis)) => panic!("{case}: the ring {axis}"),
                        Some(GizmoPart::Arrow(axis) | GizmoPart::Box(axis)) => {
                            assert!(DVec3::AXES[axis].dot(sight).abs() < 0.98, "{case}: the axis {axis}");
                        }
                        _ => {}
                    }
                }
            }
        }
    }

    #[test]
    fn every_part_is_grabbed_where_it_is_drawn() {
        let camera = camera(4.0);
        for mode in [GizmoMode::Move, GizmoMode::Turn, GizmoMode::Scale] {
            let shapes = gizmo_shapes(mode, camera.target, GizmoAxes::WORLD, &camera, VIEWPORT_PX, None);
            for shape in &shapes {
                let mut points = Vec::new();
                points.extend(shape.triangles.iter().map(|[a, b, c]| (*a + *b + *c) / 3.0));
                points.extend(shape.lines.iter().map(|[a, b]| (*a + *b) / 2.0));
                let grabbed = points.iter().any(|point| {
                    let pixel = camera.project(*point, VIEWPORT_PX).unwrap();
                    hit_gizmo(&shapes, pixel, &camera, VIEWPORT_PX) == Some(shape.part)
                });
                assert!(grabbed, "{:?}", shape.part);
            }
        }
        let shapes = gizmo_shapes(
            GizmoMode::All,
            camera.target,
            GizmoAxes::WORLD,
            &camera,
            VIEWPORT_PX,
            None,
        );
        assert_eq!(hit_gizmo(&shapes, DVec2::new(5.0, 5.0), &camera, VIEWPORT_PX), None);
    }
}
