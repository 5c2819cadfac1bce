//! The path of a body through a sequence, bent by moving it at some frames.
//!
//! A smooth path runs through the body's own places at those frames, and a bent one through the moved places, at the same
//! times. In each frame the body goes along from the one to the other: it keeps its place beside the path, and turns
//! about the upright axis by the angle between both headings [XZY+07]. So it stays upright, and its own sway stays.

use std::f64::consts::TAU;

use glam::{DQuat, DVec3};

use super::spline::{KeyRates, hermite};

/// A path is level, or the body rests on it, below this share of its mean speed.
const LEAST_SPEED: f64 = 1e-6;

/// A body stays in place if its own path is shorter than this share of the bent one: it has no heading then.
const LEAST_WAY: f64 = 1e-2;

/// The rigid motion of a whole body in one frame.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct BodyMotion {
    /// The point on the body's own path.
    from: DVec3,
    /// The way from there to the bent path.
    shift: DVec3,
    turn: DQuat,
}

impl BodyMotion {
    /// The motion that moves nothing.
    pub(crate) const STILL: Self = Self {
        from: DVec3::ZERO,
        shift: DVec3::ZERO,
        turn: DQuat::IDENTITY,
    };

    /// The turn about the upright axis.
    pub(crate) fn turn(&self) -> DQuat {
        self.turn
    }

    /// Returns true if it moves anything.
    pub fn moves(&self) -> bool {
        self.shift != DVec3::ZERO || self.turn != DQuat::IDENTITY
    }

    /// The place of a point.
    pub fn moved(&self, point: DVec3) -> DVec3 {
        match self.turn == DQuat::IDENTITY {
            true => point + self.shift,
            false => self.from + self.turn * (point - self.from) + self.shift,
        }
    }

    /// The point whose place is this.
    pub fn before(&self, place: DVec3) -> DVec3 {
        match self.turn == DQuat::IDENTITY {
            true => place - self.shift,
            false => self.from + self.turn.inverse() * (place - self.shift - self.from),
        }
    }
}

/// The motions of a body whose middle is at `trajectory` in each frame, if it is shifted by `shifts` at some frames,
/// which ascend and are frames of the trajectory. Before the first of them and after the last it moves as there. `up` has
/// length 1.
pub(crate) fn body_motions(trajectory: &[DVec3], shifts: &[(usize, DVec3)], up: DVec3) -> Vec<BodyMotion> {
    let own: Vec<(usize, DVec3)> = shifts.iter().map(|(frame, _)| (*frame, trajectory[*frame])).collect();
    let bent: Vec<(usize, DVec3)> = own
        .iter()
        .zip(shifts)
        .map(|((frame, place), (_, shift))| (*frame, *place + *shift))
        .collect();
    let Some((first, last)) = shifts.first().zip(shifts.last()).map(|(a, b)| (a.0, b.0)) else {
        return Vec::new();
    };
    let along = |path: &[(usize, DVec3)]| -> Vec<(DVec3, DVec3)> {
        let rates = rates(path);
        (first..=last).map(|frame| at(path, &rates, frame)).collect()
    };
    let (along_own, along_bent) = (along(&own), along(&bent));
    let turns = headings(&along_own, &along_bent, up);
    let motion = |frame: usize| {
        let place = frame.clamp(first, last) - first;
        let from = along_own[place].0;
        BodyMotion {
            from,
            shift: along_bent[place].0 - from,
            turn: match turns[place] {
                0.0 => DQuat::IDENTITY,
                turn => DQuat::from_axis_angle(up, turn),
            },
        }
    };
    (0..trajectory.len()).map(motion).collect()
}

/// The rates at the places of a path, per frame. At an end the path goes on as the parabola through the last three places.
fn rates(path: &[(usize, DVec3)]) -> Vec<DVec3> {
    let slope = |place: usize| {
        let ((from, a), (to, b)) = (path[place], path[place + 1]);
        (b - a) / (to - from) as f64
    };
    let inner = |place: usize| {
        let [a, b, c] = [path[place - 1], path[place], path[place + 1]];
        KeyRates::of([a.0, b.0, c.0].map(|frame| frame as f64)).of_vector(a.1, b.1, c.1)
    };
    let last = path.len() - 1;
    let rate = |place: usize| match place {
        _ if last == 0 => DVec3::ZERO,
        0 if last == 1 => slope(0),
        0 => 2.0 * slope(0) - inner(1),
        _ if place == last && last == 1 => slope(0),
        _ if place == last => 2.0 * slope(last - 1) - inner(last - 1),
        _ => inner(place),
    };
    (0..=last).map(rate).collect()
}

/// The place and the rate of a path at a frame, which is not before its first place or after its last.
fn at(path: &[(usize, DVec3)], rates: &[DVec3], frame: usize) -> (DVec3, DVec3) {
    let next = path.partition_point(|(own, _)| *own <= frame);
    let place = next - 1;
    let (from, a) = path[place];
    let Some((to, b)) = path.get(next) else {
        return (a, rates[place]);
    };
    if frame == from {
        return (a, rates[place]);
    }
    let span = (to - from) as f64;
    let share = (frame - from) as f64 / span;
    let ways = [a, *b, rates[place] * span, rates[next] * span];
    let sum = |basis: [f64; 4]| ways.iter().zip(basis).map(|(way, share)| *way * share).sum::<DVec3>();
    // The derivatives of the Hermite polynomials.
    let square = share * share;
    let slopes = [
        6.0 * (square - share),
        6.0 * (share - square),
        3.0 * square - 4.0 * share + 1.0,
        3.0 * square - 2.0 * share,
    ];
    (sum(hermite(share)), sum(slopes) / span)
}

/// The angle from the heading of one path to that of the other in each frame, about `up`. Where one of them rests or is
/// steep, it is between those of the frames around.
fn headings(own: &[(DVec3, DVec3)], bent: &[(DVec3, DVec3)], up: DVec3) -> Vec<f64> {
    let level = |rate: DVec3| rate - up * rate.dot(up);
    let way = |path: &[(DVec3, DVec3)]| path.iter().map(|(_, rate)| level(*rate).length()).sum::<f64>();
    let (own_way, bent_way) = (way(own), way(bent));
    if own_way <= LEAST_WAY * bent_way {
        return vec![0.0; own.len()];
    }
    let count = own.len() as f64;
    let angle = |((_, from), (_, to)): (&(DVec3, DVec3), &(DVec3, DVec3))| {
        let (from, to) = (level(*from), level(*to));
        let goes = from.length() > LEAST_SPEED * own_way / count && to.length() > LEAST_SPEED * bent_way / count;
        goes.then(|| from.cross(to).dot(up).atan2(from.dot(to)))
    };
    // The known ones, each within half a turn of the one before.
    let mut known: Vec<(usize, f64)> = Vec::new();
    for (place, angle) in own.iter().zip(bent).map(angle).enumerate() {
        let Some(angle) = angle else { continue };
        let turns = known.last().map_or(0.0, |(_, before)| ((before - angle) / TAU).round());
        known.push((place, angle + turns * TAU));
    }
    let between = |place: usize| {
        let next = known.partition_point(|(own, _)| *own <= place);
        match (next.checked_sub(1).map(|before| known[before]), known.get(next)) {
            (Some((from, a)), Some((to, b))) => a + (b - a) * ((place - from) as f64 / (to - from) as f64),
            (Some((_, angle)), None) | (None, Some(&(_, angle))) => angle,
            (None, None) => 0.0,
        }
    };
    (0..own.len()).map(between).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Straight ahead, swaying and bobbing, with ten frames a step.
    fn walk() -> Vec<DVec3> {
        let at = |frame: f64| {
            DVec3::new(
                0.1 * frame,
                1.0 + 0.02 * (0.8 * frame).cos(),
                0.03 * (TAU * frame / 10.0).sin(),
            )
        };
        (0..61).map(|frame| at(f64::from(frame))).collect()
    }

    #[test]
    fn a_path_at_rest_moves_nothing_and_neither_do_places_that_keep_theirs() {
        let rest: Vec<_> = [0, 20, 45].map(|frame| (frame, DVec3::ZERO)).to_vec();
        assert!(
            body_motions(&walk(), &rest, DVec3::Y)
                .iter()
                .all(|motion| !motion.moves())
        );
        let moved: Vec<_> = [0, 10, 20, 30, 60]
            .map(|frame| (frame, DVec3::Z * if frame == 60 { 1.0 } else { 0.0 }))
            .to_vec();
        let motions = body_motions(&walk(), &moved, DVec3::Y);
        assert!(motions[..=20].iter().all(|motion| !motion.moves()));
        assert!(motions[25..].iter().all(BodyMotion::moves));
    }

    #[test]
    fn a_body_goes_through_the_moved_places_turns_with_the_path_and_stays_upright() {
        let walk = walk();
        // A straight way ahead becomes a quarter of a circle.
        let radius = 6.0 / (TAU / 4.0);
        let shifts: Vec<_> = (0..=6)
            .map(|k| {
                let (frame, angle) = (10 * k, f64::from(k as u32) * TAU / 24.0);
                let on_circle = DVec3::new(radius * angle.sin(), 0.0, radius * (1.0 - angle.cos()));
                (frame, on_circle - DVec3::X * 0.1 * frame as f64)
            })
            .collect();
        let motions = body_motions(&walk, &shifts, DVec3::Y);
        for (frame, shift) in &shifts {
            let moved = motions[*frame].moved(walk[*frame]);
            assert!(moved.distance(walk[*frame] + *shift) < 1e-12);
        }
        for (frame, motion) in motions.iter().enumerate() {
            let turned = motion.moved(walk[frame] + DVec3::X) - motion.moved(walk[frame]);
            let angle = TAU / 4.0 * frame as f64 / 60.0;
            let heading = DVec3::new(angle.cos(), 0.0, angle.sin());
            assert!(turned.angle_between(heading) < 0.01, "{frame}: {turned}");
            let upright = motion.moved(walk[frame] + DVec3::Y) - motion.moved(walk[frame]);
            assert!(upright.distance(DVec3::Y) < 1e-12);
            assert!(motion.before(motion.moved(DVec3::X)).distance(DVec3::X) < 1e-12);
        }
    }

    #[test]
    fn a_body_that_stays_in_place_is_moved_without_a_turn() {
        let place: Vec<DVec3> = (0..30)
            .map(|frame| DVec3::Z * 1e-3 * (f64::from(frame)).sin())
            .collect();
        let shifts = [(0, DVec3::ZERO), (29, DVec3::X)];
        for motion in body_motions(&place, &shifts, DVec3::Y) {
            assert_eq!(motion.turn, DQuat::IDENTITY);
        }
    }

    #[test]
    fn a_turn_of_the_whole_turns_the_motions() {
        let spin = DQuat::from_rotation_y(2.0);
        let walk = walk();
        let shifts = [(0, DVec3::ZERO), (25, DVec3::new(0.4, 0.1, 1.0)), (60, DVec3::Z)];
        let turned: Vec<DVec3> = walk.iter().map(|place| spin * *place).collect();
        let motions = body_motions(&walk, &shifts, DVec3::Y);
        let of_turned = body_motions(&turned, &shifts.map(|(frame, shift)| (frame, spin * shift)), DVec3::Y);
        let point = DVec3::new(0.3, 2.0, -1.0);
        for (own, other) in motions.iter().zip(&of_turned) {
            assert!((spin * own.moved(point)).distance(other.moved(spin * point)) < 1e-12);
        }
    }
}
