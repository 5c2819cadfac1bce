//! The handles on a handle: arrows, squares, rings and boxes of constant size on the screen.
//!
//! The same lines and triangles are drawn and hit, so what is seen is what is grabbed.

use std::f64::consts::TAU;

use glam::{DQuat, DVec2, DVec3};

use super::camera::Camera;
use crate::document::HandleTransform;

/// What the gizmo offers.
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

/// Along which axes the gizmo stands.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default, Hash)]
pub enum GizmoOrientation {
    /// The world's.
    #[default]
    World,
    /// The handle's own, turned along with it.
    Local,
    /// The screen's: to the right, up, towards the eye.
    View,
}

/// How a gizmo is turned.
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

    /// Those of a handle that was put somewhere.
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

/// What can be grabbed.
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

/// A part as it is drawn, in world space.
#[derive(Clone, PartialEq, Debug)]
pub struct GizmoShape {
    /// What it is.
    pub part: GizmoPart,
    /// Its colour, sRGB with alpha; brighter under the pointer.
    pub colour: [u8; 4],
    /// Whether the pointer is over it or drags it.
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

const ARROW_PX: f64 = 96.0;
const ARROW_HEAD_PX: f64 = 16.0;
const ARROW_WIDTH_PX: f64 = 5.0;
const BOX_PX: f64 = 118.0;
const BOX_HALF_PX: f64 = 5.0;
const RING_PX: f64 = 72.0;
const SQUARE_FROM_PX: f64 = 26.0;
const SQUARE_TO_PX: f64 = 42.0;
const CENTRE_PX: f64 = 7.0;
/// How far from a line the pointer may be to grab it.
const GRAB_PX: f64 = 7.0;
const RING_SEGMENTS: usize = 64;
const HEAD_SEGMENTS: usize = 12;

const AXIS_COLOURS: [[u8; 3]; 3] = [[226, 62, 72], [106, 176, 48], [58, 122, 228]];
const AXIS_BRIGHT: [[u8; 3]; 3] = [[255, 136, 140], [172, 236, 112], [140, 188, 255]];

/// The gizmo of a handle whose pivot is at `centre`, turned as `axes` says.
///
/// Lengths are those of the screen: `viewport_px` is its size, and the shapes keep theirs wherever the eye is.
pub fn gizmo_shapes(
    mode: GizmoMode,
    centre: DVec3,
    axes: GizmoAxes,
    camera: &Camera,
    viewport_px: DVec2,
    highlighted: Option<GizmoPart>,
) -> Vec<GizmoShape> {
    let px = camera.world_per_px(centre, viewport_px);
    let to_eye = camera.towards_eye(centre);
    let mut shapes = Vec::new();
    let mut add = |part: GizmoPart, axis: Option<usize>, lines: Vec<[DVec3; 2]>, triangles: Vec<[DVec3; 3]>| {
        let highlighted = highlighted == Some(part);
        let rgb = match (axis, highlighted) {
            (Some(axis), false) => AXIS_COLOURS[axis],
            (Some(axis), true) => AXIS_BRIGHT[axis],
            (None, false) => [222, 222, 222],
            (None, true) => [255, 255, 255],
        };
        let alpha = if matches!(part, GizmoPart::Square(_)) && !highlighted {
            150
        } else {
            255
        };
        shapes.push(GizmoShape {
            part,
            colour: [rgb[0], rgb[1], rgb[2], alpha],
            highlighted,
            lines,
            triangles,
        });
    };
    let shows = |wanted: GizmoMode| mode == GizmoMode::All || mode == wanted;
    if shows(GizmoMode::Turn) {
        for axis in 0..3 {
            add(
                GizmoPart::Ring(axis),
                Some(axis),
                ring(centre, axes.basis * axis_vector(axis), RING_PX * px, to_eye),
                Vec::new(),
            );
        }
    }
    for axis in 0..3 {
        if shows(GizmoMode::Move) {
            let direction = axes.basis * axis_vector(axis);
            let tip = centre + direction * (ARROW_PX * px);
            let base = centre + direction * ((ARROW_PX - ARROW_HEAD_PX) * px);
            let start = centre + direction * (2.0 * CENTRE_PX * px);
            add(
                GizmoPart::Arrow(axis),
                Some(axis),
                vec![[start, base]],
                cone(base, tip, ARROW_WIDTH_PX * px),
            );
            let (u, v) = (
                axes.basis * axis_vector((axis + 1) % 3),
                axes.basis * axis_vector((axis + 2) % 3),
            );
            add(
                GizmoPart::Square(axis),
                Some(axis),
                Vec::new(),
                square(centre, u, v, px),
            );
        }
        if shows(GizmoMode::Scale) {
            let direction = axes.own * axis_vector(axis);
            let middle = centre + direction * (BOX_PX * px);
            let start = if mode == GizmoMode::Scale {
                2.0 * CENTRE_PX
            } else {
                ARROW_PX
            };
            add(
                GizmoPart::Box(axis),
                Some(axis),
                vec![[centre + direction * (start * px), middle]],
                cube(middle, axes.own, BOX_HALF_PX * px),
            );
        }
    }
    if shows(GizmoMode::Move) {
        add(
            GizmoPart::Centre,
            None,
            Vec::new(),
            disc(centre, to_eye, CENTRE_PX * px),
        );
    }
    shapes
}

/// The part under a point of the viewport: filled parts before lines, the nearer line before the farther.
pub fn hit_gizmo(shapes: &[GizmoShape], position_px: DVec2, camera: &Camera, viewport_px: DVec2) -> Option<GizmoPart> {
    let project = |world: DVec3| camera.project(world, viewport_px);
    let mut nearest: Option<(f64, GizmoPart)> = None;
    for shape in shapes {
        let mut distance_px = f64::INFINITY;
        for triangle in &shape.triangles {
            if let [Some(a), Some(b), Some(c)] = triangle.map(project)
                && is_inside(position_px, a, b, c)
            {
                distance_px = 0.0;
            }
        }
        for line in &shape.lines {
            if let [Some(a), Some(b)] = line.map(project) {
                // Lines stand behind what is filled.
                distance_px = distance_px.min(distance_to_segment(position_px, a, b).max(1e-3));
            }
        }
        let limit = if shape.triangles.is_empty() || !shape.lines.is_empty() {
            GRAB_PX
        } else {
            1e-3
        };
        if distance_px < limit && nearest.is_none_or(|(least, _)| distance_px <= least) {
            nearest = Some((distance_px, shape.part));
        }
    }
    nearest.map(|(_, part)| part)
}

/// The half of a ring that faces the eye.
fn ring(centre: DVec3, axis: DVec3, radius: f64, to_eye: DVec3) -> Vec<[DVec3; 2]> {
    let (u, v) = axis.any_orthonormal_pair();
    let edge_on = axis.dot(to_eye).abs();
    let arm = |step: usize| {
        let angle_rad = TAU * step as f64 / RING_SEGMENTS as f64;
        u * angle_rad.cos() + v * angle_rad.sin()
    };
    (0..RING_SEGMENTS)
        .map(|step| [arm(step), arm(step + 1)])
        // A ring seen from its axis is shown whole; of one seen from the side the far half would only confuse.
        .filter(|[a, b]| edge_on > 0.9 || (*a + *b).dot(to_eye) > -0.02)
        .map(|arms| arms.map(|arm| centre + arm * radius))
        .collect()
}

fn cone(base: DVec3, tip: DVec3, radius: f64) -> Vec<[DVec3; 3]> {
    let (u, v) = (tip - base).normalize_or(DVec3::X).any_orthonormal_pair();
    let rim = |step: usize| {
        let angle_rad = TAU * step as f64 / HEAD_SEGMENTS as f64;
        base + (u * angle_rad.cos() + v * angle_rad.sin()) * radius
    };
    (0..HEAD_SEGMENTS)
        .flat_map(|step| [[rim(step), rim(step + 1), tip], [rim(step + 1), rim(step), base]])
        .collect()
}

fn disc(centre: DVec3, normal: DVec3, radius: f64) -> Vec<[DVec3; 3]> {
    let (u, v) = normal.any_orthonormal_pair();
    let rim = |step: usize| {
        let angle_rad = TAU * step as f64 / HEAD_SEGMENTS as f64;
        centre + (u * angle_rad.cos() + v * angle_rad.sin()) * radius
    };
    (0..HEAD_SEGMENTS)
        .map(|step| [centre, rim(step), rim(step + 1)])
        .collect()
}

fn square(centre: DVec3, u: DVec3, v: DVec3, px: f64) -> Vec<[DVec3; 3]> {
    let corner = |a: f64, b: f64| centre + u * (a * px) + v * (b * px);
    let corners = [
        corner(SQUARE_FROM_PX, SQUARE_FROM_PX),
        corner(SQUARE_TO_PX, SQUARE_FROM_PX),
        corner(SQUARE_TO_PX, SQUARE_TO_PX),
        corner(SQUARE_FROM_PX, SQUARE_TO_PX),
    ];
    vec![
        [corners[0], corners[1], corners[2]],
        [corners[0], corners[2], corners[3]],
    ]
}

fn cube(middle: DVec3, rotation: DQuat, half: f64) -> Vec<[DVec3; 3]> {
    let mut triangles = Vec::with_capacity(12);
    for axis in 0..3 {
        for sign in [-1.0, 1.0] {
            let normal = axis_vector(axis) * sign;
            let (u, v) = (axis_vector((axis + 1) % 3) * sign, axis_vector((axis + 2) % 3));
            let corner = |a: f64, b: f64| middle + rotation * ((normal + u * a + v * b) * half);
            let corners = [
                corner(-1.0, -1.0),
                corner(1.0, -1.0),
                corner(1.0, 1.0),
                corner(-1.0, 1.0),
            ];
            triangles.push([corners[0], corners[1], corners[2]]);
            triangles.push([corners[0], corners[2], corners[3]]);
        }
    }
    triangles
}

fn is_inside(p: DVec2, a: DVec2, b: DVec2, c: DVec2) -> bool {
    let sides = [
        (b - a).perp_dot(p - a),
        (c - b).perp_dot(p - b),
        (a - c).perp_dot(p - c),
    ];
    sides.iter().all(|side| *side >= 0.0) || sides.iter().all(|side| *side <= 0.0)
}

fn distance_to_segment(p: DVec2, a: DVec2, b: DVec2) -> f64 {
    let along = b - a;
    let length_squared = along.length_squared();
    let t = if length_squared > 0.0 {
        ((p - a).dot(along) / length_squared).clamp(0.0, 1.0)
    } else {
        0.0
    };
    p.distance(a + along * t)
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test that can't go on fails")]
mod tests {
    use glam::{DVec2, DVec3};

    use super::super::camera::Camera;
    use super::{GizmoAxes, GizmoMode, GizmoPart, gizmo_shapes, hit_gizmo};

    const VIEWPORT_PX: DVec2 = DVec2::new(900.0, 700.0);

    fn camera(distance: f64) -> Camera {
        Camera {
            distance,
            target: DVec3::new(3.0, 1.0, -2.0),
            ..Camera::default()
        }
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
