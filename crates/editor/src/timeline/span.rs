//! Edits of a sequence: handles' transforms at key frames, spread over the frames around them.
//!
//! A key's transform is stored in its handle's own moving frame, as the rotation-invariant coordinates of a handle's
//! trajectory [XZY+07]: it is the same at every frame relative to the place and the turn that the handle has there.
//! Between two keys of a span it is interpolated, and towards the ends of the span it fades to rest. The trajectory
//! itself, and so the sequence's own motion, is not smoothed by this.

use std::collections::BTreeMap;

use super::interpolation::between;
use super::middle::middle_of;
use crate::document::{HandleTransform, SplitTransform};
use crate::ease::Ease;
use crate::key_space::KeySpace;
use glam::{DAffine3, DMat3, DQuat, DVec3};
use pliant_deform::RigidMotion;

/// The place and the turn of a handle in a frame of a sequence.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct HandlePlace {
    /// The mean of its vertices, in world space.
    centre: DVec3,
    /// Its turn since the first frame.
    rotation: DQuat,
}

impl HandlePlace {
    /// The place of a handle whose vertices are at `first` in the first frame and at `now` in this one. Both have at
    /// least one entry.
    pub fn of(first: &[DVec3], now: &[DVec3]) -> Self {
        let displacements: Vec<DVec3> = now.iter().zip(first).map(|(now, first)| *now - *first).collect();
        let motion = RigidMotion::fit(first, &displacements);
        Self {
            centre: middle_of(now),
            rotation: motion.map_or(DQuat::IDENTITY, |motion| motion.rotation()),
        }
    }

    /// The place of the handle's middle as seen from another handle, in that one's axes.
    pub(crate) fn seen_from(&self, other: &Self) -> DVec3 {
        other.rotation.inverse() * (self.centre - other.centre)
    }

    /// The handle's middle, in world space.
    pub fn centre(&self) -> DVec3 {
        self.centre
    }

    /// A share of the rigid motion from here to another place of the handle.
    fn way_to(&self, other: &Self, share: f64) -> DAffine3 {
        let turn = self.turn_to(other, share);
        let centre = self.centre.lerp(other.centre, share);
        DAffine3::from_rotation_translation(turn, centre - turn * self.centre)
    }

    /// The same motion as a handle's transform about its pivot.
    pub(crate) fn transform_to(&self, other: &Self, share: f64, pivot: DVec3) -> HandleTransform {
        HandleTransform::Trs {
            translation: self.way_to(other, share).transform_point3(pivot) - pivot,
            rotation: self.turn_to(other, share),
            scale: DVec3::ONE,
            pivot: None,
        }
    }

    fn turn_to(&self, other: &Self, share: f64) -> DQuat {
        DQuat::IDENTITY.slerp((other.rotation * self.rotation.inverse()).normalize(), share)
    }

    /// A direction in the handle's axes, in world space.
    pub(crate) fn world_from_own(&self, direction: DVec3) -> DVec3 {
        self.rotation * direction
    }

    /// A point that rides along with the handle from another frame.
    pub(crate) fn carried(&self, point: DVec3, other: &Self) -> DVec3 {
        let turn = self.rotation * other.rotation.inverse();
        self.centre + turn * (point - other.centre)
    }
}

/// A transform of a handle at a frame.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(crate) struct SpanKey {
    pub(crate) frame: usize,
    pub(crate) ease: Ease,
    pub(crate) space: KeySpace,
    /// The place of the handle at its frame.
    pub(crate) place: HandlePlace,
    pub(crate) transform: SplitTransform,
}

/// The keys of a handle in one span, by frame.
#[derive(Clone, PartialEq, Debug)]
pub(crate) struct Span {
    /// The first and the last frame.
    pub(crate) ends: [usize; 2],
    pub(crate) keys: Vec<SpanKey>,
}

/// The edits of all handles of a sequence.
#[derive(Clone, PartialEq, Debug)]
pub struct SequenceTimeline {
    /// The spans of each handle.
    pub(crate) spans: Vec<Vec<Span>>,
    /// The shifts of each handle by filters, by frame; they are added to the transforms of keys.
    pub(crate) shifts: Vec<BTreeMap<usize, DVec3>>,
    /// The places to which another sequence leads handles, in every frame, by their numbers. Nothing else moves them.
    pub(crate) led: BTreeMap<usize, Vec<HandlePlace>>,
    /// The share of their way there, from 0 to 1.
    pub(crate) strength: f64,
}

impl SequenceTimeline {
    /// The handles' maps at a frame where they have these places; `None` if no handle is moved.
    pub fn maps_at(&self, frame: usize, places: &[HandlePlace]) -> Option<Vec<DAffine3>> {
        let of_handle = |(number, place): (usize, &HandlePlace)| {
            if let Some(led) = self.led.get(&number) {
                return (self.strength > 0.0).then(|| place.way_to(&led[frame], self.strength));
            }
            let (spans, shifts) = (&self.spans[number], &self.shifts[number]);
            let map = spans.iter().find_map(|span| span.at(frame, place));
            let map = map.map(|transform| transform.affine());
            match shifts.get(&frame).filter(|shift| **shift != DVec3::ZERO) {
                Some(shift) => Some(DAffine3::from_translation(*shift) * map.unwrap_or(DAffine3::IDENTITY)),
                None => map,
            }
        };
        let maps: Vec<Option<DAffine3>> = places.iter().enumerate().map(of_handle).collect();
        if maps.iter().all(Option::is_none) {
            return None;
        }
        Some(maps.into_iter().map(|map| map.unwrap_or(DAffine3::IDENTITY)).collect())
    }

    /// Returns true if another sequence leads a handle, or a frame is in the span of a key or of a filter.
    pub fn reaches(&self, frame: usize) -> bool {
        let is_shifted = self.shifts.iter().any(|shifts| shifts.contains_key(&frame));
        !self.led.is_empty() || is_shifted || self.spans.iter().flatten().any(|span| span.holds(frame))
    }
}

impl Span {
    fn holds(&self, frame: usize) -> bool {
        (self.ends[0]..=self.ends[1]).contains(&frame)
    }

    /// The handle's transform at a frame where it has this place; `None` if it is not moved.
    pub(super) fn at(&self, frame: usize, place: &HandlePlace) -> Option<SplitTransform> {
        if !self.holds(frame) {
            return None;
        }
        let next = self.keys.partition_point(|key| key.frame <= frame);
        let (before, after) = (next.checked_sub(1).map(|key| &self.keys[key]), self.keys.get(next));
        // At a key this is its own transform, and a held one stays.
        let transform = match (before, after) {
            (Some(key), _) if key.frame == frame || key.ease == Ease::Hold => key.brought(place),
            (Some(key), Some(next)) => {
                let share = key.ease.share(part(frame, key.frame, next.frame));
                between(&key.brought(place), &next.brought(place), share)
            }
            (Some(key), None) => key.faded(place, part(frame, self.ends[1], key.frame)),
            (None, Some(key)) => key.faded(place, part(frame, self.ends[0], key.frame)),
            (None, None) => return None,
        };
        (!is_rest(&transform)).then_some(transform)
    }
}

impl SpanKey {
    /// The transform at another frame, where the handle has this place.
    fn brought(&self, place: &HandlePlace) -> SplitTransform {
        if *place == self.place {
            return self.transform;
        }
        let SplitTransform {
            pivot,
            translation,
            rotation,
            stretch,
        } = self.transform;
        let pivot = place.carried(pivot, &self.place);
        if self.space == KeySpace::World {
            return SplitTransform {
                pivot,
                ..self.transform
            };
        }
        let turn = place.rotation * self.place.rotation.inverse();
        let axes = DMat3::from_quat(turn);
        SplitTransform {
            pivot,
            translation: turn * translation,
            // A handle that is not turned stays so to the bit.
            rotation: match rotation.xyz() == DVec3::ZERO {
                true => rotation,
                false => (turn * rotation * turn.inverse()).normalize(),
            },
            stretch: match stretch == DMat3::IDENTITY {
                true => stretch,
                false => axes * stretch * axes.transpose(),
            },
        }
    }

    /// The same at a share of the way from rest.
    fn faded(&self, place: &HandlePlace, share: f64) -> SplitTransform {
        let brought = self.brought(place);
        if self.ease == Ease::Hold {
            return brought;
        }
        let rest = SplitTransform {
            pivot: brought.pivot,
            translation: DVec3::ZERO,
            rotation: DQuat::IDENTITY,
            stretch: DMat3::IDENTITY,
        };
        match share == 0.0 {
            true => rest,
            false => between(&rest, &brought, self.ease.share(share)),
        }
    }
}

impl Ease {
    /// The eased share of the way between two keys: it starts and ends without speed if it is smooth.
    fn share(self, part: f64) -> f64 {
        match self {
            Self::Hold => 0.0,
            Self::Linear => part,
            Self::Smooth => part * part * (3.0 - 2.0 * part),
        }
    }
}

/// The share of the way from one frame to another.
fn part(frame: usize, from: usize, to: usize) -> f64 {
    (frame as f64 - from as f64) / (to as f64 - from as f64)
}

fn is_rest(transform: &SplitTransform) -> bool {
    transform.translation == DVec3::ZERO
        && transform.rotation.xyz() == DVec3::ZERO
        && transform.stretch == DMat3::IDENTITY
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test that can't go on fails")]
mod tests {
    use super::*;

    fn place(frame: usize) -> HandlePlace {
        HandlePlace {
            centre: DVec3::new(frame as f64, 1.0, -2.0),
            rotation: DQuat::from_rotation_y(0.3 * frame as f64),
        }
    }

    fn key(frame: usize, ease: Ease, space: KeySpace, turn: f64) -> SpanKey {
        let transform = SplitTransform {
            pivot: place(frame).centre + DVec3::X,
            translation: DVec3::new(0.5, 0.0, 0.1),
            rotation: DQuat::from_rotation_x(turn),
            stretch: DMat3::from_diagonal(DVec3::new(1.0, 1.5, 1.0)),
        };
        SpanKey {
            frame,
            ease,
            space,
            place: place(frame),
            transform,
        }
    }

    fn span(ease: Ease, space: KeySpace) -> SequenceTimeline {
        let keys = vec![key(4, ease, space, 1.2), key(7, ease, space, -0.4)];
        SequenceTimeline {
            spans: vec![vec![Span { ends: [2, 12], keys }]],
            shifts: vec![BTreeMap::new()],
            led: BTreeMap::new(),
            strength: 1.0,
        }
    }

    #[test]
    fn every_ease_meets_its_keys_and_rests_outside_of_its_span() {
        for ease in [Ease::Hold, Ease::Linear, Ease::Smooth] {
            for space in [KeySpace::Local, KeySpace::World] {
                let timeline = span(ease, space);
                for (frame, turn) in [(4, 1.2), (7, -0.4)] {
                    let maps = timeline.maps_at(frame, &[place(frame)]).unwrap();
                    assert_eq!(maps[0], key(frame, ease, space, turn).transform.affine());
                }
                for frame in [0, 1, 13, 50] {
                    assert_eq!(timeline.maps_at(frame, &[place(frame)]), None);
                }
                let moves_at_ends = [2, 12].map(|frame| timeline.maps_at(frame, &[place(frame)]).is_some());
                assert_eq!(moves_at_ends, [ease == Ease::Hold; 2]);
            }
        }
    }

    #[test]
    fn a_local_key_is_the_same_to_a_handle_that_turns_and_a_world_key_to_the_world() {
        let relative = |frame: usize, space: KeySpace| {
            let map = span(Ease::Hold, space).maps_at(frame, &[place(frame)]).unwrap()[0];
            let own = DAffine3::from_rotation_translation(place(frame).rotation, place(frame).centre);
            (own.inverse() * map * own, map.matrix3)
        };
        let apart = |a: DMat3, b: DMat3| {
            (a - b)
                .to_cols_array()
                .iter()
                .fold(0.0, |most: f64, x| most.max(x.abs()))
        };
        let ((local, _), (_, world)) = (relative(4, KeySpace::Local), relative(4, KeySpace::World));
        for frame in [5, 6] {
            let (found, _) = relative(frame, KeySpace::Local);
            assert!(apart(found.matrix3, local.matrix3) < 1e-12);
            assert!(found.translation.distance(local.translation) < 1e-12);
            assert!(apart(relative(frame, KeySpace::World).1, world) < 1e-12);
        }
    }

    #[test]
    fn the_place_of_points_that_move_rigidly_is_their_motion() {
        let first: Vec<DVec3> = (0..9)
            .map(|k| DVec3::new(f64::from(k), f64::from(k * k % 5), f64::from(k % 3)))
            .collect();
        let turn = DQuat::from_euler(glam::EulerRot::XYZ, 0.4, -1.1, 2.0);
        let now: Vec<DVec3> = first.iter().map(|p| turn * *p + DVec3::new(7.0, 0.0, 3.0)).collect();
        let found = HandlePlace::of(&first, &now);
        assert!(found.rotation.dot(turn).abs() > 1.0 - 1e-12);
        let at_first = HandlePlace::of(&first, &first);
        // The fit holds points on a line by 1e-12 of their inertia.
        let off = found.carried(first[3], &at_first).distance(now[3]);
        assert!(off < 1e-11, "{off}");
    }
}
