//! The curves between a curve at rest and its target: turns are turns, so that nothing shrinks on the way.

use glam::{DQuat, DVec3};

use super::motion::{CurveMotion, STILL};

/// The way of a curve's control points from rest to their targets.
///
/// Each chord turns about a fixed axis by a share of its whole turn and changes its length linearly. Turns are counted
/// along the curve from the chord that turns least, so that a curve which is bent into a circle turns its far end by 300
/// degrees rather than by 60 the other way.
#[derive(Clone, PartialEq, Debug)]
pub struct CurvePath {
    rest: Vec<DVec3>,
    moved: Vec<DVec3>,
    /// The chords at rest, and the places of their ends.
    chords: Vec<DVec3>,
    places: Vec<f64>,
    /// The whole turn of each chord, axis times angle in radians, and the ratio of its lengths.
    turns_rad: Vec<DVec3>,
    ratios: Vec<f64>,
    is_closed: bool,
    largest_twist_rad: f64,
}

impl CurvePath {
    /// The way of this motion.
    pub fn of(motion: &CurveMotion) -> Self {
        let (rest, moved) = (motion.rest(), motion.moved());
        let chords = rest.chords();
        let places = rest.point_places();
        let turn = |(chord, (from, to)): (usize, (&DVec3, &DVec3))| {
            let turn = motion.turn_at(0.5 * (places[chord] + places[chord + 1]));
            DQuat::from_rotation_arc((turn * *from).normalize(), to.normalize()) * turn
        };
        let moved_chords = moved.chords();
        let pairs = || chords.iter().zip(&moved_chords);
        let turns: Vec<DVec3> = pairs().enumerate().map(turn).map(scaled_axis).collect();
        let twists = places.iter().map(|place| motion.twist_at(*place).abs());
        Self {
            ratios: pairs().map(|(from, to)| to.length() / from.length()).collect(),
            largest_twist_rad: twists.fold(0.0, f64::max),
            turns_rad: counted(turns),
            chords,
            places,
            is_closed: rest.is_closed(),
            rest: rest.points().to_vec(),
            moved: moved.points().to_vec(),
        }
    }

    /// The control points at the share `t` of the way, 0 at rest and 1 at their targets, to the bit.
    pub fn points_at(&self, t: f64) -> Vec<DVec3> {
        if t == 0.0 || self.rest == self.moved {
            return self.rest.clone();
        }
        if t == 1.0 {
            return self.moved.clone();
        }
        let mut chords: Vec<DVec3> = self.chords.clone();
        for (chord, (turn, ratio)) in chords.iter_mut().zip(self.turns_rad.iter().zip(&self.ratios)) {
            *chord = DQuat::from_scaled_axis(*turn * t) * *chord * (1.0 + (ratio - 1.0) * t);
        }
        if self.is_closed {
            let gap = chords.iter().sum::<DVec3>() / chords.len() as f64;
            chords.iter_mut().for_each(|chord| *chord -= gap);
        }
        let mut points = vec![self.rest[0]];
        for chord in &chords[..self.rest.len() - 1] {
            points.push(points[points.len() - 1] + *chord);
        }
        self.anchor(&mut points, t);
        points
    }

    /// The largest turn or twist of a part of it, in radians; full turns count.
    pub fn largest_turn_rad(&self) -> f64 {
        let turns = self.turns_rad.iter().map(|turn| turn.length());
        turns.fold(0.0, f64::max) + self.largest_twist_rad
    }

    /// The turn with which the surroundings of a place have come from rest, axis times angle in radians; full turns count.
    /// `motion` is the one whose way this is: first its frame turns, then the twist about the moved tangent adds up.
    pub fn turn_rad(&self, motion: &CurveMotion, place: f64) -> DVec3 {
        let after = self.places.partition_point(|end| *end <= place);
        let chord = after.clamp(1, self.turns_rad.len()) - 1;
        let frame = motion.turn_at(place);
        let tangent = frame * motion.rest().frame(place).z_axis;
        near(scaled_axis(frame), self.turns_rad[chord]) + tangent * motion.twist_at(place)
    }

    /// Moves the points so that those which move little are where they move on a straight way.
    fn anchor(&self, points: &mut [DVec3], t: f64) {
        let size = self.chords.iter().map(|chord| chord.length_squared()).sum::<f64>();
        let (mut shift, mut sum) = (DVec3::ZERO, 0.0);
        for (point, (rest, moved)) in points.iter().zip(self.rest.iter().zip(&self.moved)) {
            let weight = 1.0 / (STILL + moved.distance_squared(*rest) / size);
            shift += (rest.lerp(*moved, t) - *point) * weight;
            sum += weight;
        }
        let shift = shift / sum;
        points.iter_mut().for_each(|point| *point += shift);
    }
}

/// Axis times angle, which is at most half a turn.
fn scaled_axis(turn: DQuat) -> DVec3 {
    let short = if turn.w < 0.0 { -turn } else { turn };
    short.to_scaled_axis()
}

/// The same turns with full turns added, so that each is as near as possible to its neighbour, from the least on.
fn counted(mut turns: Vec<DVec3>) -> Vec<DVec3> {
    let each = turns.iter().map(|turn| turn.length()).enumerate();
    let (start, _) = each.fold(
        (0, f64::INFINITY),
        |least, own| if own.1 < least.1 { own } else { least },
    );
    for next in start + 1..turns.len() {
        turns[next] = near(turns[next], turns[next - 1]);
    }
    for next in (0..start).rev() {
        turns[next] = near(turns[next], turns[next + 1]);
    }
    turns
}

/// The same turn with full turns added, so that it is as near as possible to `other`.
fn near(turn: DVec3, other: DVec3) -> DVec3 {
    let axis = turn.try_normalize().unwrap_or_else(|| other.normalize_or_zero());
    let full = (axis.dot(other - turn) / std::f64::consts::TAU).round();
    turn + axis * (full * std::f64::consts::TAU)
}
