//! One handle's keys, and its transform between them.
//!
//! Positions and stretches run along Catmull–Rom splines with uneven spacing, rotations along squad \[Sho87\], the
//! quaternion curve with the same idea: both pass through their keys and have continuous velocities at evenly spaced
//! keys. A handle that two neighbouring keys hold at one place rests between them.

use glam::{DMat3, DQuat, DVec3};

use super::interpolation::between;
use super::spline::{KeyRates, eased, hermite, squad};
use crate::document::SplitTransform;
use crate::ease::Ease;

/// A handle's transform at a time.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(crate) struct Key {
    /// In seconds.
    pub(crate) time: f64,
    /// The way to the next key.
    pub(crate) ease: Ease,
    pub(crate) transform: SplitTransform,
}

/// The keys of a handle, by time.
#[derive(Clone, PartialEq, Debug)]
pub(crate) struct Track {
    keys: Vec<Key>,
}

impl Track {
    /// A track of keys whose times ascend. Rotations of neighbours that are the same turn by opposite quaternions are
    /// made alike, so that the handle takes the short way.
    pub(crate) fn new(mut keys: Vec<Key>) -> Self {
        for place in 1..keys.len() {
            let before = keys[place - 1].transform.rotation;
            let rotation = &mut keys[place].transform.rotation;
            if before.dot(*rotation) < 0.0 {
                *rotation = -*rotation;
            }
        }
        Self { keys }
    }

    /// The transform at a time; the first one before all keys, the last one after them. `None` without keys.
    pub(crate) fn at(&self, time: f64) -> Option<SplitTransform> {
        let next = self.keys.partition_point(|key| key.time <= time);
        let Some(place) = next.checked_sub(1) else {
            return self.keys.first().map(|key| key.transform);
        };
        let key = self.keys[place];
        let Some(following) = self.keys.get(next).filter(|_| key.time < time) else {
            return Some(key.transform);
        };
        let share = (time - key.time) / (following.time - key.time);
        Some(match key.ease {
            Ease::Hold => key.transform,
            Ease::Linear => between(&key.transform, &following.transform, share),
            Ease::Smooth => self.smooth(place, share),
        })
    }

    /// The transform at a share of the way from a key to the next, along the curve through all keys.
    fn smooth(&self, place: usize, share: f64) -> SplitTransform {
        let (from, to) = (&self.keys[place], &self.keys[place + 1]);
        let span = to.time - from.time;
        let (from_rate, to_rate) = (self.rates(place), self.rates(place + 1));
        let turned = eased(share, self.turn_rests(place), self.turn_rests(place + 1));
        let rotation = squad(
            [from.transform.rotation, to.transform.rotation],
            [self.tangent(place), self.tangent(place + 1)],
            turned,
        );
        let basis = hermite(share);
        let vector = |a: DVec3, b: DVec3, rate_a: DVec3, rate_b: DVec3| {
            a * basis[0] + b * basis[1] + (rate_a * basis[2] + rate_b * basis[3]) * span
        };
        let (a, b) = (&from.transform, &to.transform);
        SplitTransform {
            pivot: vector(a.pivot, b.pivot, from_rate.pivot, to_rate.pivot),
            translation: vector(a.translation, b.translation, from_rate.translation, to_rate.translation),
            rotation,
            stretch: a.stretch * basis[0]
                + b.stretch * basis[1]
                + (from_rate.stretch * basis[2] + to_rate.stretch * basis[3]) * span,
        }
    }

    /// The rates of change at a key, per second: those of the parabola through it and its neighbours; zero at an end. A
    /// key beside an equal one rests.
    fn rates(&self, place: usize) -> Rates {
        let Some((before, after)) = place.checked_sub(1).zip(self.keys.get(place + 1)) else {
            return Rates::ZERO;
        };
        let (before, key) = (&self.keys[before], &self.keys[place]);
        let rates = KeyRates::of([before.time, key.time, after.time]);
        let (a, b, c) = (&before.transform, &key.transform, &after.transform);
        Rates {
            pivot: rates.of_vector(a.pivot, b.pivot, c.pivot),
            translation: rates.of_vector(a.translation, b.translation, c.translation),
            stretch: rates.of_matrix(a.stretch, b.stretch, c.stretch),
        }
    }

    /// The inner quaternion of squad at a key; the key's own where the turn rests.
    fn tangent(&self, place: usize) -> DQuat {
        let own = self.keys[place].transform.rotation;
        match self.turns(place) {
            Some([before, after]) if !self.turn_rests(place) => {
                (own * DQuat::from_scaled_axis((before + after) * -0.25)).normalize()
            }
            _ => own,
        }
    }

    /// True if the turn rests at a key: at an end, and beside a key with the same rotation.
    fn turn_rests(&self, place: usize) -> bool {
        self.turns(place)
            .is_none_or(|turns| turns.iter().any(|turn| turn.length() < SAME_TURN_RAD))
    }

    /// The turns from a key to both of its neighbours, as scaled axes; `None` at an end.
    fn turns(&self, place: usize) -> Option<[DVec3; 2]> {
        let rotation = |place: usize| self.keys.get(place).map(|key| key.transform.rotation);
        let (before, after) = (rotation(place.checked_sub(1)?)?, rotation(place + 1)?);
        let own = rotation(place)?.inverse();
        Some([before, after].map(|other| (own * other).to_scaled_axis()))
    }
}

/// A turn by less than this is none.
const SAME_TURN_RAD: f64 = 1e-9;

/// The rates of change of a transform's vectors, per second.
struct Rates {
    pivot: DVec3,
    translation: DVec3,
    stretch: DMat3,
}

impl Rates {
    /// At rest.
    const ZERO: Self = Self {
        pivot: DVec3::ZERO,
        translation: DVec3::ZERO,
        stretch: DMat3::ZERO,
    };
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test that can't go on fails")]
mod tests {
    use std::f64::consts::PI;

    use glam::DAffine3;

    use super::*;

    fn key(time: f64, ease: Ease, translation: DVec3, turn: f64) -> Key {
        let transform = SplitTransform {
            pivot: DVec3::new(1.0, 0.0, 0.0),
            translation,
            rotation: DQuat::from_rotation_z(turn),
            stretch: DMat3::from_diagonal(DVec3::new(1.0, 1.0 + time, 1.0)),
        };
        Key { time, ease, transform }
    }

    fn track(ease: Ease) -> Track {
        let keys = [
            (0.0, DVec3::ZERO, 0.0),
            (1.0, DVec3::new(1.0, 2.0, 0.0), 0.9 * PI),
            (2.0, DVec3::new(0.0, 3.0, 0.0), -0.5 * PI),
            (3.0, DVec3::new(0.0, 3.0, 1.0), 0.0),
        ];
        Track::new(
            keys.map(|(time, translation, turn)| key(time, ease, translation, turn))
                .to_vec(),
        )
    }

    fn apart(a: DAffine3, b: DAffine3) -> f64 {
        let points = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
        let distances = points.map(|p| a.transform_point3(p).distance(b.transform_point3(p)));
        distances.into_iter().fold(0.0, f64::max)
    }

    #[test]
    fn every_ease_meets_its_keys_and_rests_before_and_after_them() {
        for ease in [Ease::Hold, Ease::Linear, Ease::Smooth] {
            let track = track(ease);
            for key in &track.keys {
                let exact = key.transform.affine();
                assert!(
                    apart(track.at(key.time).unwrap().affine(), exact) < 1e-12,
                    "{ease:?} at {}",
                    key.time
                );
            }
            assert_eq!(track.at(-1.0), track.at(0.0));
            assert_eq!(track.at(9.0), track.at(3.0));
        }
        assert_eq!(Track::new(Vec::new()).at(0.0), None);
    }

    #[test]
    fn a_held_handle_stays_and_a_linear_one_has_constant_speed() {
        let (held, linear) = (track(Ease::Hold), track(Ease::Linear));
        assert_eq!(held.at(1.999), held.at(1.0));
        let place = |time: f64| {
            linear
                .at(time)
                .unwrap()
                .affine()
                .transform_point3(DVec3::new(1.0, 0.0, 0.0))
        };
        let steps: Vec<DVec3> = (0..10)
            .map(|step| place(0.1 * f64::from(step + 1)) - place(0.1 * f64::from(step)))
            .collect();
        assert!(steps.iter().all(|step| step.distance(steps[0]) < 1e-12), "{steps:?}");
    }

    #[test]
    fn a_smooth_handle_has_no_kink_and_no_turn_takes_the_long_way() {
        let track = track(Ease::Smooth);
        let at = |time: f64| track.at(time).unwrap().affine();
        let small = 1e-4;
        for time in [1.0, 2.0] {
            let (before, after) = (apart(at(time - small), at(time)), apart(at(time), at(time + small)));
            // The speeds on both sides of a key, and the change of direction between them.
            assert!(
                (before - after).abs() < 0.02 * before.max(after),
                "{time}: {before} {after}"
            );
            let straight = apart(at(time - small), at(time + small));
            assert!(straight > 0.98 * (before + after), "{time}");
        }
        let turn = |time: f64| {
            DQuat::from_mat3(&DMat3::from_quat(rotation_of(at(time))))
                .to_scaled_axis()
                .z
        };
        // From 162 to -90 degrees the short way goes through 180.
        assert!(turn(1.5).abs() > 0.9 * PI, "{}", turn(1.5));
    }

    #[test]
    fn a_handle_that_two_keys_hold_rests_between_them() {
        let moved = DVec3::new(0.3, 2.0, -1.0);
        for places in [[0, 1, 1, 0, 2], [0, 0, 1, 1, 1], [1, 0, 2, 2, 0]] {
            let at = |place: i32| f64::from(place);
            let keys = places.iter().zip([0.0, 0.5, 2.0, 2.25, 4.0]);
            let keys = keys.map(|(&place, time)| Key {
                transform: SplitTransform {
                    stretch: DMat3::from_diagonal(DVec3::splat(1.0 + at(place))),
                    ..key(time, Ease::Smooth, moved * at(place), at(place)).transform
                },
                ..key(time, Ease::Smooth, DVec3::ZERO, 0.0)
            });
            let track = Track::new(keys.collect());
            for pair in track
                .keys
                .windows(2)
                .filter(|pair| pair[0].transform == pair[1].transform)
            {
                for share in [0.1, 0.3, 0.5, 0.8] {
                    let time = pair[0].time + share * (pair[1].time - pair[0].time);
                    let way = apart(track.at(time).unwrap().affine(), pair[0].transform.affine());
                    assert!(way < 1e-12, "{places:?} at {time}: {way}");
                }
            }
        }
    }

    #[test]
    fn a_turn_begins_and_ends_at_rest_like_a_move() {
        let keys = [(0.0, 0.0), (2.0, 1.5)].map(|(time, turn)| key(time, Ease::Smooth, DVec3::X * turn, turn));
        let track = Track::new(keys.to_vec());
        for step in 0..=20 {
            let transform = track.at(0.1 * f64::from(step)).unwrap();
            let turn = transform.rotation.to_scaled_axis().z;
            assert!((turn - transform.translation.x).abs() < 1e-12, "{turn}");
        }
    }

    #[test]
    fn between_keys_without_scale_no_length_changes() {
        for ease in [Ease::Hold, Ease::Linear, Ease::Smooth] {
            let mut keys = track(ease).keys;
            keys.iter_mut().for_each(|key| key.transform.stretch = DMat3::IDENTITY);
            let track = Track::new(keys);
            for step in 0..=30 {
                let map = track.at(0.1 * f64::from(step)).unwrap().affine();
                for axis in [DVec3::X, DVec3::Y, DVec3::Z] {
                    let length = map.transform_vector3(axis).length();
                    assert!((length - 1.0).abs() < 1e-12, "{ease:?}, step {step}: {length}");
                }
            }
        }
    }

    /// The rotation of a map whose columns are orthogonal.
    fn rotation_of(map: DAffine3) -> DQuat {
        let [x, y, z] = [map.matrix3.x_axis, map.matrix3.y_axis, map.matrix3.z_axis].map(DVec3::normalize);
        DQuat::from_mat3(&DMat3::from_cols(x, y, z))
    }
}
