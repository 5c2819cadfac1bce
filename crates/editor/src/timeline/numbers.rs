//! The keys of numbers and vectors that belong together, like a curve's, and their values between them.

use glam::DVec3;

use super::spline::{KeyRates, hermite};
use crate::ease::Ease;

/// The values at a key, or between two.
#[derive(Clone, PartialEq, Debug, Default)]
pub(crate) struct Values {
    /// They run along Catmull–Rom splines.
    pub(crate) vectors: Vec<DVec3>,
    /// They never leave the range of the two keys beside them. NaN is a value that only its own key has.
    pub(crate) numbers: Vec<f64>,
}

/// The keys of values, by time; all have as many values.
#[derive(Clone, PartialEq, Debug, Default)]
pub(crate) struct NumberTrack {
    keys: Vec<(f64, Ease, Values)>,
}

impl NumberTrack {
    /// A track of keys whose times ascend.
    pub(crate) fn new(keys: Vec<(f64, Ease, Values)>) -> Self {
        Self { keys }
    }

    /// Returns true if it has no key.
    pub(crate) fn is_empty(&self) -> bool {
        self.keys.is_empty()
    }

    /// The values at every key.
    pub(crate) fn values(&self) -> impl Iterator<Item = &Values> {
        self.keys.iter().map(|(.., values)| values)
    }

    /// The values at a time, and those of the key before it; the first ones before all keys, the last ones after them.
    /// `None` without keys.
    pub(crate) fn at(&self, time: f64) -> Option<(Values, &Values)> {
        let next = self.keys.partition_point(|(own, ..)| *own <= time);
        let Some(place) = next.checked_sub(1) else {
            let (.., first) = self.keys.first()?;
            return Some((first.clone(), first));
        };
        let (from, ease, own) = &self.keys[place];
        let Some((to, _, following)) = self.keys.get(next).filter(|_| *from < time) else {
            return Some((own.clone(), own));
        };
        let share = (time - from) / (to - from);
        let values = match ease {
            Ease::Hold => own.clone(),
            Ease::Linear => Values {
                vectors: own
                    .vectors
                    .iter()
                    .zip(&following.vectors)
                    .map(|(a, b)| a.lerp(*b, share))
                    .collect(),
                numbers: own
                    .numbers
                    .iter()
                    .zip(&following.numbers)
                    .map(|(a, b)| a + (b - a) * share)
                    .collect(),
            },
            Ease::Smooth => self.smooth(place, share),
        };
        let numbers = values.numbers.iter().zip(&own.numbers);
        let numbers = numbers
            .map(|(value, own)| if value.is_nan() { *own } else { *value })
            .collect();
        Some((Values { numbers, ..values }, own))
    }

    /// The values at a share of the way from a key to the next, along the curve through all keys.
    fn smooth(&self, place: usize, share: f64) -> Values {
        let ((start, _, a), (end, _, b)) = (&self.keys[place], &self.keys[place + 1]);
        let (span, basis) = (end - start, hermite(share));
        let (from, to) = (self.rates(place), self.rates(place + 1));
        let vector = |k: usize| {
            a.vectors[k] * basis[0]
                + b.vectors[k] * basis[1]
                + (from.vectors[k] * basis[2] + to.vectors[k] * basis[3]) * span
        };
        let number = |k: usize| {
            a.numbers[k] * basis[0]
                + b.numbers[k] * basis[1]
                + (from.numbers[k] * basis[2] + to.numbers[k] * basis[3]) * span
        };
        Values {
            vectors: (0..a.vectors.len()).map(vector).collect(),
            numbers: (0..a.numbers.len()).map(number).collect(),
        }
    }

    /// The rates of change at a key, per second; zero at an end.
    fn rates(&self, place: usize) -> Values {
        let (time, _, own) = &self.keys[place];
        let neighbours = place.checked_sub(1).zip(self.keys.get(place + 1));
        let Some((before, (after_time, _, after))) = neighbours else {
            return Values {
                vectors: vec![DVec3::ZERO; own.vectors.len()],
                numbers: vec![0.0; own.numbers.len()],
            };
        };
        let (before_time, _, before) = &self.keys[before];
        let rates = KeyRates::of([*before_time, *time, *after_time]);
        let vector = |k: usize| rates.of_vector(before.vectors[k], own.vectors[k], after.vectors[k]);
        let number = |k: usize| rates.of_number(before.numbers[k], own.numbers[k], after.numbers[k]);
        Values {
            vectors: (0..own.vectors.len()).map(vector).collect(),
            numbers: (0..own.numbers.len()).map(number).collect(),
        }
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test that can't go on fails")]
mod tests {
    use super::*;

    fn track(numbers: &[f64]) -> NumberTrack {
        let times = [0.0, 0.5, 2.0, 2.5, 4.0];
        let keys = times.iter().zip(numbers).map(|(time, number)| {
            let values = Values {
                vectors: vec![DVec3::new(*number, 1.0, -2.0 * number)],
                numbers: vec![*number],
            };
            (*time, Ease::Smooth, values)
        });
        NumberTrack::new(keys.collect())
    }

    #[test]
    fn numbers_meet_their_keys_and_stay_between_them() {
        for numbers in [
            [0.0, 1.0, 0.0, 1.0, 1.0],
            [1.0, 1.0, 0.2, 0.1, 1.0],
            [0.0, 0.1, 0.2, 0.9, 1.0],
        ] {
            let track = track(&numbers);
            for pair in track.keys.windows(2) {
                let (low, high) = (pair[0].2.numbers[0], pair[1].2.numbers[0]);
                let (low, high) = (low.min(high), low.max(high));
                for step in 0..=20 {
                    let time = pair[0].0 + (pair[1].0 - pair[0].0) * f64::from(step) / 20.0;
                    let value = track.at(time).unwrap().0.numbers[0];
                    assert!(
                        (low - 1e-12..=high + 1e-12).contains(&value),
                        "{numbers:?} at {time}: {value}"
                    );
                }
                assert_eq!(track.at(pair[0].0).unwrap().0, pair[0].2);
            }
            let resting = track.at(3.0).unwrap().0;
            if numbers[3] == numbers[4] {
                assert_eq!(resting.vectors, track.keys[3].2.vectors);
            }
        }
    }

    #[test]
    fn a_value_that_only_one_key_has_stays_until_the_next() {
        let track = track(&[0.5, f64::NAN, 1.0, 1.0, 1.0]);
        assert_eq!(track.at(0.25).unwrap().0.numbers, [0.5]);
        assert!(track.at(1.0).unwrap().0.numbers[0].is_nan());
        assert_eq!(track.at(2.25).unwrap().0.numbers, [1.0]);
    }
}
