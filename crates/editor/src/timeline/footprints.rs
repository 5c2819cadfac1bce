//! Footprints of a sequence: handles are held where they rest on the ground, so that they do not slide.

use std::collections::BTreeMap;

use glam::DVec3;

use super::followed::FollowedHandle;
use super::path::BodyMotion;
use crate::document::HandleFootprints;

/// The frames of a handle's footprints and those around them in which it goes over to its own way.
#[derive(Clone, PartialEq, Debug)]
pub struct Footprints {
    /// By frame.
    holds: BTreeMap<usize, Hold>,
    /// The number of footprints.
    count: usize,
}

/// The way in which a footprint holds a handle in one frame.
#[derive(Clone, Copy, PartialEq, Debug)]
struct Hold {
    /// The footprint's middle frame, whose shape the handle has.
    middle: usize,
    /// Beside the footprint: its nearest frame, and the share of the way from there to the middle frame's shape.
    fade: Option<(usize, f64)>,
}

impl Footprints {
    /// Finds the footprints of a handle, which was followed through all frames.
    pub fn of(entry: &HandleFootprints, frames: &[FollowedHandle]) -> Self {
        let runs = runs(entry, frames);
        let mut holds = BTreeMap::new();
        for (number, &(first, last)) in runs.iter().enumerate() {
            let middle = usize::midpoint(first, last);
            holds.extend((first..=last).map(|frame| (frame, Hold { middle, fade: None })));
            // Half of the frames up to the next footprint at most.
            let before = match number.checked_sub(1) {
                Some(previous) => (first - runs[previous].1 - 1) / 2,
                None => first,
            };
            let after = match runs.get(number + 1) {
                Some(next) => (next.0 - last - 1) / 2,
                None => frames.len() - 1 - last,
            };
            let length = entry.fade as usize;
            let sides = [(first, before.min(length), -1), (last, after.min(length), 1)];
            for (edge, length, direction) in sides {
                for step in 1..=length {
                    let frame = edge.saturating_add_signed(direction * step as isize);
                    let part = 1.0 - step as f64 / (length + 1) as f64;
                    let fade = Some((edge, part * part * (3.0 - 2.0 * part)));
                    holds.insert(frame, Hold { middle, fade });
                }
            }
        }
        Self {
            holds,
            count: runs.len(),
        }
    }

    /// The number of footprints.
    pub fn count(&self) -> usize {
        self.count
    }

    /// Returns true if the handle is held in a frame.
    pub fn hold(&self, frame: usize) -> bool {
        self.holds.contains_key(&frame)
    }

    /// The frames, beside a frame itself, in which the positions of the handle's vertices give its
    /// [`places`](Self::places) there.
    pub fn needed_in(&self, frame: usize) -> impl Iterator<Item = usize> {
        let hold = self.holds.get(&frame);
        let needed = hold.map(|hold| [Some(hold.middle), hold.fade.map(|(edge, _)| edge)]);
        let needed = needed.into_iter().flatten().flatten();
        needed.filter(move |needed| *needed != frame)
    }

    /// The places of the handle's vertices in a frame, in world space, where they are at `own` without its footprints.
    /// `shape_in` gives their positions in the frames that are [needed](Self::needed_in). If the `body` has motions, these
    /// carry every frame afterwards, and the handle rests then. `None` if it is not held, or if such a frame is not known.
    pub fn places<'s>(
        &self,
        frame: usize,
        own: &'s [DVec3],
        shape_in: impl Fn(usize) -> Option<&'s [DVec3]>,
        body: &[BodyMotion],
    ) -> Option<Vec<DVec3>> {
        let hold = self.holds.get(&frame)?;
        // The shape of another frame that the body's motion brings to where it is there.
        let brought = |from: usize| -> Option<Vec<DVec3>> {
            let shape = if from == frame { own } else { shape_in(from)? };
            Some(match (body.get(from), body.get(frame)) {
                (Some(first), Some(second)) if from != frame && (first.moves() || second.moves()) => {
                    let places = shape.iter();
                    places.map(|place| second.before(first.moved(*place))).collect()
                }
                _ => shape.to_vec(),
            })
        };
        let held = brought(hold.middle)?;
        let Some((edge, share)) = hold.fade else {
            return Some(held);
        };
        let at_edge = brought(edge)?;
        let pairs = own.iter().zip(held.iter().zip(&at_edge));
        let faded = pairs.map(|(own, (held, at_edge))| *own + (*held - *at_edge) * share);
        Some(faded.collect())
    }
}

/// The first and the last frame of each footprint: at least two frames, in which the handle is low and its middle nearly
/// rests from each to the next.
fn runs(entry: &HandleFootprints, frames: &[FollowedHandle]) -> Vec<(usize, usize)> {
    let up = entry.up.direction();
    let lowest: Vec<f64> = frames.iter().map(|frame| frame.lowest.dot(up)).collect();
    let ground = lowest.iter().copied().fold(f64::INFINITY, f64::min);
    let rests = |frame: usize| {
        let are_low = [frame, frame + 1]
            .iter()
            .all(|frame| lowest[*frame] <= ground + entry.height);
        let middle = |frame: usize| frames[frame].place.centre();
        are_low && middle(frame).distance(middle(frame + 1)) <= entry.speed
    };
    let mut runs: Vec<(usize, usize)> = Vec::new();
    for frame in (0..frames.len().saturating_sub(1)).filter(|frame| rests(*frame)) {
        match runs.last_mut() {
            Some((_, last)) if *last == frame => *last = frame + 1,
            _ => runs.push((frame, frame + 1)),
        }
    }
    runs
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test that can't go on fails")]
mod tests {
    use super::*;
    use crate::ground_axis::GroundAxis;

    #[test]
    fn a_foot_is_held_where_it_is_low_and_slow_and_fades_between() {
        let at = |frame: usize| match frame {
            // It creeps, swings, and creeps again.
            0..=3 => DVec3::new(0.01 * frame as f64, 0.0, 0.0),
            4..=9 => DVec3::new(0.3 * (frame - 3) as f64, 0.5, 0.0),
            _ => DVec3::new(2.0 + 0.01 * frame as f64, 0.001, 0.0),
        };
        let shapes: Vec<Vec<DVec3>> = (0..14).map(|frame| vec![at(frame), at(frame) + DVec3::Y]).collect();
        let followed: Vec<FollowedHandle> = shapes
            .iter()
            .map(|shape| FollowedHandle::of(&shapes[0], shape))
            .collect();
        let entry = HandleFootprints {
            up: GroundAxis::Y,
            height: 0.01,
            speed: 0.02,
            fade: 9,
        };
        let found = Footprints::of(&entry, &followed);
        assert_eq!(found.count(), 2);
        let places = |frame: usize| found.places(frame, &shapes[frame], |other| Some(&shapes[other]), &[]);
        for (run, middle) in [(0..=3, 1), (10..=13, 11)] {
            assert!(
                run.clone().all(|frame| places(frame).as_ref() == Some(&shapes[middle])),
                "{run:?}"
            );
        }
        // Six frames between them: three for each.
        let off = |frame: usize| places(frame).unwrap()[0].distance(shapes[frame][0]);
        assert!(off(4) > off(5) && off(5) > off(6) && off(6) > 0.0);
        assert!(off(9) > off(8) && off(8) > off(7) && off(7) > 0.0);
        // A frame needs the shapes of two others at most.
        let needed = |frame: usize| found.needed_in(frame).collect::<Vec<usize>>();
        assert_eq!([0, 1, 5, 8].map(needed), [vec![1], vec![], vec![1, 3], vec![11, 10]]);
        let never = HandleFootprints { speed: 1e-9, ..entry };
        let found = Footprints::of(&never, &followed);
        assert!((0..14).all(|frame| !found.hold(frame)));
    }
}
