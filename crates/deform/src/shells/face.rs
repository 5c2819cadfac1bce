//! The gradient of a triangle's area: at a corner half of the opposite edge, turned by a quarter within the plane.

use glam::DVec3;
use pliant_mesh::face_normal;

/// The area's gradient at the three corners. A triangle without an area gives none.
pub(super) fn gradient([a, b, c]: [DVec3; 3]) -> [DVec3; 3] {
    let normal = face_normal([a, b, c]);
    [c - b, a - c, b - a].map(|opposite| 0.5 * normal.cross(opposite))
}
