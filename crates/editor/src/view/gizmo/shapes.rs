//! The gizmo's lines and triangles.

use std::f64::consts::TAU;

use glam::{DQuat, DVec2, DVec3};

use super::{GizmoAxes, GizmoMode, GizmoPart, GizmoShape, axis_vector};
use crate::view::camera::Camera;

const ARROW_PX: f64 = 96.0;
const ARROW_HEAD_PX: f64 = 16.0;
const ARROW_WIDTH_PX: f64 = 5.0;
const BOX_PX: f64 = 118.0;
const BOX_HALF_PX: f64 = 5.0;
const RING_PX: f64 = 72.0;
const SQUARE_FROM_PX: f64 = 26.0;
const SQUARE_TO_PX: f64 = 42.0;
/// Half a side of the square in the middle, which moves in the plane of the screen.
const CENTRE_PX: f64 = 7.0;
const RING_SEGMENTS: usize = 64;
const HEAD_SEGMENTS: usize = 12;

/// With all parts shown, rings begin this far from the middle of the screen's gizmo: a ring that is seen from the side
/// would lie across the painted surface there, and a drag of that surface would turn it.
const RING_FROM_PX: f64 = 36.0;

/// An axis is left out if the cosine between it and the direction of sight is above this: it would be a point under which
/// a drag moves or scales in depth.
const MOST_ALONG_SIGHT: f64 = 0.97;

/// A square is left out if the cosine between its normal and the direction of sight is below this.
const LEAST_SEEN: f64 = 0.08;

const AXIS_COLOURS: [[u8; 3]; 3] = [[226, 62, 72], [106, 176, 48], [58, 122, 228]];
const AXIS_BRIGHT: [[u8; 3]; 3] = [[255, 136, 140], [172, 236, 112], [140, 188, 255]];

/// The gizmo of a handle whose pivot is at `centre`, with the orientation `axes`.
///
/// Lengths are in points of the screen: `viewport_px` is its size, and the shapes keep their size for every position of
/// the eye.
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
    let mut add = |part: GizmoPart, lines: Vec<[DVec3; 2]>, triangles: Vec<[DVec3; 3]>| {
        let highlighted = highlighted == Some(part);
        shapes.push(GizmoShape {
            part,
            colour: colour(part, highlighted),
            highlighted,
            lines,
            triangles,
        });
    };
    let shows = |wanted: GizmoMode| mode == GizmoMode::All || mode == wanted;
    if shows(GizmoMode::Turn) {
        for axis in 0..3 {
            let mut lines = ring(centre, axes.basis * axis_vector(axis), RING_PX * px, to_eye);
            if mode == GizmoMode::All {
                let is_clear = |end: &DVec3| (*end - centre).reject_from(to_eye).length() >= RING_FROM_PX * px;
                lines.retain(|ends| ends.iter().all(is_clear));
            }
            add(GizmoPart::Ring(axis), lines, Vec::new());
        }
    }
    let along_sight = |direction: DVec3| direction.dot(to_eye).abs();
    for axis in 0..3 {
        let direction = axes.basis * axis_vector(axis);
        if shows(GizmoMode::Move) && along_sight(direction) <= MOST_ALONG_SIGHT {
            let tip = centre + direction * (ARROW_PX * px);
            let base = centre + direction * ((ARROW_PX - ARROW_HEAD_PX) * px);
            let start = centre + direction * (2.0 * CENTRE_PX * px);
            add(
                GizmoPart::Arrow(axis),
                vec![[start, base]],
                cone(base, tip, ARROW_WIDTH_PX * px),
            );
        }
        if shows(GizmoMode::Move) && along_sight(direction) >= LEAST_SEEN {
            let (u, v) = (
                axes.basis * axis_vector((axis + 1) % 3),
                axes.basis * axis_vector((axis + 2) % 3),
            );
            let ends = [SQUARE_FROM_PX * px, SQUARE_TO_PX * px];
            add(GizmoPart::Square(axis), Vec::new(), square(centre, u, v, ends));
        }
        let direction = axes.own * axis_vector(axis);
        if shows(GizmoMode::Scale) && along_sight(direction) <= MOST_ALONG_SIGHT {
            let middle = centre + direction * (BOX_PX * px);
            let start = if mode == GizmoMode::Scale {
                2.0 * CENTRE_PX
            } else {
                ARROW_PX
            };
            add(
                GizmoPart::Box(axis),
                vec![[centre + direction * (start * px), middle]],
                cube(middle, axes.own, BOX_HALF_PX * px),
            );
        }
    }
    if shows(GizmoMode::Move) {
        let axes = camera.axes();
        let half = CENTRE_PX * px;
        add(
            GizmoPart::Centre,
            Vec::new(),
            square(centre, axes.x_axis, axes.y_axis, [-half, half]),
        );
    }
    shapes
}

/// sRGB with alpha; squares are translucent.
fn colour(part: GizmoPart, highlighted: bool) -> [u8; 4] {
    let [red, green, blue] = match (part, highlighted) {
        (GizmoPart::Centre, false) => [222; 3],
        (GizmoPart::Centre, true) => [255; 3],
        (
            GizmoPart::Arrow(axis) | GizmoPart::Square(axis) | GizmoPart::Ring(axis) | GizmoPart::Box(axis),
            highlighted,
        ) => match highlighted {
            true => AXIS_BRIGHT[axis],
            false => AXIS_COLOURS[axis],
        },
    };
    let is_seen_through = matches!(part, GizmoPart::Square(_)) && !highlighted;
    [red, green, blue, if is_seen_through { 150 } else { 255 }]
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
        // A ring seen from its axis is shown whole; for one seen from the side the far half would only confuse.
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

/// A square between two lengths along both axes.
fn square(centre: DVec3, u: DVec3, v: DVec3, [from, to]: [f64; 2]) -> Vec<[DVec3; 3]> {
    let corner = |a: f64, b: f64| centre + u * a + v * b;
    let corners = [corner(from, from), corner(to, from), corner(to, to), corner(from, to)];
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
