//! A curve with a frame at each of its places.

use glam::{DMat3, DVec2, DVec3};

use super::spline::Spline;

/// The number of Newton steps to the nearest place; each one at least halves the bracket's excess.
const MOST_STEPS: usize = 60;

/// The largest twist at a control point, in degrees: a hundred turns.
pub const LARGEST_TWIST_DEG: f64 = 36_000.0;

/// The smallest and the largest scale at a control point.
pub const SCALE_RANGE: std::ops::RangeInclusive<f64> = 1e-3..=1e3;

/// A centripetal Catmull–Rom spline through control points, with rotation-minimising frames.
///
/// A *place* is a length along it, in world units, from 0 to [`Curve::length`].
#[derive(Clone, PartialEq, Debug)]
pub struct Curve {
    points: Vec<DVec3>,
    is_closed: bool,
    spline: Spline,
    /// Position and frame at each end of an interval of the spline's table.
    stations: Vec<Station>,
    /// The angle by which transport around a closed curve turns the normal, in radians; it is spread over the length.
    holonomy_rad: f64,
}

/// A position on a curve with its transported frame.
#[derive(Clone, Copy, PartialEq, Debug)]
struct Station {
    position: DVec3,
    tangent: DVec3,
    normal: DVec3,
}

/// The reason why points make no curve, or no motion of one: a sentence without its subject, the list of points or
/// values.
#[derive(Clone, Copy, PartialEq, Debug, thiserror::Error)]
#[non_exhaustive]
pub enum CurveRefused {
    /// Fewer points than a curve needs.
    #[error("has {found} points: give at least {least}")]
    TooFew {
        /// The number of points.
        found: usize,
        /// The least number.
        least: usize,
    },
    /// A coordinate that is not finite.
    #[error("has a coordinate at point {point} that is not a finite number: give three finite numbers for each point")]
    NotFinite {
        /// The number of the point, from 0.
        point: usize,
    },
    /// Two points in the same place, one after the other.
    #[error("has points {point} and {next} in the same place: leave one of them out")]
    Equal {
        /// The number of the first, from 0.
        point: usize,
        /// The number of the other.
        next: usize,
    },
    /// A list of targets, twists or scales of another length than the points.
    #[error("has {found} entries, but the curve has {expected} points: give one for each")]
    Count {
        /// The number of entries.
        found: usize,
        /// The number of points.
        expected: usize,
    },
    /// A twist that is not finite or beyond [`LARGEST_TWIST_DEG`].
    #[error("is {found} at point {point}: give degrees from -{LARGEST_TWIST_DEG} to {LARGEST_TWIST_DEG}")]
    Twist {
        /// The number of the point, from 0.
        point: usize,
        /// The twist.
        found: f64,
    },
    /// A scale outside of [`SCALE_RANGE`].
    #[error("is {found} at point {point}: give factors from {} to {}", SCALE_RANGE.start(), SCALE_RANGE.end())]
    Scale {
        /// The number of the point, from 0.
        point: usize,
        /// The scale.
        found: f64,
    },
}

impl Curve {
    /// The curve through these points, in world units; a closed one returns from the last point to the first.
    ///
    /// # Errors
    /// Fewer than two points (three of a closed curve), a point that is not finite, or equal neighbours.
    pub fn new(points: Vec<DVec3>, is_closed: bool) -> Result<Self, CurveRefused> {
        Self::beginning(points, is_closed, |tangent| tangent.any_orthonormal_vector())
    }

    /// The same; `first_normal` chooses the normal at the start for the unit tangent there.
    pub(super) fn beginning(
        points: Vec<DVec3>,
        is_closed: bool,
        first_normal: impl FnOnce(DVec3) -> DVec3,
    ) -> Result<Self, CurveRefused> {
        check(&points, is_closed)?;
        let spline = Spline::new(&points, is_closed);
        let tangent = tangent_at(&spline, 0.0);
        let mut stations = vec![Station {
            position: points[0],
            tangent,
            normal: across(first_normal(tangent), tangent),
        }];
        for interval in 1..=spline.interval_count() {
            stations.push(stations[interval - 1].transported(&spline, interval as f64));
        }
        let mut own = Self {
            points,
            is_closed,
            spline,
            stations,
            holonomy_rad: 0.0,
        };
        if is_closed {
            let (first, last) = (own.stations[0], own.stations[own.spline.interval_count()]);
            own.holonomy_rad = angle_about(first.tangent, first.normal, last.normal);
        }
        Ok(own)
    }

    /// The control points.
    pub fn points(&self) -> &[DVec3] {
        &self.points
    }

    /// Returns true if it returns to its first point.
    pub fn is_closed(&self) -> bool {
        self.is_closed
    }

    /// Its length, in world units.
    pub fn length(&self) -> f64 {
        self.spline.length()
    }

    /// The place of each control point, ascending; a closed curve ends with its length, the first point's place again.
    pub fn point_places(&self) -> Vec<f64> {
        let all = 0..=self.spline.segment_count();
        all.map(|point| self.spline.length_at_point(point)).collect()
    }

    /// The position at a place.
    pub fn position(&self, place: f64) -> DVec3 {
        self.spline.position(self.spline.parameter_at(place))
    }

    /// The frame at a place: normal, binormal and tangent as columns, right-handed and orthonormal.
    ///
    /// Frames turn about no tangent along an open curve (double reflection \[WJZL08\]). Around a closed curve the angle
    /// that is left at the end is spread over the length.
    pub fn frame(&self, place: f64) -> DMat3 {
        let u = self.spline.parameter_at(place);
        let Station { tangent, normal, .. } = self.stations[self.spline.interval_of(u)].transported(&self.spline, u);
        let frame = DMat3::from_cols(normal, tangent.cross(normal), tangent);
        if self.holonomy_rad == 0.0 {
            return frame;
        }
        frame * DMat3::from_rotation_z(-self.holonomy_rad * place / self.length())
    }

    /// Places along the curve, ascending from its start to its end, that are closer where control points are.
    pub fn station_places(&self) -> impl Iterator<Item = f64> + '_ {
        (0..=self.spline.interval_count()).map(|interval| self.spline.length_at(interval))
    }

    /// The place that is nearest to a point: the first one if several are equally near.
    pub fn nearest(&self, point: DVec3) -> f64 {
        let each = self.stations.iter().enumerate();
        let distances = each.map(|(number, station)| (station.position.distance_squared(point), number));
        let nearest = distances.fold((f64::INFINITY, 0), |best, own| if own.0 < best.0 { own } else { best });
        let count = self.spline.interval_count() as f64;
        let middle = nearest.1 as f64;
        let (low, high) = ((middle - 1.0).max(0.0), (middle + 1.0).min(count));
        let own = self.foot(point, low, middle, high);
        // A closed curve's first and last station are one point, so the foot may be on the other side of it.
        let best = match nearest.1 {
            0 if self.is_closed => {
                let other = self.foot(point, count - 1.0, count, count);
                let is_nearer = |u: f64| self.spline.position(u).distance_squared(point);
                if is_nearer(other) < is_nearer(own) { other } else { own }
            }
            _ => own,
        };
        self.spline.length_to(best)
    }

    /// The zero of (c(u) − p) · c′(u) in a bracket, which is an end of the bracket if the curve only comes nearer
    /// towards it.
    fn foot(&self, point: DVec3, mut low: f64, start: f64, mut high: f64) -> f64 {
        let slope = |u: f64| (self.spline.position(u) - point).dot(self.spline.derivative(u));
        if slope(low) >= 0.0 {
            return low;
        }
        if slope(high) <= 0.0 {
            return high;
        }
        let mut u = start.clamp(low, high);
        for _ in 0..MOST_STEPS {
            let here = slope(u);
            if here > 0.0 {
                high = u;
            } else {
                low = u;
            }
            let (first, second) = (self.spline.derivative(u), self.spline.second_derivative(u));
            let bend = first.length_squared() + (self.spline.position(u) - point).dot(second);
            let step = u - here / bend;
            let next = if step > low && step < high {
                step
            } else {
                0.5 * (low + high)
            };
            if (next - u).abs() <= 4.0 * f64::EPSILON * u.max(1.0) {
                return next;
            }
            u = next;
        }
        u
    }

    /// The rotation between the unit chords that meet at each control point: the difference of their directions in the
    /// frame there, along normal and binormal. The ends of an open curve have none.
    pub(super) fn turns(&self) -> Vec<DVec2> {
        let chords = self.chords();
        let places = self.point_places();
        let count = self.points.len();
        let turn = |point: usize| {
            let before = match (point, self.is_closed) {
                (0, false) => return DVec2::ZERO,
                (0, true) => count - 1,
                _ => point - 1,
            };
            let Some(after) = chords.get(point) else {
                return DVec2::ZERO;
            };
            let frame = self.frame(places[point]);
            let turn = after.normalize() - chords[before].normalize();
            DVec2::new(turn.dot(frame.x_axis), turn.dot(frame.y_axis))
        };
        (0..count).map(turn).collect()
    }

    /// The way from each control point to the next.
    pub(super) fn chords(&self) -> Vec<DVec3> {
        let next = self
            .points
            .iter()
            .skip(1)
            .chain(self.points.first().filter(|_| self.is_closed));
        self.points
            .iter()
            .zip(next)
            .map(|(point, next)| *next - *point)
            .collect()
    }
}

/// The square of a way, as a share of the square of the distance from the origin, below which its direction is noise.
const SAME_PLACE: f64 = 1e-20;

impl Station {
    /// The station at a parameter after this one, its frame transported by two reflections (equations 3 and 4).
    fn transported(&self, spline: &Spline, u: f64) -> Self {
        let position = spline.position(u);
        let tangent = tangent_at(spline, u);
        let way = position - self.position;
        let is_rounding = way.length_squared() <= SAME_PLACE * position.length_squared();
        let normal = if is_rounding {
            // The direction of such a way is noise, and a reflection across noise turns the frame about its tangent.
            self.normal
        } else {
            let (normal, carried) = (reflected(self.normal, way), reflected(self.tangent, way));
            reflected(normal, tangent - carried)
        };
        let normal = across(normal, tangent);
        Self {
            position,
            tangent,
            normal,
        }
    }
}

/// The vector, reflected in the plane that is normal to `by`.
fn reflected(vector: DVec3, by: DVec3) -> DVec3 {
    let square = by.length_squared();
    if square > 0.0 {
        vector - by * (2.0 * by.dot(vector) / square)
    } else {
        vector
    }
}

/// The unit vector across the unit `tangent` that is nearest to `vector`.
fn across(vector: DVec3, tangent: DVec3) -> DVec3 {
    let plain = vector - tangent * vector.dot(tangent);
    plain
        .try_normalize()
        .unwrap_or_else(|| tangent.any_orthonormal_vector())
}

/// The unit tangent. At a cusp, where the curve turns back on itself, it is that of the way onwards.
fn tangent_at(spline: &Spline, u: f64) -> DVec3 {
    let own = spline.derivative(u);
    let step = 1e-3;
    let end = spline.interval_count() as f64;
    let ahead = spline.position((u + step).min(end)) - spline.position((u + step).min(end) - step);
    // A speed far below that of the surroundings has no direction.
    if own.length() > 1e-9 * ahead.length() / step {
        own.normalize()
    } else {
        ahead.normalize_or(DVec3::Z)
    }
}

/// The angle about `axis` from one unit vector across it to another, in radians.
fn angle_about(axis: DVec3, from: DVec3, to: DVec3) -> f64 {
    axis.dot(from.cross(to)).atan2(from.dot(to))
}

fn check(points: &[DVec3], is_closed: bool) -> Result<(), CurveRefused> {
    let (found, least) = (points.len(), if is_closed { 3 } else { 2 });
    if found < least {
        return Err(CurveRefused::TooFew { found, least });
    }
    if let Some(point) = points.iter().position(|point| !point.is_finite()) {
        return Err(CurveRefused::NotFinite { point });
    }
    let count = if is_closed { found } else { found - 1 };
    // The square of a tiny distance may be 0.
    let is_equal = |point: &usize| points[*point].distance(points[(point + 1) % found]) == 0.0;
    match (0..count).find(is_equal) {
        Some(point) => Err(CurveRefused::Equal {
            point,
            next: (point + 1) % found,
        }),
        None => Ok(()),
    }
}
