//! Cubic interpolation without overshoot \[FB84\]: between two values the interpolant stays between them.

/// Values at ascending places, interpolated by a monotone cubic with a continuous derivative; constant beyond the ends.
///
/// Values on a line are interpolated by that line.
#[derive(Clone, PartialEq, Debug)]
pub(super) struct Monotone {
    places: Vec<f64>,
    values: Vec<f64>,
    slopes: Vec<f64>,
}

impl Monotone {
    /// At least two places, strictly ascending, and a value for each. The slopes at the ends of a `is_periodic`
    /// interpolant are those of an inner place.
    pub fn new(places: Vec<f64>, values: Vec<f64>, is_periodic: bool) -> Self {
        let width = |k: usize| places[k + 1] - places[k];
        let secant = |k: usize| (values[k + 1] - values[k]) / width(k);
        // The harmonic mean of the secants, weighted as for parabolas.
        let between = |before: usize, after: usize| {
            let (a, b) = (secant(before), secant(after));
            if a * b <= 0.0 {
                return 0.0;
            }
            let (early, late) = (2.0 * width(after) + width(before), width(after) + 2.0 * width(before));
            (early + late) / (early / a + late / b)
        };
        let last = places.len() - 1;
        let mut slopes = vec![0.0; last + 1];
        for k in 1..last {
            slopes[k] = between(k - 1, k);
        }
        if is_periodic {
            slopes[0] = between(last - 1, 0);
            slopes[last] = slopes[0];
        } else {
            let end = |own: f64, next: f64| {
                let slope = 1.5 * own - 0.5 * next;
                if slope * own <= 0.0 {
                    0.0
                } else {
                    own.signum() * slope.abs().min(3.0 * own.abs())
                }
            };
            slopes[0] = if last == 1 {
                secant(0)
            } else {
                end(secant(0), slopes[1])
            };
            slopes[last] = if last == 1 {
                secant(0)
            } else {
                end(secant(last - 1), slopes[last - 1])
            };
        }
        Self { places, values, slopes }
    }

    /// The value at a place.
    pub fn at(&self, place: f64) -> f64 {
        let last = self.places.len() - 1;
        let next = self.places.partition_point(|&own| own <= place);
        if next == 0 {
            return self.values[0];
        }
        if next > last {
            return self.values[last];
        }
        let (from, to) = (next - 1, next);
        let width = self.places[to] - self.places[from];
        let t = (place - self.places[from]) / width;
        let (square, cube) = (t * t, t * t * t);
        let rise = self.values[to] - self.values[from];
        self.values[from]
            + rise * (3.0 * square - 2.0 * cube)
            + width * (self.slopes[from] * (cube - 2.0 * square + t) + self.slopes[to] * (cube - square))
    }
}
