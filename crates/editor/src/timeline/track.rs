//! One handle's keys, and its transform between them.
//!
//! Positions and stretches run along Catmull–Rom splines with uneven spacing, rotations along squad \[Sho87\], the
//! quaternion curve with the same idea: both pass through their keys and have continuous velocities at evenly spaced
//! keys.

use glam::{DMat3, DQuat, DVec3};

use super::interpolation::between;
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
        let rotation = squad(
            [from.transform.rotation, to.transform.rotation],
            [self.tangent(place), self.tangent(place + 1)],
            share,
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

    /// The rates of change at a key, per second: those of the parabola through it and its neighbours; zero at an end.
    fn rates(&self, place: usize) -> Rates {
        let Some((before, after)) = place.checked_sub(1).zip(self.keys.get(place + 1)) else {
            return Rates::ZERO;
        };
        let (before, key) = (&self.keys[before], &self.keys[place]);
        let (first, second) = (key.time - before.time, after.time - key.time);
        let [of_before, of_after] = [second / first, first / second].map(|weight| weight / (first + second));
        let rate = |a: DVec3, b: DVec3, c: DVec3| (b - a) * of_before + (c - b) * of_after;
        let (a, b, c) = (&before.transform, &key.transform, &after.transform);
        Rates {
            pivot: rate(a.pivot, b.pivot, c.pivot),
            translation: rate(a.translation, b.translation, c.translation),
            stretch: (b.stretch - a.stretch) * of_before + (c.stretch - b.stretch) * of_after,
        }
    }

    /// The inner quaternion of squad at a key; the key's own at an end, where the turn begins and ends at rest.
    fn tangent(&self, place: usize) -> DQuat {
        let rotation = |place: usize| self.keys.get(place).map(|key| key.transform.rotation);
        let own = self.keys[place].transform.rotation;
        match (place.checked_sub(1).and_then(rotation), rotation(place + 1)) {
            (Some(before), Some(after)) => {
                let turns = |other: DQuat| (own.inverse() * other).to_scaled_axis();
                let bend = (turns(before) + turns(after)) * -0.25;
                (own * DQuat::from_scaled_axis(bend)).normalize()
            }
            _ => own,
        }
    }
}

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

/// The values of the cubic Hermite polynomials: of both ends, and of the rates at both ends.
fn hermite(share: f64) -> [f64; 4] {
    let (square, cube) = (share * share, share.powi(3));
    [
        2.0 * cube - 3.0 * square + 1.0,
        3.0 * square - 2.0 * cube,
        cube - 2.0 * square + share,
        cube - square,
    ]
}

/// Squad: slerp(slerp(q₀, q₁, h), slerp(s₀, s₁, h), 2h(1 − h)) \[Sho87\].
fn squad([from, to]: [DQuat; 2], [inner_from, inner_to]: [DQuat; 2], share: f64) -> DQuat {
    let (outer, inner) = (from.slerp(to, share), inner_from.slerp(inner_to, share));
    outer.slerp(inner, 2.0 * share * (1.0 - share)).normalize()
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
