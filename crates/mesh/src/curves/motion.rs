//! The motion from one curve to another: every point goes with the frame at its place on the curve at rest.

use glam::{DAffine3, DMat3, DQuat, DVec2, DVec3};

use super::curve::{Curve, CurveRefused, LARGEST_TWIST_DEG, SCALE_RANGE};
use super::monotone::Monotone;

/// The inverse of this is the most that a still control point can count against one that moves by the curve's length.
pub(super) const STILL: f64 = 1e-12;

/// The sum of the squares of bends, in radians, below which a curve is straight but for rounding.
const STRAIGHT: f64 = 1e-20;

/// The motion of a curve through control points, with a twist and a scale at each of them.
///
/// A point p whose nearest place on the curve at rest is s goes to c′(σ(s)) + k(s) F′(σ(s)) R_z(τ(s)) F(s)ᵀ (p − c(s)),
/// with positions c, frames F, twist τ and scale k. Lengths σ, twist and scale are interpolated between the control
/// points by monotone cubics, so that lengths which are kept at the control points are kept between them. Beyond the
/// ends of an open curve the frame of the end moves everything.
///
/// The two curves' frames fix the motion up to one turn about the tangents. It is chosen so that a rigid motion of the
/// curve is the motion, and otherwise so that still control points have still surroundings (`alignment`).
#[derive(Clone, PartialEq, Debug)]
pub struct CurveMotion {
    rest: Curve,
    moved: Curve,
    /// The length along the moved curve of each place at rest.
    places: Monotone,
    twist_rad: Monotone,
    /// The logarithm of the scale.
    log_scale: Monotone,
    /// The turn of the moved curve's frames about their tangents, in radians.
    alignment_rad: f64,
    is_rest: bool,
}

impl CurveMotion {
    /// The motion of `rest` to the control points `moved`, one for each, with the `twist_deg` in degrees about the
    /// tangent and the scale (above 0) of each.
    ///
    /// # Errors
    /// Points that make no curve, a list of another length, or a twist or scale out of range.
    pub fn new(rest: Curve, moved: Vec<DVec3>, twist_deg: &[f64], scale: &[f64]) -> Result<Self, CurveRefused> {
        let expected = rest.points().len();
        for found in [moved.len(), twist_deg.len(), scale.len()] {
            if found != expected {
                return Err(CurveRefused::Count { found, expected });
            }
        }
        check(twist_deg, scale)?;
        let is_rest = moved == rest.points()
            && twist_deg.iter().all(|twist| *twist == 0.0)
            && scale.iter().all(|scale| *scale == 1.0);
        let first = rest.frame(0.0);
        let moved = Curve::beginning(moved, rest.is_closed(), |tangent| {
            DQuat::from_rotation_arc(first.z_axis, tangent) * first.x_axis
        })?;
        let at = rest.point_places();
        let closing = rest.is_closed();
        let along = |values: Vec<f64>| {
            let first = values.first().copied().filter(|_| closing);
            let values = values.into_iter().chain(first).collect();
            Monotone::new(at.clone(), values, closing)
        };
        Ok(Self {
            places: Monotone::new(at.clone(), moved.point_places(), closing),
            twist_rad: along(twist_deg.iter().map(|twist| twist.to_radians()).collect()),
            log_scale: along(scale.iter().map(|scale| scale.ln()).collect()),
            alignment_rad: alignment(&rest, &moved),
            rest,
            moved,
            is_rest,
        })
    }

    /// Returns true if no control point moves, turns or grows; no point moves then, to the bit.
    pub fn is_rest(&self) -> bool {
        self.is_rest
    }

    /// The curve at rest.
    pub fn rest(&self) -> &Curve {
        &self.rest
    }

    /// The curve through the moved control points.
    pub fn moved(&self) -> &Curve {
        &self.moved
    }

    /// The twist at a place, in radians; full turns count.
    pub fn twist_at(&self, place: f64) -> f64 {
        self.twist_rad.at(place)
    }

    /// The rotation of the frame at a place, without the twist.
    pub fn turn_at(&self, place: f64) -> DQuat {
        DQuat::from_mat3(&self.linear(place, self.alignment_rad)).normalize()
    }

    /// The map of world positions with which a point and its surroundings move.
    pub fn map(&self, point: DVec3) -> DAffine3 {
        self.map_at(self.rest.nearest(point))
    }

    /// The displacement of a point.
    pub fn displacement(&self, point: DVec3) -> DVec3 {
        if self.is_rest {
            return DVec3::ZERO;
        }
        let place = self.rest.nearest(point);
        let (from, to) = self.ends(place);
        let arm = point - from;
        (to - from) + (self.stretched(place) * arm - arm)
    }

    /// The map of world positions around a place on the curve at rest.
    pub fn map_at(&self, place: f64) -> DAffine3 {
        if self.is_rest {
            return DAffine3::IDENTITY;
        }
        let (from, to) = self.ends(place);
        let matrix3 = self.stretched(place);
        DAffine3 {
            matrix3,
            translation: to - matrix3 * from,
        }
    }

    /// The position at a place and its image.
    fn ends(&self, place: f64) -> (DVec3, DVec3) {
        (self.rest.position(place), self.moved.position(self.places.at(place)))
    }

    /// The linear part of the motion at a place.
    fn stretched(&self, place: f64) -> DMat3 {
        self.linear(place, self.alignment_rad + self.twist_at(place)) * self.log_scale.at(place).exp()
    }

    /// The rotation from the frame at a place to that of its image, turned about the tangent.
    fn linear(&self, place: f64, turn_rad: f64) -> DMat3 {
        let moved = self.moved.frame(self.places.at(place));
        moved * DMat3::from_rotation_z(turn_rad) * self.rest.frame(place).transpose()
    }
}

fn check(twist_deg: &[f64], scale: &[f64]) -> Result<(), CurveRefused> {
    let is_wild = |twist: &f64| twist.is_nan() || twist.abs() > LARGEST_TWIST_DEG;
    if let Some(point) = twist_deg.iter().position(is_wild) {
        let found = twist_deg[point];
        return Err(CurveRefused::Twist { point, found });
    }
    match scale.iter().position(|scale| !SCALE_RANGE.contains(scale)) {
        Some(point) => Err(CurveRefused::Scale {
            point,
            found: scale[point],
        }),
        None => Ok(()),
    }
}

/// The turn about its tangents that fits the moved curve's frames to those at rest, in radians.
///
/// Two answers are right in different cases. The turn that fits the curves' *bends* is right if the curve moved rigidly:
/// over the control points it is the angle of Σ z̄ z′, with the bends z and z′ as complex numbers in the two frames. A
/// straight curve has no bends, and slight ones must not decide about the surroundings. The turn that fits the *smallest
/// rotations* of the tangents is right if a part of the curve is still: there it is none. The bends count by |Σ z̄ z′|,
/// the smallest rotations by the bends' misfit min Σ |z′ − e^{iφ} z|², which is 0 for a rigid motion.
fn alignment(rest: &Curve, moved: &Curve) -> f64 {
    let (before, after) = (rest.turns(), moved.turns());
    let pairs = || before.iter().zip(&after);
    let fit = pairs().fold(DVec2::ZERO, |sum, (z, other)| sum + conjugate(*z).rotate(*other));
    let turn = fit.normalize_or(DVec2::X);
    let misfit = pairs().map(|(z, other)| other.distance_squared(turn.rotate(*z)));
    let misfit = misfit.sum::<f64>() / before.len() as f64;
    let size = rest.length();
    let (mut smallest, mut sum) = (DVec2::ZERO, 0.0);
    let places = rest.point_places().into_iter().zip(moved.point_places());
    let points = rest.points().iter().zip(moved.points());
    for ((from, to), (rest_point, moved_point)) in places.zip(points) {
        let (before, after) = (rest.frame(from), moved.frame(to));
        let wanted = DQuat::from_rotation_arc(before.z_axis, after.z_axis) * before.x_axis;
        let way = moved_point.distance_squared(*rest_point) / (size * size);
        let tilt = after.z_axis.distance_squared(before.z_axis);
        // Half a turn has no smallest rotation.
        let weight = (4.0 - tilt) / (STILL + way + tilt);
        smallest += DVec2::new(wanted.dot(after.x_axis), wanted.dot(after.y_axis)) * weight;
        sum += weight;
    }
    let share = misfit + if sum > 0.0 { STRAIGHT / sum } else { 0.0 };
    let all = fit + smallest * share;
    if all == DVec2::ZERO { 0.0 } else { all.to_angle() }
}

/// The conjugate of a complex number.
fn conjugate(number: DVec2) -> DVec2 {
    DVec2::new(number.x, -number.y)
}
