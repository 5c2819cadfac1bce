//! The triangles of a tube between two borders.
//!
//! Its axis is a cubic that leaves the first border along the normal of the hole and enters the second one against its
//! normal. A frame is carried along the axis without a twist, so each ring is a mean of both borders in that frame. The
//! thin plate alone would not do: its solution on a tube shrinks towards the axis within about a radius, so only the
//! rings near the borders are faired (`fair`), which makes the tangents continuous there.

use std::f64::consts::TAU;

use glam::{DQuat, DVec3};

use crate::borders::edge_lengths;

/// The number of points at which the borders are compared.
const SAMPLES: usize = 96;

/// The most points of a tube.
const MOST_POINTS: f64 = 120_000.0;

/// The distance from a border, in mean radii of it, up to which the tube is faired.
const FAIRED: f64 = 0.75;

/// A tube: rings of points between the borders.
pub(super) struct Tube {
    /// The points inside, ring after ring.
    pub points: Vec<DVec3>,
    /// Corners below the count of the borders' points are these, in the order in which they were given.
    pub triangles: Vec<[u32; 3]>,
    /// Whether each point inside is near to a border.
    pub is_near_border: Vec<bool>,
}

impl Tube {
    /// The tube between the first `count` points and the others, each a closed line with the hole on its left. Its edges
    /// are about as long as `spacing`.
    pub fn between(points: &[DVec3], count: usize, spacing: f64) -> Self {
        let first = Line::of(&points[..count], 0);
        // In the opposite direction, so that both run the same way around the tube.
        let reversed: Vec<DVec3> = points[count..].iter().rev().copied().collect();
        let axis = Axis::between(&first, &Line::of(&reversed, 0));
        let around = (1.0 / spacing.max(f64::MIN_POSITIVE)) * axis.length();
        let widest = count.max(reversed.len());
        let rings = around.min(MOST_POINTS / widest as f64).round().max(2.0) as usize - 1;
        let frames = axis.frames(rings + 2);
        let start = nearest_start(&first, &reversed, frames[rings + 1]);
        let second = Line::of(&reversed, start);
        let back = frames[rings + 1].inverse();

        let ring = |number: usize| {
            let share = number as f64 / (rings + 1) as f64;
            let (middle, frame) = (axis.point(share), frames[number]);
            let on_ring = |k: usize| {
                let around = k as f64 / widest as f64;
                let [own, other] = [&first, &second].map(|line| line.point(around) - line.middle);
                middle + frame * own.lerp(back * other, share)
            };
            (0..widest).map(on_ring).collect::<Vec<DVec3>>()
        };
        let inside: Vec<DVec3> = (1..=rings).flat_map(ring).collect();

        let given = points.len() as u32;
        let of_ring = |number: usize| -> Vec<(u32, f64)> {
            let own = 0..widest;
            let place = |k: usize| given + ((number - 1) * widest + k) as u32;
            own.map(|k| (place(k), k as f64 / widest as f64)).collect()
        };
        let of_first: Vec<(u32, f64)> = (0..count).map(|k| (k as u32, first.share(k))).collect();
        let number = |k: usize| (points.len() - 1 - (start + k) % reversed.len()) as u32;
        let of_second: Vec<(u32, f64)> = (0..reversed.len()).map(|k| (number(k), second.share(k))).collect();
        let mut triangles = Vec::new();
        zip(&of_first, &of_ring(1), &mut triangles);
        for number in 1..rings {
            zip(&of_ring(number), &of_ring(number + 1), &mut triangles);
        }
        zip(&of_ring(rings), &of_second, &mut triangles);
        let reach = |line: &Line| (FAIRED * line.length() / TAU / spacing).ceil().max(1.0) as usize;
        let [from_first, from_second] = [reach(&first), reach(&second)];
        let is_near = |number: usize| number <= from_first || rings + 1 - number <= from_second;
        Self {
            points: inside,
            triangles,
            is_near_border: (1..=rings).flat_map(|number| vec![is_near(number); widest]).collect(),
        }
    }
}

/// The strip between two closed lines of points, each with its share of the way around, from 0 on.
fn zip(first: &[(u32, f64)], second: &[(u32, f64)], triangles: &mut Vec<[u32; 3]>) {
    let at = |line: &[(u32, f64)], k: usize| line[k % line.len()].0;
    let share = |line: &[(u32, f64)], k: usize| line.get(k).map_or(1.0, |(_, share)| *share);
    let (mut i, mut j) = (0, 0);
    while i < first.len() || j < second.len() {
        let is_first_behind = share(first, i + 1) <= share(second, j + 1);
        if j == second.len() || (i < first.len() && is_first_behind) {
            triangles.push([at(first, i), at(first, i + 1), at(second, j)]);
            i += 1;
        } else {
            triangles.push([at(first, i), at(second, j + 1), at(second, j)]);
            j += 1;
        }
    }
}

/// The point of the second line that belongs to the first point of the first, if a frame turns by `turn` in between.
fn nearest_start(first: &Line, second: &[DVec3], turn: DQuat) -> usize {
    let second = Line::of(second, 0);
    let around: Vec<DVec3> = first.samples(0.0).map(|point| turn * (point - first.middle)).collect();
    let apart = |start: usize| {
        let others = second.samples(second.share(start)).map(|point| point - second.middle);
        around
            .iter()
            .zip(others)
            .map(|(a, b)| a.distance_squared(b))
            .sum::<f64>()
    };
    let all = (0..second.points.len()).map(|start| (apart(start), start));
    let best = all.min_by(|a, b| a.0.total_cmp(&b.0));
    best.map_or(0, |(_, start)| start)
}

/// The axis of a tube: a cubic with given ends and directions.
struct Axis {
    ends: [DVec3; 2],
    ways: [DVec3; 2],
    /// The normal of the first line, from which the frame is carried.
    normal: DVec3,
}

impl Axis {
    fn between(first: &Line, second: &Line) -> Self {
        let apart = first.middle.distance(second.middle);
        Self {
            ends: [first.middle, second.middle],
            // The reversed line's normal points along the tube already.
            ways: [first.normal * apart, second.normal * apart],
            normal: first.normal,
        }
    }

    fn point(&self, t: f64) -> DVec3 {
        let ([from, to], [out, into]) = (self.ends, self.ways);
        let s = 1.0 - t;
        from * (s * s * (1.0 + 2.0 * t)) + out * (s * s * t) + to * (t * t * (3.0 - 2.0 * t)) - into * (t * t * s)
    }

    fn length(&self) -> f64 {
        let points: Vec<DVec3> = (0..=SAMPLES).map(|k| self.point(k as f64 / SAMPLES as f64)).collect();
        points.windows(2).map(|pair| pair[0].distance(pair[1])).sum()
    }

    /// The turns of the frame at `count` equal steps.
    fn frames(&self, count: usize) -> Vec<DQuat> {
        let mut frames = vec![DQuat::IDENTITY];
        let mut direction = self.normal;
        for step in 1..count {
            let [before, here] = [step as f64 - 0.5, step as f64].map(|step| step / (count - 1) as f64);
            let next = match step + 1 == count {
                true => self.ways[1],
                false => self.point(here + 0.5 / (count - 1) as f64) - self.point(before),
            };
            let last = frames[step - 1];
            frames.push(match (direction.try_normalize(), next.try_normalize()) {
                (Some(from), Some(to)) => {
                    direction = to;
                    DQuat::from_rotation_arc(from, to) * last
                }
                _ => last,
            });
        }
        frames
    }
}

/// A closed line.
struct Line {
    points: Vec<DVec3>,
    /// The way along the line to each point, and the line's length.
    ways: Vec<f64>,
    middle: DVec3,
    /// The unit normal of a surface inside, seen with the line counterclockwise.
    normal: DVec3,
}

impl Line {
    /// The line from the point `start` on.
    fn of(points: &[DVec3], start: usize) -> Self {
        let mut points = points.to_vec();
        points.rotate_left(start);
        let mut ways = vec![0.0];
        for length in edge_lengths(&points) {
            ways.push(ways[ways.len() - 1] + length);
        }
        let middle = points.iter().sum::<DVec3>() / points.len() as f64;
        let arms = (0..points.len()).map(|k| [points[k] - middle, points[(k + 1) % points.len()] - middle]);
        Self {
            middle,
            normal: arms.map(|[a, b]| a.cross(b)).sum::<DVec3>().normalize_or_zero(),
            points,
            ways,
        }
    }

    fn length(&self) -> f64 {
        self.ways[self.points.len()]
    }

    /// The share of the line before a point.
    fn share(&self, place: usize) -> f64 {
        self.ways[place] / self.length().max(f64::MIN_POSITIVE)
    }

    /// The point at a share of the line.
    fn point(&self, share: f64) -> DVec3 {
        let (way, count) = (share * self.length(), self.points.len());
        let edge = self.ways.partition_point(|own| *own <= way).clamp(1, count) - 1;
        let within = (way - self.ways[edge]) / (self.ways[edge + 1] - self.ways[edge]).max(f64::MIN_POSITIVE);
        self.points[edge].lerp(self.points[(edge + 1) % count], within.clamp(0.0, 1.0))
    }

    /// Points at equal distances along the line, from this share of it on.
    fn samples(&self, from: f64) -> impl Iterator<Item = DVec3> + '_ {
        (0..SAMPLES).map(move |k| self.point((from + k as f64 / SAMPLES as f64).fract()))
    }
}
