//! The polar decomposition of a 3×3 matrix into a proper rotation and a symmetric stretch.

use glam::{DMat3, DQuat, DVec3};

/// A = R·S with a proper rotation R and a symmetric S.
///
/// S is positive semidefinite if det A ≥ 0. A mirroring A gets a negative eigenvalue in S, the smallest in size and
/// among equal ones the one that gives R the smallest turn. Singular matrices have a rotation too: the directions that
/// they flatten turn with the others.
pub(crate) fn polar_decomposition(a: DMat3) -> (DQuat, DMat3) {
    let scale = a
        .to_cols_array()
        .iter()
        .fold(0.0_f64, |largest, x| largest.max(x.abs()));
    if scale == 0.0 || !scale.is_finite() {
        return (DQuat::IDENTITY, a);
    }
    let (u, sigma, v) = singular_values(a * (1.0 / scale));
    let proper = u * v.transpose();
    let rotation = if proper.determinant() > 0.0 {
        proper
    } else {
        let smallest = sigma.min_element();
        let mut best: Option<DMat3> = None;
        for axis in 0..3 {
            if sigma[axis] > smallest + 1e-9 {
                continue;
            }
            let mut flipped = u;
            *flipped.col_mut(axis) = -u.col(axis);
            let candidate = flipped * v.transpose();
            if best.is_none_or(|best| trace(candidate) > trace(best)) {
                best = Some(candidate);
            }
        }
        best.unwrap_or(proper)
    };
    let rotation = DQuat::from_mat3(&rotation).normalize();
    let stretch = DMat3::from_quat(rotation).transpose() * a;
    (rotation, (stretch + stretch.transpose()) * 0.5)
}

fn trace(m: DMat3) -> f64 {
    m.x_axis.x + m.y_axis.y + m.z_axis.z
}

/// A = U·diag(σ)·Vᵀ with orthonormal U and V and σ ≥ 0, by one-sided Jacobi rotations: columns of A·V are turned
/// against each other until they are orthogonal, which is accurate even for small σ.
fn singular_values(a: DMat3) -> (DMat3, DVec3, DMat3) {
    let (mut b, mut v) = (a, DMat3::IDENTITY);
    // Convergence is quadratic: five sweeps reach rounding, the rest is a bound.
    for _ in 0..16 {
        let mut largest = 0.0_f64;
        for (p, q) in [(0, 1), (0, 2), (1, 2)] {
            let (x, y) = (b.col(p), b.col(q));
            let (xx, yy, xy) = (x.length_squared(), y.length_squared(), x.dot(y));
            if xy == 0.0 {
                continue;
            }
            largest = largest.max(xy.abs() / (xx * yy).sqrt().max(f64::MIN_POSITIVE));
            let zeta = (yy - xx) / (2.0 * xy);
            let tangent = zeta.signum() / (zeta.abs() + zeta.hypot(1.0));
            let cosine = 1.0 / tangent.hypot(1.0);
            let sine = cosine * tangent;
            for m in [&mut b, &mut v] {
                let (x, y) = (m.col(p), m.col(q));
                *m.col_mut(p) = x * cosine - y * sine;
                *m.col_mut(q) = x * sine + y * cosine;
            }
        }
        if largest <= 1e-15 {
            break;
        }
    }
    let sigma = DVec3::new(b.x_axis.length(), b.y_axis.length(), b.z_axis.length());
    let mut u = DMat3::ZERO;
    let mut order = [0, 1, 2];
    order.sort_by(|&i, &j| sigma[j].total_cmp(&sigma[i]));
    for (rank, &axis) in order.iter().enumerate() {
        let along = b.col(axis) / sigma[axis];
        let known = [u.col(order[0]), u.col(order[1])];
        *u.col_mut(axis) = if sigma[axis] > 1e-12 * sigma.max_element() {
            along
        } else if rank == 2 {
            // This is the one of the two remaining directions that makes the rotation proper.
            let direction = known[0].cross(known[1]);
            let chirality = v.col(order[0]).cross(v.col(order[1])).dot(v.col(axis));
            direction * chirality.signum()
        } else {
            // For a line: any direction across it, as near as possible to V's.
            let wanted = v.col(axis);
            let across = wanted - known[0] * wanted.dot(known[0]);
            if across.length() > 0.1 {
                across.normalize()
            } else {
                known[0].any_orthonormal_vector()
            }
        };
    }
    (u, sigma, v)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn assert_decomposes(a: DMat3) {
        let (rotation, stretch) = polar_decomposition(a);
        let error = DMat3::from_quat(rotation) * stretch - a;
        let size = a
            .to_cols_array()
            .iter()
            .fold(1e-300_f64, |largest, x| largest.max(x.abs()));
        assert!(
            error.to_cols_array().iter().all(|e| e.abs() < 1e-12 * size),
            "{a} came back off by {error}"
        );
        assert!((rotation.length() - 1.0).abs() < 1e-12);
    }

    #[test]
    fn rotation_times_stretch_is_the_matrix_for_regular_mirroring_and_singular_ones() {
        let turn = DMat3::from_quat(DQuat::from_xyzw(0.1, 0.7, -0.3, 0.6).normalize());
        let shear = DMat3::from_cols_array(&[1.0, 0.0, 0.0, 0.7, 1.2, 0.0, -0.4, 0.3, 0.5]);
        for a in [
            DMat3::IDENTITY,
            turn,
            turn * shear,
            turn * DMat3::from_diagonal(DVec3::new(-1.0, 1.0, 1.0)),
            turn * DMat3::from_diagonal(DVec3::new(2.0, 3.0, 0.0)),
            turn * DMat3::from_diagonal(DVec3::new(0.0, 3.0, 0.0)),
            shear * 1e150,
            shear * 1e-150,
            DMat3::ZERO,
        ] {
            assert_decomposes(a);
        }
    }

    #[test]
    fn a_pure_rotation_is_all_rotation_and_a_mirror_turns_nothing() {
        let turn = DQuat::from_rotation_y(2.5);
        let (rotation, stretch) = polar_decomposition(DMat3::from_quat(turn));
        assert!(rotation.angle_between(turn) < 1e-7);
        assert!(stretch.abs_diff_eq(DMat3::IDENTITY, 1e-12));
        let (rotation, _) = polar_decomposition(DMat3::from_diagonal(DVec3::new(1.0, -1.0, 1.0)));
        assert!(rotation.angle_between(DQuat::IDENTITY) < 1e-7);
    }

    #[test]
    fn a_flattening_matrix_keeps_its_turn() {
        let turn = DQuat::from_rotation_z(0.8);
        let (rotation, _) =
            polar_decomposition(DMat3::from_quat(turn) * DMat3::from_diagonal(DVec3::new(1.0, 1.0, 0.0)));
        assert!(rotation.angle_between(turn) < 1e-7);
    }
}
