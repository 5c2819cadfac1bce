//! The centripetal Catmull–Rom spline \[YSK11\], and its arc length.
//!
//! Its knots are spaced by the square roots of the chords. Unlike the uniform spline it has no cusp and no loop within a
//! segment, however uneven the spacing of its points is.

use glam::DVec3;

/// Intervals of equal parameter in each segment; lengths and frames are tabulated at their ends.
pub(super) const INTERVALS: usize = 32;

/// Nodes and weights of Gauss–Legendre quadrature with five points on [0, 1].
const GAUSS: [(f64, f64); 5] = [
    (0.046_910_077_030_668, 0.118_463_442_528_094_5),
    (0.230_765_344_947_158_45, 0.239_314_335_249_683_23),
    (0.5, 0.284_444_444_444_444_44),
    (0.769_234_655_052_841_5, 0.239_314_335_249_683_23),
    (0.953_089_922_969_332, 0.118_463_442_528_094_5),
];

/// A spline through points.
#[derive(Clone, PartialEq, Debug)]
pub(super) struct Spline {
    /// The control points; the first one again at the end of a closed spline.
    points: Vec<DVec3>,
    /// The derivative by the knots' parameter at each of them.
    derivatives: Vec<DVec3>,
    /// The knots' distances.
    spacings: Vec<f64>,
    /// The length up to each end of an interval, ascending.
    lengths: Vec<f64>,
}

impl Spline {
    /// A spline through at least two finite points, or at least three if it `is_closed`; no neighbours are equal.
    pub fn new(points: &[DVec3], is_closed: bool) -> Self {
        let closing = points.first().filter(|_| is_closed);
        let points: Vec<DVec3> = points.iter().chain(closing).copied().collect();
        let chords = points.windows(2).map(|pair| pair[0].distance(pair[1]));
        let spacings: Vec<f64> = chords.map(f64::sqrt).collect();
        let derivatives = derivatives(&points, &spacings, is_closed);
        let mut own = Self {
            points,
            derivatives,
            spacings,
            lengths: vec![0.0],
        };
        let mut sum = 0.0;
        for segment in 0..own.segment_count() {
            for interval in 0..INTERVALS {
                let from = interval as f64 / INTERVALS as f64;
                sum += own.length_within(segment, from, (interval + 1) as f64 / INTERVALS as f64);
                own.lengths.push(sum);
            }
        }
        own
    }

    /// The number of segments between control points.
    pub fn segment_count(&self) -> usize {
        self.spacings.len()
    }

    /// The number of intervals of the table.
    pub fn interval_count(&self) -> usize {
        self.lengths.len() - 1
    }

    /// The length up to the start of an interval, or to the end of the last one.
    pub fn length_at(&self, interval: usize) -> f64 {
        self.lengths[interval]
    }

    /// The length up to a control point.
    pub fn length_at_point(&self, point: usize) -> f64 {
        self.lengths[point * INTERVALS]
    }

    /// The whole length.
    pub fn length(&self) -> f64 {
        self.length_at(self.interval_count())
    }

    /// The position at `u` intervals from the start.
    pub fn position(&self, u: f64) -> DVec3 {
        let (segment, t) = self.place(u);
        let (square, cube) = (t * t, t * t * t);
        let start = self.points[segment];
        let chord = (self.points[segment + 1] - start) * (3.0 * square - 2.0 * cube);
        let (from, to) = (self.derivatives[segment], self.derivatives[segment + 1]);
        start + chord + (from * (cube - 2.0 * square + t) + to * (cube - square)) * self.spacings[segment]
    }

    /// The derivative by `u` at `u` intervals from the start.
    pub fn derivative(&self, u: f64) -> DVec3 {
        let (segment, t) = self.place(u);
        self.slope(segment, t) / INTERVALS as f64
    }

    /// The second derivative by `u`.
    pub fn second_derivative(&self, u: f64) -> DVec3 {
        let (segment, t) = self.place(u);
        let chord = self.points[segment + 1] - self.points[segment];
        let (from, to) = (self.derivatives[segment], self.derivatives[segment + 1]);
        let curve = chord * (6.0 - 12.0 * t) + (from * (6.0 * t - 4.0) + to * (6.0 * t - 2.0)) * self.spacings[segment];
        curve / (INTERVALS * INTERVALS) as f64
    }

    /// The length from the start to `u` intervals from there.
    pub fn length_to(&self, u: f64) -> f64 {
        let interval = self.interval_of(u);
        let (segment, t) = self.place(u);
        let from = (interval % INTERVALS) as f64 / INTERVALS as f64;
        self.lengths[interval] + self.length_within(segment, from, t)
    }

    /// The inverse of [`Spline::length_to`], for a length from 0 to the whole one.
    pub fn parameter_at(&self, length: f64) -> f64 {
        let above = self.lengths.partition_point(|&own| own <= length);
        let interval = above.saturating_sub(1).min(self.interval_count() - 1);
        let (mut low, mut high) = (interval as f64, (interval + 1) as f64);
        let whole = self.lengths[interval + 1] - self.lengths[interval];
        let mut u = if whole > 0.0 {
            (low + (length - self.lengths[interval]) / whole).clamp(low, high)
        } else {
            low
        };
        // Newton steps, halving where one would leave the bracket.
        for _ in 0..50 {
            let excess = self.length_to(u.min(high)) - length;
            if excess > 0.0 {
                high = u;
            } else {
                low = u;
            }
            let speed = self.derivative(u).length();
            let step = u - excess / speed;
            let next = if step > low && step < high {
                step
            } else {
                0.5 * (low + high)
            };
            if (next - u).abs() <= 4.0 * f64::EPSILON * (interval + 1) as f64 {
                break;
            }
            u = next;
        }
        u
    }

    /// The interval that contains a parameter.
    pub fn interval_of(&self, u: f64) -> usize {
        (u.max(0.0) as usize).min(self.interval_count() - 1)
    }

    /// The segment of a parameter, and the share of it that is passed.
    fn place(&self, u: f64) -> (usize, f64) {
        let segment = self.interval_of(u) / INTERVALS;
        (segment, u / INTERVALS as f64 - segment as f64)
    }

    /// The derivative by the share of a segment.
    fn slope(&self, segment: usize, t: f64) -> DVec3 {
        let square = t * t;
        let chord = self.points[segment + 1] - self.points[segment];
        let (from, to) = (self.derivatives[segment], self.derivatives[segment + 1]);
        chord * (6.0 * t - 6.0 * square)
            + (from * (3.0 * square - 4.0 * t + 1.0) + to * (3.0 * square - 2.0 * t)) * self.spacings[segment]
    }

    /// The length of a part of a segment, from one share of it to another.
    fn length_within(&self, segment: usize, from: f64, to: f64) -> f64 {
        let speed = |(node, weight)| weight * self.slope(segment, from + (to - from) * node).length();
        (to - from) * GAUSS.into_iter().map(speed).sum::<f64>()
    }
}

/// The derivatives at the points: those of the parabola through a point and its neighbours (Barry and Goldman's
/// pyramid, differentiated). At an end of an open spline it is the next one, mirrored by the chord, so that equal steps
/// on a line or on a circle stay on it.
fn derivatives(points: &[DVec3], spacings: &[f64], is_closed: bool) -> Vec<DVec3> {
    let last = points.len() - 1;
    let inner = |before: usize, after: usize| {
        let (into, out) = (spacings[before], spacings[after]);
        let (a, b) = (points[before + 1] - points[before], points[after + 1] - points[after]);
        a / into + b / out - (a + b) / (into + out)
    };
    let mut own: Vec<DVec3> = vec![DVec3::ZERO; last + 1];
    for point in 1..last {
        own[point] = inner(point - 1, point);
    }
    if is_closed {
        own[0] = inner(last - 1, 0);
        own[last] = own[0];
    } else if last == 1 {
        own.fill((points[1] - points[0]) / spacings[0]);
    } else {
        let mirrored = |derivative: DVec3, chord: DVec3| 2.0 * derivative.project_onto(chord) - derivative;
        own[0] = mirrored(own[1], points[1] - points[0]);
        own[last] = mirrored(own[last - 1], points[last] - points[last - 1]);
    }
    own
}
