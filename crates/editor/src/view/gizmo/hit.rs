//! The part of the gizmo under the pointer.

use glam::{DVec2, DVec3};

use super::{GizmoPart, GizmoShape};
use crate::view::camera::Camera;

/// The pointer's distance to a line within which it grabs the line.
const GRAB_PX: f64 = 7.0;

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
                // Lines are behind filled parts.
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

fn is_inside(p: DVec2, a: DVec2, b: DVec2, c: DVec2) -> bool {
    let sides = [
        (b - a).perp_dot(p - a),
        (c - b).perp_dot(p - b),
        (a - c).perp_dot(p - c),
    ];
    sides.iter().all(|side| *side >= 0.0) || sides.iter().all(|side| *side <= 0.0)
}

/// The distance of a point from a segment.
pub(crate) fn distance_to_segment(p: DVec2, a: DVec2, b: DVec2) -> f64 {
    let along = b - a;
    let length_squared = along.length_squared();
    let t = if length_squared > 0.0 {
        ((p - a).dot(along) / length_squared).clamp(0.0, 1.0)
    } else {
        0.0
    };
    p.distance(a + along * t)
}
