//! The weights of morph targets over time, as glTF's samplers give them.

/// The way between two keys.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum Interpolation {
    Step,
    Linear,
    /// Cubic Hermite splines; each key has the rate before it, its value, and the rate after it.
    Cubic,
}

impl Interpolation {
    /// By its name in the file; a missing one is linear.
    pub fn of(name: Option<&str>) -> Self {
        match name {
            Some("STEP") => Self::Step,
            Some("CUBICSPLINE") => Self::Cubic,
            _ => Self::Linear,
        }
    }

    /// The number of values that a key has for each target.
    fn values(self) -> usize {
        match self {
            Self::Step | Self::Linear => 1,
            Self::Cubic => 3,
        }
    }
}

/// The weights of all targets of a node over time.
#[derive(Clone, PartialEq, Debug)]
pub(crate) struct WeightTrack {
    /// In seconds, ascending, at least one.
    times: Vec<f64>,
    numbers: Vec<f64>,
    interpolation: Interpolation,
}

impl WeightTrack {
    /// A track of keys at `times`, each with as many `numbers`. `None` if the times don't ascend, the counts don't fit, or
    /// a number is not finite.
    pub fn new(times: Vec<f64>, numbers: Vec<f64>, interpolation: Interpolation) -> Option<Self> {
        let ascend = times.windows(2).all(|pair| pair[0] <= pair[1]);
        let per_key = numbers.len().checked_div(times.len())?;
        let fit = per_key * times.len() == numbers.len() && per_key % interpolation.values() == 0;
        let are_finite = times.iter().chain(&numbers).all(|number| number.is_finite());
        (ascend && fit && are_finite).then_some(Self {
            times,
            numbers,
            interpolation,
        })
    }

    /// The times of its keys, in seconds.
    pub fn times(&self) -> &[f64] {
        &self.times
    }

    /// The time of the last key, in seconds.
    pub fn end(&self) -> f64 {
        self.times.last().copied().unwrap_or_default()
    }

    /// Returns true if each key's weights hold until the next.
    pub fn holds(&self) -> bool {
        self.interpolation == Interpolation::Step
    }

    /// The weights of the targets at a time; the first key's before it, and the last one's after it.
    pub fn at(&self, time: f64) -> Vec<f64> {
        let next = self.times.partition_point(|key| *key <= time);
        let (before, after) = match next {
            0 => (0, 0),
            next => (next - 1, next.min(self.times.len() - 1)),
        };
        let span = self.times[after] - self.times[before];
        let share = match span > 0.0 {
            true => (time - self.times[before]) / span,
            false => 0.0,
        };
        let targets = self.numbers.len() / self.times.len() / self.interpolation.values();
        let number = |key: usize, kind: usize, target: usize| {
            let per_key = targets * self.interpolation.values();
            self.numbers[key * per_key + kind * targets + target]
        };
        let weight = |target: usize| match self.interpolation {
            Interpolation::Step => number(before, 0, target),
            Interpolation::Linear => {
                let (a, b) = (number(before, 0, target), number(after, 0, target));
                if share == 0.0 { a } else { a + (b - a) * share }
            }
            Interpolation::Cubic => {
                let (square, cube) = (share * share, share * share * share);
                let (a, b) = (number(before, 1, target), number(after, 1, target));
                let (leaving, arriving) = (number(before, 2, target) * span, number(after, 0, target) * span);
                a * (2.0 * cube - 3.0 * square + 1.0)
                    + b * (3.0 * square - 2.0 * cube)
                    + leaving * (cube - 2.0 * square + share)
                    + arriving * (cube - square)
            }
        };
        (0..targets).map(weight).collect()
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test that can't go on fails")]
mod tests {
    use super::*;

    #[test]
    fn weights_meet_their_keys_and_rest_outside_of_them() {
        let times = vec![0.5, 1.0, 2.0];
        for interpolation in [Interpolation::Step, Interpolation::Linear] {
            let track = WeightTrack::new(times.clone(), vec![0.0, 1.0, 0.25, 0.5, 1.0, 0.0], interpolation).unwrap();
            for (time, weights) in [
                (0.0, [0.0, 1.0]),
                (0.5, [0.0, 1.0]),
                (1.0, [0.25, 0.5]),
                (3.0, [1.0, 0.0]),
            ] {
                assert_eq!(track.at(time), weights);
            }
            let between = if interpolation == Interpolation::Step {
                [0.25, 0.5]
            } else {
                [0.625, 0.25]
            };
            assert_eq!(track.at(1.5), between);
        }
    }

    #[test]
    fn a_cubic_track_follows_a_cubic() {
        let cubic = |t: f64| t * t * t - 2.0 * t;
        let rate = |t: f64| 3.0 * t * t - 2.0;
        let times = vec![0.0, 0.5, 2.0];
        let numbers = times.iter().flat_map(|t| [rate(*t), cubic(*t), rate(*t)]).collect();
        let track = WeightTrack::new(times, numbers, Interpolation::Cubic).unwrap();
        for time in [0.0, 0.2, 0.5, 1.3, 2.0] {
            assert!((track.at(time)[0] - cubic(time)).abs() < 1e-12);
        }
    }

    #[test]
    fn keys_that_do_not_fit_make_no_track() {
        let linear = Interpolation::Linear;
        assert_eq!(WeightTrack::new(vec![], vec![], linear), None);
        assert_eq!(WeightTrack::new(vec![0.0, 1.0], vec![0.0; 3], linear), None);
        assert_eq!(WeightTrack::new(vec![1.0, 0.0], vec![0.0; 2], linear), None);
        assert_eq!(WeightTrack::new(vec![0.0], vec![f64::NAN], linear), None);
        assert_eq!(WeightTrack::new(vec![0.0], vec![0.0; 4], Interpolation::Cubic), None);
    }
}
