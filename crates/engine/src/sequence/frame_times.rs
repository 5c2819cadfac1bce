//! The times of the frames of an animation that has key times of its own.
//!
//! An edit spreads from key frames over the frames beside them, so there are frames between far keys, too. The rate is the
//! lowest usual one of at least 24 frames a second at which every key of the animation is a frame. An animation whose keys
//! fit none has frames at 24 a second, and one more at each of its keys.

use crate::EngineError;
use crate::frames::frame_count;

/// The frames a second of an animation whose keys are frames of it.
const FPS: f64 = 24.0;

/// The usual rates: those of films, of television, of screens and of motion capture. The lowest one that fits is taken.
const RATES: [f64; 14] = [
    FPS,
    24_000.0 / 1001.0,
    25.0,
    30_000.0 / 1001.0,
    30.0,
    48.0,
    50.0,
    60_000.0 / 1001.0,
    60.0,
    72.0,
    90.0,
    100.0,
    120.0,
    240.0,
];

/// Times that are closer than this share of a frame are one: files have single precision.
const NEAR: f64 = 1e-3;

/// The times of frames.
#[derive(Clone, PartialEq, Debug)]
pub(super) struct FrameTimes {
    /// In seconds, ascending, from 0.
    pub(super) times: Vec<f64>,
    /// The frames a second, or those without the frames at uneven keys.
    pub(super) fps: f64,
    /// The number of keys between the frames of a steady rate, which are frames of their own.
    pub(super) uneven: usize,
}

impl FrameTimes {
    /// Frames at a steady rate up to a time, both ends included.
    ///
    /// # Errors
    /// Too many frames.
    pub(super) fn steady(duration: f64, fps: f64) -> Result<Self, EngineError> {
        let times = (0..frame_count(duration, fps)?).map(|frame| frame as f64 / fps);
        Ok(Self {
            times: times.collect(),
            fps,
            uneven: 0,
        })
    }

    /// Frames of which every one of these `keys` is one, which ascend.
    ///
    /// # Errors
    /// Too many frames.
    pub(super) fn of_keys(keys: &[f64]) -> Result<Self, EngineError> {
        let duration = keys.last().copied().unwrap_or_default();
        let mut rates = RATES.into_iter();
        let fitting = rates.find(|fps| keys.iter().all(|key| is_frame(*key, *fps)));
        let fps = fitting.unwrap_or(FPS);
        // In single precision the last key may be before its frame.
        let mut own = Self::steady(duration + near(duration * fps) / fps, fps)?;
        let mut uneven = Vec::new();
        for key in keys {
            let frame = (key * fps).round() as usize;
            match own.times.get_mut(frame).filter(|_| is_frame(*key, fps)) {
                // The very time of the key, so that its own weights are met.
                Some(time) => *time = *key,
                None => uneven.push(*key),
            }
        }
        own.uneven = uneven.len();
        own.times.extend(uneven);
        own.times.sort_by(f64::total_cmp);
        own.times.dedup();
        Ok(own)
    }
}

/// Returns true if a time is that of a frame.
fn is_frame(time: f64, fps: f64) -> bool {
    let frame = time * fps;
    (frame - frame.round()).abs() <= near(frame)
}

/// The distance, in frames, up to which a time is that of a frame: also the last place of single precision, for animations
/// of hours.
fn near(frame: f64) -> f64 {
    NEAR + frame * 1e-7
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test that can't go on fails")]
mod tests {
    use super::*;

    fn single(times: impl IntoIterator<Item = f64>) -> Vec<f64> {
        times.into_iter().map(|time| f64::from(time as f32)).collect()
    }

    #[test]
    fn every_key_is_a_frame_at_its_very_time() {
        let rates = [1.0, 8.0, 12.0, 24.0, 25.0, 30.0, 50.0, 60.0, 30_000.0 / 1001.0, 120.0];
        let steady = rates.map(|fps| single((0..50).map(|frame| f64::from(frame) / fps)));
        let uneven = [vec![0.0, 0.31, 0.577, 1.9], vec![0.25, 1.0], vec![0.0], Vec::new()];
        for keys in steady.into_iter().chain(uneven) {
            let found = FrameTimes::of_keys(&keys).unwrap();
            assert_eq!(found.times[0], 0.0, "{keys:?}");
            assert!(found.times.windows(2).all(|pair| pair[0] < pair[1]), "{keys:?}");
            assert!(keys.iter().all(|key| found.times.contains(key)), "{keys:?}");
            assert_eq!(found.times.last(), keys.last().or(Some(&0.0)));
        }
    }

    #[test]
    fn the_rate_is_the_clips_own_and_24_where_that_fits() {
        let of = |keys: &[f64]| FrameTimes::of_keys(keys).unwrap();
        for (fps, expected) in [
            (12.0, 24.0),
            (24.0, 24.0),
            (15.0, 30.0),
            (30.0, 30.0),
            (25.0, 25.0),
            (60.0, 60.0),
        ] {
            let found = of(&single((0..40).map(|frame| f64::from(frame) / fps)));
            assert_eq!((found.fps, found.uneven), (expected, 0), "{fps}");
        }
        let uneven = of(&[0.0, 0.123_456, 1.0]);
        assert_eq!((uneven.fps, uneven.uneven, uneven.times.len()), (24.0, 1, 26));
    }
}
