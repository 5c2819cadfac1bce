//! The speed of a brush on the surface, from the times at which its places are handled.
//!
//! The pointer's moves carry no time, and a window handles all moves since its last picture at once: several places then
//! come within microseconds, though the hand took a whole picture's time for them. So the speed is measured from a place
//! that was handled at least a picture ago.

use std::collections::VecDeque;

use glam::DVec3;

/// The shortest time over which a speed is measured, in milliseconds: a picture of a common screen.
const SHORTEST_MS: f64 = 1000.0 / 60.0;

/// The last places of a brush.
#[derive(Debug, Default)]
pub(super) struct BrushSpeed {
    /// Places in world units, and their times in milliseconds, of which the first alone may be older than
    /// [`SHORTEST_MS`].
    trail: VecDeque<(DVec3, f64)>,
}

impl BrushSpeed {
    /// The velocity at the next place of the brush, in world units per second; `None` at the first one, and where the
    /// brush rests. Without a clock, places are a picture apart.
    pub fn at(&mut self, place: DVec3, now_ms: f64) -> Option<DVec3> {
        let last = self.trail.back().copied();
        if let Some(last) = last.filter(|(_, then_ms)| *then_ms >= now_ms) {
            self.trail = VecDeque::from([last]);
        }
        while self.trail.get(1).is_some_and(|(_, ms)| now_ms - ms >= SHORTEST_MS) {
            self.trail.pop_front();
        }
        let first = self.trail.front().copied();
        self.trail.push_back((place, now_ms));
        let ((from, from_ms), (before, _)) = (first?, last?);
        let passed_ms = (now_ms - from_ms).max(SHORTEST_MS);
        (before != place).then(|| (place - from) / (1e-3 * passed_ms))
    }

    /// Forgets all places: the brush has left the surface.
    pub fn leave(&mut self) {
        self.trail.clear();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The speeds of a brush at 2 units a second whose hand sends a place each 4 ms, handled once a picture.
    fn speeds(picture_ms: f64) -> Vec<f64> {
        let mut speed = BrushSpeed::default();
        let handled = |k: u32| {
            let made_ms = 4.0 * f64::from(k);
            let picture = (made_ms / picture_ms).ceil() * picture_ms;
            (made_ms, picture + 1e-3 * f64::from(k))
        };
        let places = (0..400).map(handled);
        places
            .filter_map(|(made_ms, now_ms)| speed.at(DVec3::X * 2e-3 * made_ms, now_ms))
            .map(|velocity| velocity.x)
            .collect()
    }

    #[test]
    fn a_brush_is_as_fast_as_the_hand_however_seldom_its_places_are_handled() {
        for picture_ms in [4.0, 1000.0 / 144.0, 1000.0 / 60.0, 1000.0 / 24.0, 250.0] {
            let speeds = speeds(picture_ms);
            let later = &speeds[speeds.len() / 2..];
            let fastest = later.iter().copied().fold(0.0, f64::max);
            let mean = later.iter().sum::<f64>() / later.len() as f64;
            // A picture has up to one place more than its time.
            assert!(
                fastest < 2.0 * (1.0 + 4.0 / picture_ms.max(SHORTEST_MS)),
                "{picture_ms} ms: {fastest}"
            );
            assert!(fastest > 1.9, "{picture_ms} ms: {fastest}");
            assert!((0.9..2.1).contains(&mean), "{picture_ms} ms: {mean}");
        }
    }

    #[test]
    fn without_a_clock_places_are_a_picture_apart_and_a_resting_brush_has_no_speed() {
        let mut speed = BrushSpeed::default();
        assert_eq!(speed.at(DVec3::ZERO, 0.0), None);
        for place in 1..5 {
            let velocity = speed.at(DVec3::X * f64::from(place), 0.0);
            assert!(velocity.is_some_and(|v| (v.x - 60.0).abs() < 1e-9), "{velocity:?}");
        }
        assert_eq!(speed.at(DVec3::X * 4.0, 0.0), None);
        speed.leave();
        assert_eq!(speed.at(DVec3::ZERO, 0.0), None);
    }
}
