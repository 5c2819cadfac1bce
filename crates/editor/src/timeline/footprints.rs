//! Footprints of a sequence: handles are held where they rest on the ground, so that they do not slide.

use std::collections::BTreeMap;

use glam::DVec3;

use super::middle::middle_of;
use super::path::BodyMotion;
use crate::document::HandleFootprints;

/// The places of a handle's vertices in the frames of its footprints and around them, and the number of footprints.
#[derive(Clone, Debug)]
pub struct Footprints {
    /// By frame, in the order of the vertices, in world space.
    pub places: BTreeMap<usize, Vec<DVec3>>,
    /// The number of footprints.
    pub count: usize,
}

impl Footprints {
    /// Finds the footprints of a handle. `shapes` has the positions of its vertices in every frame. If the `body` has
    /// motions, these carry every frame afterwards, and the handle rests then.
    pub fn of(entry: &HandleFootprints, shapes: &[Vec<DVec3>], body: &[BodyMotion]) -> Self {
        let runs = runs(entry, shapes);
        // A shape in one frame that the body's motion brings to the place of another frame's shape.
        let brought = |from: usize, to: usize| -> Vec<DVec3> {
            match (body.get(from), body.get(to)) {
                (Some(first), Some(second)) if from != to && (first.moves() || second.moves()) => {
                    let places = shapes[from].iter();
                    places.map(|place| second.before(first.moved(*place))).collect()
                }
                _ => shapes[from].clone(),
            }
        };
        let mut places = BTreeMap::new();
        for (number, &(first, last)) in runs.iter().enumerate() {
            let middle = usize::midpoint(first, last);
            for frame in first..=last {
                places.insert(frame, brought(middle, frame));
            }
            // Half of the frames up to the next footprint at most.
            let before = match number.checked_sub(1) {
                Some(previous) => (first - runs[previous].1 - 1) / 2,
                None => first,
            };
            let after = match runs.get(number + 1) {
                Some(next) => (next.0 - last - 1) / 2,
                None => shapes.len() - 1 - last,
            };
            let fade = entry.fade as usize;
            let sides = [(first, before.min(fade), -1), (last, after.min(fade), 1)];
            for (edge, length, direction) in sides {
                for step in 1..=length {
                    let frame = edge.saturating_add_signed(direction * step as isize);
                    let part = 1.0 - step as f64 / (length + 1) as f64;
                    let share = part * part * (3.0 - 2.0 * part);
                    let (held, at_edge) = (brought(middle, frame), brought(edge, frame));
                    let pairs = shapes[frame].iter().zip(held.iter().zip(&at_edge));
                    let faded = pairs.map(|(own, (held, at_edge))| *own + (*held - *at_edge) * share);
                    places.insert(frame, faded.collect());
                }
            }
        }
        Self {
            places,
            count: runs.len(),
        }
    }
}

/// The first and the last frame of each footprint: at least two frames, in which the handle is low and its middle nearly
/// rests from each to the next.
fn runs(entry: &HandleFootprints, shapes: &[Vec<DVec3>]) -> Vec<(usize, usize)> {
    let up = entry.up.direction();
    let height = |position: &DVec3| position.dot(up);
    let lowest: Vec<f64> = shapes
        .iter()
        .map(|shape| shape.iter().map(height).fold(f64::INFINITY, f64::min))
        .collect();
    let ground = lowest.iter().copied().fold(f64::INFINITY, f64::min);
    let rests = |frame: usize| {
        let are_low = [frame, frame + 1]
            .iter()
            .all(|frame| lowest[*frame] <= ground + entry.height);
        are_low && middle_of(&shapes[frame]).distance(middle_of(&shapes[frame + 1])) <= entry.speed
    };
    let mut runs: Vec<(usize, usize)> = Vec::new();
    for frame in (0..shapes.len().saturating_sub(1)).filter(|frame| rests(*frame)) {
        match runs.last_mut() {
            Some((_, last)) if *last == frame => *last = frame + 1,
            _ => runs.push((frame, frame + 1)),
        }
    }
    runs
}

#[cfg(test)]
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
        let entry = HandleFootprints {
            up: GroundAxis::Y,
            height: 0.01,
            speed: 0.02,
            fade: 9,
        };
        let found = Footprints::of(&entry, &shapes, &[]);
        assert_eq!(found.count, 2);
        for (run, middle) in [(0..=3, 1), (10..=13, 11)] {
            assert!(
                run.clone().all(|frame| found.places[&frame] == shapes[middle]),
                "{run:?}"
            );
        }
        // Six frames between them: three for each.
        let off = |frame: usize| found.places[&frame][0].distance(shapes[frame][0]);
        assert!(off(4) > off(5) && off(5) > off(6) && off(6) > 0.0);
        assert!(off(9) > off(8) && off(8) > off(7) && off(7) > 0.0);
        let never = HandleFootprints { speed: 1e-9, ..entry };
        assert!(Footprints::of(&never, &shapes, &[]).places.is_empty());
    }
}
