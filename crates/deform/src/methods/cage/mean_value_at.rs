//! Mean value coordinates of a point anywhere: in the plane of a face, on the cage, or outside.

use glam::DVec3;

use super::mesh::CageMesh;

/// A coordinate and its gradient.
pub(super) type Weight = (f64, DVec3);

/// Three directions with a smaller triple product are coplanar.
pub(super) const COPLANAR: f64 = 1e-10;

/// A point nearer to a vertex than this share of the cage's size is at the vertex.
const AT_VERTEX: f64 = 1e-13;

/// The step of differences in units of the cage's size.
const STEP: f64 = 1e-5;

/// Computes the coordinates of a point by their definition, and gradients by differences: near the plane of a face the
/// formula for the gradient has no digits left.
pub(super) fn at_any(cage: &CageMesh, point: DVec3, out: &mut [Weight]) {
    let size = cage.vertices[0]
        .distance(cage.vertices[cage.vertices.len() / 2])
        .max(f64::MIN_POSITIVE);
    values(cage, point, size, out);
    let (mut ahead, mut behind) = (out.to_vec(), out.to_vec());
    let step = STEP * size;
    for axis in 0..3 {
        values(cage, point + DVec3::AXES[axis] * step, size, &mut ahead);
        values(cage, point - DVec3::AXES[axis] * step, size, &mut behind);
        for ((own, ahead), behind) in out.iter_mut().zip(&ahead).zip(&behind) {
            own.1[axis] = (ahead.0 - behind.0) / (2.0 * step);
        }
    }
}

/// Computes the coordinates, with zero gradients.
fn values(cage: &CageMesh, point: DVec3, size: f64, out: &mut [Weight]) {
    out.fill((0.0, DVec3::ZERO));
    let nearest = (0..cage.vertices.len()).map(|vertex| (cage.vertices[vertex].distance(point), vertex));
    let (distance, nearest) = nearest.reduce(|a, b| if b.0 < a.0 { b } else { a }).unwrap_or_default();
    if distance <= AT_VERTEX * size {
        out[nearest].0 = 1.0;
        return;
    }
    for (number, face) in cage.faces.iter().enumerate() {
        let e = cage.corners(number).map(|corner| corner - point);
        let lengths = e.map(DVec3::length);
        let crosses = [e[1].cross(e[2]), e[2].cross(e[0]), e[0].cross(e[1])];
        let angle = |k: usize| crosses[k].length().atan2(e[(k + 1) % 3].dot(e[(k + 2) % 3]));
        let angles = [angle(0), angle(1), angle(2)];
        let volume = e[0].dot(crosses[0]);
        if volume.abs() <= COPLANAR * lengths[0] * lengths[1] * lengths[2] {
            if angles.iter().sum::<f64>() < std::f64::consts::TAU - COPLANAR {
                // From a point beside it in its plane, the face has no solid angle.
                continue;
            }
            // On the face the weights are areas.
            let area = crosses[0] + crosses[1] + crosses[2];
            out.fill((0.0, DVec3::ZERO));
            for corner in 0..3 {
                out[face[corner] as usize].0 = crosses[corner].dot(area) / area.length_squared();
            }
            return;
        }
        let mean: DVec3 = (0..3).map(|k| crosses[k].normalize_or_zero() * (0.5 * angles[k])).sum();
        for corner in 0..3 {
            out[face[corner] as usize].0 += crosses[corner].dot(mean) / volume;
        }
    }
    if !normalised(out) {
        // This happens only outside, where weights may cancel.
        out.fill((0.0, DVec3::ZERO));
        out[nearest].0 = 1.0;
    }
}

/// Computes λ = w / Σ w with its gradient. Returns false if that is no number.
pub(super) fn normalised(weights: &mut [Weight]) -> bool {
    let (mut sum, mut slope) = (0.0, DVec3::ZERO);
    for (value, gradient) in weights.iter() {
        sum += value;
        slope += *gradient;
    }
    for (value, gradient) in weights.iter_mut() {
        *value /= sum;
        *gradient = (*gradient - slope * *value) / sum;
    }
    sum.is_finite() && sum.abs() > f64::MIN_POSITIVE && slope.is_finite()
}
