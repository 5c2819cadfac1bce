//! Screw motions, their logarithms and their blends exp(Σ w log T), whose turns may be full turns.
//!
//! Rigid parts are blended as screw motions about one common origin, so that handles that move alike move everything
//! rigidly; stretches are blended linearly before.

use std::f64::consts::{PI, TAU};

use glam::{DMat3, DQuat, DVec3};

use super::HALF_TURN;
use super::polar::Polar;

/// The least share of its velocity with which the velocity of a screw moves its centre.
const SINGULAR: f64 = 1e-3;

/// A handle's motion as its rigid part's logarithm and its stretch.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Screw {
    /// Full turns about an axis through the centre, before the rest: at a whole weight they change nothing.
    full_turns: Option<FullTurns>,
    /// Axis times angle, in radians.
    turn_rad: DVec3,
    /// The velocity at the common origin.
    slide: DVec3,
    /// The fixed point of the stretch.
    centre: DVec3,
    /// The stretch less the identity.
    stretch: DMat3,
}

/// Full turns: axis times angle, in radians, and the velocity at the common origin.
#[derive(Clone, Copy, Debug)]
struct FullTurns {
    turn_rad: DVec3,
    slide: DVec3,
}

/// A turn's part across another one's axis that does not make it another axis.
const ALONG: f64 = 0.1;

impl Screw {
    /// The motion whose linear part is `linear` and that moves the point `centre` by `shift`; all points here are
    /// relative to the common origin.
    ///
    /// The turn of the way, if it is known, decides about full turns. About the axis of the map's turn they belong to the
    /// screw; about another axis they come before it.
    pub fn of(linear: DMat3, way_rad: Option<DVec3>, shift: DVec3, centre: DVec3) -> Self {
        let shortest = Polar::of(&linear);
        let Some(way_rad) = way_rad.filter(|way| way.length() > 0.5 * PI) else {
            return Self::without_full_turns(shortest, shift, centre);
        };
        let own = shortest.turn_rad;
        if own.cross(way_rad).length() <= ALONG * own.length() * way_rad.length() {
            return Self::without_full_turns(shortest.near(way_rad), shift, centre);
        }
        let axis = way_rad.normalize();
        let count = ((way_rad - own).dot(axis) / TAU).round();
        let back = DQuat::from_scaled_axis(own).conjugate();
        let turn_rad = back * axis * (count * TAU);
        Self {
            full_turns: (count != 0.0).then(|| FullTurns {
                turn_rad,
                slide: centre.cross(turn_rad),
            }),
            ..Self::without_full_turns(shortest, shift, centre)
        }
    }

    fn without_full_turns(polar: Polar, shift: DVec3, centre: DVec3) -> Self {
        let Polar { turn_rad, stretch } = polar;
        // The velocity at the origin of the screw whose exponential shifts the centre by `shift`.
        let at_centre = if turn_rad == DVec3::ZERO {
            shift
        } else {
            let slides = slides(turn_rad);
            // A full turn comes back to where it began, whatever its velocity across the axis.
            if slides.determinant() < SINGULAR {
                shift
            } else {
                slides.inverse() * shift
            }
        };
        Self {
            full_turns: None,
            turn_rad,
            slide: at_centre + centre.cross(turn_rad),
            centre,
            stretch,
        }
    }

    /// Returns true if it turns by more than half a turn.
    pub fn winds(&self) -> bool {
        self.full_turns.is_some() || self.turn_rad.length() > HALF_TURN
    }

    /// The rotation, without the stretch.
    pub fn turn(&self) -> DQuat {
        carried(DVec3::ZERO, std::slice::from_ref(self), &[1.0])
            .turn
            .normalize()
    }
}

/// The image of a point under the screws.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Carried {
    /// The displacement of the point.
    pub displacement: DVec3,
    /// The rotation of its surroundings.
    pub turn: DQuat,
}

/// The point under exp(Σ w log T).
pub(crate) fn carried(point: DVec3, screws: &[Screw], weights: &[f64]) -> Carried {
    if screws.iter().all(|screw| screw.full_turns.is_none()) {
        return by_screws(point, screws, weights);
    }
    let (mut turn_rad, mut slide) = (DVec3::ZERO, DVec3::ZERO);
    for (screw, &weight) in screws.iter().zip(weights) {
        if let Some(full) = screw.full_turns {
            turn_rad += full.turn_rad * weight;
            slide += full.slide * weight;
        }
    }
    let first = exponential(turn_rad, slide, point, DVec3::ZERO);
    let then = by_screws(point + first.displacement, screws, weights);
    Carried {
        displacement: first.displacement + then.displacement,
        turn: then.turn * first.turn,
    }
}

/// The same without full turns.
fn by_screws(point: DVec3, screws: &[Screw], weights: &[f64]) -> Carried {
    let (mut turn_rad, mut slide, mut stretch) = (DVec3::ZERO, DVec3::ZERO, DVec3::ZERO);
    for (screw, &weight) in screws.iter().zip(weights) {
        turn_rad += screw.turn_rad * weight;
        slide += screw.slide * weight;
        stretch += screw.stretch * (point - screw.centre) * weight;
    }
    exponential(turn_rad, slide, point, stretch)
}

/// The point under a displacement, then under the exponential of a screw.
fn exponential(turn_rad: DVec3, slide: DVec3, point: DVec3, displacement: DVec3) -> Carried {
    let arm = point + displacement;
    let angle = turn_rad.length();
    let square = angle * angle;
    // sin θ / θ, (1 − cos θ) / θ² and (θ − sin θ) / θ³, and the quaternion's sin(θ/2) / θ and cos(θ/2).
    let (sine, first, second, half_sine, half_cosine) = if angle < 1e-2 {
        (
            1.0 - square / 6.0 * (1.0 - square / 20.0),
            0.5 - square / 24.0 * (1.0 - square / 30.0),
            (1.0 - square / 20.0 * (1.0 - square / 42.0)) / 6.0,
            0.5 - square / 48.0 * (1.0 - square / 80.0),
            1.0 - square / 8.0 * (1.0 - square / 48.0),
        )
    } else {
        let (s, c) = (0.5 * angle).sin_cos();
        let sine = 2.0 * s * c;
        (
            sine / angle,
            2.0 * s * s / square,
            (angle - sine) / (square * angle),
            s / angle,
            c,
        )
    };
    let across = turn_rad.cross(arm);
    let turned = across * sine + turn_rad.cross(across) * first;
    let across = turn_rad.cross(slide);
    let slid = slide + across * first + turn_rad.cross(across) * second;
    let axis = turn_rad * half_sine;
    Carried {
        displacement: displacement + turned + slid,
        turn: DQuat::from_xyzw(axis.x, axis.y, axis.z, half_cosine),
    }
}

/// V with exp(turn, slide) = (exp(turn), V slide), the left Jacobian of the rotations.
fn slides(turn: DVec3) -> DMat3 {
    let angle = turn.length();
    let cross = DMat3::from_cols(turn.cross(DVec3::X), turn.cross(DVec3::Y), turn.cross(DVec3::Z));
    let (first, second) = if angle < 1e-4 {
        (0.5 - angle * angle / 24.0, (1.0 - angle * angle / 20.0) / 6.0)
    } else {
        let square = angle * angle;
        ((1.0 - angle.cos()) / square, (angle - angle.sin()) / (square * angle))
    };
    DMat3::IDENTITY + cross * first + cross * cross * second
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use super::{Screw, carried};
    use glam::{DAffine3, DMat3, DQuat, DVec3};

    #[test]
    fn full_turns_come_back_at_the_whole_weight_and_wind_on_the_way() {
        let centre = DVec3::new(4.0, 1.0, 1.0);
        let tilt = DQuat::from_rotation_z(0.3);
        let linear = DMat3::from_quat(tilt);
        // Twice about an axis of its own, and once about that of the turn.
        for way in [tilt * DVec3::X * (2.0 * TAU), DVec3::Z * (0.3 + TAU)] {
            let screw = Screw::of(linear, Some(way), DVec3::Y, centre);
            assert!(screw.winds());
            let arm = DVec3::new(0.0, 0.5, 0.5);
            let whole = carried(centre + arm, &[screw], &[1.0]).displacement;
            assert!((whole - (DVec3::Y + tilt * arm - arm)).length() < 1e-9, "{whole}");
            let part = carried(centre, &[screw], &[0.25]).turn;
            let turned = part.to_scaled_axis().length();
            let expected = 0.25 * way.length();
            assert!((turned - expected).abs() < 0.1, "{turned} and {expected}");
        }
    }

    #[test]
    fn whole_weights_give_the_whole_motion_and_none_gives_none() {
        let centre = DVec3::new(1.0, 2.0, 3.0);
        for (angle, shift, scale) in [
            (0.0, DVec3::new(0.1, 0.2, 0.3), 1.0),
            (1e-6, DVec3::ZERO, 1.0),
            (2.0, DVec3::new(5.0, -2.0, 0.0), 2.0),
            (std::f64::consts::PI, DVec3::X, 0.0),
            (3.0, DVec3::Y, -1.0),
        ] {
            let linear = DMat3::from_quat(DQuat::from_axis_angle(DVec3::new(0.6, 0.0, 0.8), angle)) * scale;
            let screw = Screw::of(linear, None, shift, centre);
            let map = DAffine3::from_mat3_translation(linear, centre + shift - linear * centre);
            let point = DVec3::new(0.3, -7.0, 1.0);
            let expected = map.transform_point3(point) - point;
            // Two handles that move alike share the weight.
            let found = carried(point, &[screw, screw], &[0.3, 0.7]).displacement;
            assert!((found - expected).length() < 1e-9, "{angle}: {found} {expected}");
            assert_eq!(carried(point, &[screw], &[0.0]).displacement, DVec3::ZERO);
        }
    }
}
