//! Lines on which a field over the vertices, linear within each triangle, has one value.

use glam::DVec3;

use super::shape::Shape;

/// Pieces of lines, one a triangle.
pub(super) type Segments = Vec<[DVec3; 2]>;

/// The lines on which the field has the value `level`. Triangles with a corner whose value is not a number are left
/// out.
pub(super) fn segments(shape: &Shape<'_>, field: &[f64], level: f64) -> Segments {
    let pieces = shape.triangles.iter().filter_map(|&triangle| {
        let values = triangle.map(|v| field[v.index()] - level);
        crossing(shape.corners(triangle), values)
    });
    pieces.collect()
}

/// The line in a triangle on which a linear function with these values at the corners is 0; `None` if it has one sign,
/// or a value is not a number.
pub fn crossing(corners: [DVec3; 3], values: [f64; 3]) -> Option<[DVec3; 2]> {
    let is_above = values.map(|value| value >= 0.0);
    if values.iter().any(|value| value.is_nan()) || is_above == [true; 3] || is_above == [false; 3] {
        return None;
    }
    // The corner that is alone on its side.
    let alone = (0..3).find(|&corner| {
        is_above[corner] != is_above[(corner + 1) % 3] && is_above[corner] != is_above[(corner + 2) % 3]
    })?;
    let end = |other: usize| {
        let share = values[alone] / (values[alone] - values[other]);
        corners[alone].lerp(corners[other], share)
    };
    Some([end((alone + 1) % 3), end((alone + 2) % 3)])
}
