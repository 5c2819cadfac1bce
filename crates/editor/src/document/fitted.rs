//! The rigid motion that fits what has become of some points best.

use glam::{DMat3, DQuat, DVec3};

use super::polar::polar_decomposition;

/// Points this close to a line, relative to their extent, say nothing of a turn about it.
const LINE: f64 = 1e-9;

/// The rotation R and the translation t about `pivot` with p' ≈ pivot + t + R·(p − pivot), in the sense of least squares
/// (Kabsch 1976): R is the rotation in the polar decomposition of Σ (p' − c')·(p − c)ᵀ, with the means c and c'.
///
/// Exactly none where no point has moved; no turn where the points lie on a line.
pub(crate) fn fitted_motion(points: &[(DVec3, DVec3)], pivot: DVec3) -> (DQuat, DVec3) {
    if points.iter().all(|(before, after)| before == after) {
        return (DQuat::IDENTITY, DVec3::ZERO);
    }
    let count = points.len() as f64;
    let before: DVec3 = points.iter().map(|(before, _)| *before).sum::<DVec3>() / count;
    let after: DVec3 = points.iter().map(|(_, after)| *after).sum::<DVec3>() / count;
    let mut covariance = DMat3::ZERO;
    for (p, q) in points {
        let (p, q) = (*p - before, *q - after);
        covariance += DMat3::from_cols(q * p.x, q * p.y, q * p.z);
    }
    let [x, y, z] = [covariance.x_axis, covariance.y_axis, covariance.z_axis];
    let size = x.length_squared() + y.length_squared() + z.length_squared();
    let spread = x.cross(y).length() + y.cross(z).length() + z.cross(x).length();
    let rotation = if spread > LINE * size {
        polar_decomposition(covariance).0
    } else {
        DQuat::IDENTITY
    };
    (rotation, after - pivot - rotation * (before - pivot))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_rigid_motion_of_any_patch_is_found_and_of_a_line_its_translation() {
        let turn = DQuat::from_euler(glam::EulerRot::XYZ, 0.9, -0.4, 2.0);
        let shift = DVec3::new(0.3, -2.0, 1.0);
        let pivot = DVec3::new(5.0, 1.0, -1.0);
        let moved = |p: DVec3| pivot + shift + turn * (p - pivot);
        let patch: Vec<DVec3> = (0..30)
            .map(|i| DVec3::new(f64::from(i % 6), f64::from(i / 6), 2.0))
            .collect();
        let pairs: Vec<_> = patch.iter().map(|&p| (p, moved(p))).collect();
        let (rotation, translation) = fitted_motion(&pairs, pivot);
        for p in &patch {
            let fitted = pivot + translation + rotation * (*p - pivot);
            assert!(fitted.distance(moved(*p)) < 1e-12);
        }
        let line: Vec<_> = (0..4)
            .map(|i| DVec3::X * f64::from(i))
            .map(|p| (p, p + shift))
            .collect();
        assert_eq!(fitted_motion(&line, pivot).0, DQuat::IDENTITY);
        assert!(fitted_motion(&line, pivot).1.distance(shift) < 1e-12);
    }
}
