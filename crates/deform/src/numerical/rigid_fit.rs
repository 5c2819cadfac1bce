//! The rigid motion that best fits points to displaced ones [Hor87].
//!
//! The unit quaternion that maximises qᵀ N q is a proper rotation for all points: unlike with a singular value
//! decomposition, mirrored and flat patches need no special case.

use glam::{DMat3, DQuat, DVec3};

use crate::numerical::eigen::jacobi;
use crate::numerical::horn::horn;

/// A rigid motion about a point: `p ↦ centre + rotation * (p − centre) + shift`.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct RigidMotion {
    centre: DVec3,
    /// The rotation less the identity, so that small motions keep their digits far from the origin.
    pub(crate) turn: DMat3,
    shift: DVec3,
}

impl RigidMotion {
    /// The least-squares fit to the `displacements` of the points `rest`, one per point; `None` if none of them moves.
    /// Points on a line get the smallest rotation that fits the line.
    pub fn fit(rest: &[DVec3], displacements: &[DVec3]) -> Option<Self> {
        if displacements.iter().all(|&displacement| displacement == DVec3::ZERO) {
            return None;
        }
        let count = rest.len().max(1) as f64;
        let origin = rest.first().copied().unwrap_or_default();
        let centre = origin + rest.iter().map(|&point| point - origin).sum::<DVec3>() / count;
        let shift = displacements.iter().sum::<DVec3>() / count;
        let mut covariance = DMat3::ZERO;
        let mut inertia = 0.0;
        for (&point, &displacement) in rest.iter().zip(displacements) {
            let from = point - centre;
            let to = from + (displacement - shift);
            covariance += DMat3::from_cols(from * to.x, from * to.y, from * to.z);
            inertia += from.length_squared();
        }
        // Points on a line, or all in one place, do not determine a rotation: a little rest inertia selects the
        // smallest one.
        covariance += DMat3::from_diagonal(DVec3::splat(1e-12 * inertia + f64::MIN_POSITIVE));
        let turn = DMat3::from_quat(best_rotation(&covariance)) - DMat3::IDENTITY;
        Some(Self { centre, turn, shift })
    }

    /// The rotation, a unit quaternion.
    pub fn rotation(&self) -> DQuat {
        DQuat::from_mat3(&(self.turn + DMat3::IDENTITY)).normalize()
    }

    /// The displacement of a point.
    pub fn displace(&self, point: DVec3) -> DVec3 {
        self.turn * (point - self.centre) + self.shift
    }
}

/// The rotation R that maximises tr(R S), S = `covariance` = Σ from toᵀ.
pub(crate) fn best_rotation(covariance: &DMat3) -> DQuat {
    let largest = covariance
        .to_cols_array()
        .into_iter()
        .fold(0.0, |a: f64, b| a.max(b.abs()));
    if !(largest > 0.0 && largest.is_finite()) {
        return DQuat::IDENTITY;
    }
    let mut n = horn(&(*covariance * largest.recip()));
    let vectors = jacobi(&mut n);
    let best = (0..4).fold(0, |best, k| if n[k][k] > n[best][best] { k } else { best });
    let q = DQuat::from_xyzw(vectors[1][best], vectors[2][best], vectors[3][best], vectors[0][best]);
    if q.length_squared() > 0.5 {
        q.normalize()
    } else {
        DQuat::IDENTITY
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "tests")]
mod tests {
    use super::RigidMotion;
    use glam::{DMat3, DQuat, DVec3};

    fn points() -> Vec<DVec3> {
        (0..20)
            .map(|i| DVec3::new(f64::from(i * 7 % 5), f64::from(i * 3 % 7), f64::from(i % 4)))
            .collect()
    }

    fn check(rest: &[DVec3], rotation: DQuat, shift: DVec3) {
        let moved = |p: DVec3| rotation * p + shift - p;
        let displacements: Vec<DVec3> = rest.iter().map(|&p| moved(p)).collect();
        let fit = RigidMotion::fit(rest, &displacements).unwrap();
        for &p in rest {
            assert!((fit.displace(p) - moved(p)).length() < 1e-9, "{p} {rotation}");
        }
    }

    #[test]
    fn a_rigid_motion_of_any_points_is_found_again() {
        let flat: Vec<DVec3> = points().into_iter().map(|p| p.with_z(3.0)).collect();
        let line: Vec<DVec3> = (0..5).map(|i| DVec3::new(f64::from(i), 1.0, 1.0)).collect();
        for rest in [points(), flat, line, vec![DVec3::ONE]] {
            for angle in [0.0, 1e-6, 0.4, 2.0, std::f64::consts::PI] {
                check(
                    &rest,
                    DQuat::from_axis_angle(DVec3::new(0.6, 0.0, 0.8), angle),
                    DVec3::new(0.1, -5.0, 2.0),
                );
            }
        }
    }

    #[test]
    fn a_mirrored_patch_gets_a_proper_rotation() {
        let displacements: Vec<DVec3> = points().iter().map(|p| DVec3::new(-2.0 * p.x, 0.0, 0.0)).collect();
        let fit = RigidMotion::fit(&points(), &displacements).unwrap();
        let rotation = fit.turn + DMat3::IDENTITY;
        assert!((rotation.determinant() - 1.0).abs() < 1e-12);
    }

    #[test]
    fn nothing_follows_what_does_not_move() {
        assert_eq!(RigidMotion::fit(&points(), &[DVec3::ZERO; 20]), None);
    }
}
