//! The first triangles of a tube between two borders: a strip, in which both advance by their arc length.
//!
//! The tube leaves the first border along the normal of the hole, runs to the second one, and enters that against its
//! normal. A frame that is carried along this way without a twist tells which points belong together.

use glam::{DQuat, DVec3};

use super::rim::Joined;
use crate::borders::edge_lengths;

/// The number of points at which the borders are compared.
const SAMPLES: usize = 96;

/// The triangles of the strip between the first `count` points and the others, each a closed line with the hole on its
/// left. `None` if the surface already joins points that the strip would join.
pub(super) fn strip(points: &[DVec3], count: usize, joined: &Joined) -> Option<Vec<[u32; 3]>> {
    let first = Line::of(&points[..count]);
    // In the opposite direction, so that both run the same way around the tube.
    let reversed: Vec<DVec3> = points[count..].iter().rev().copied().collect();
    let second = Line::of(&reversed);
    let turn = carried(&first, &second);
    let around: Vec<DVec3> = first.samples(0).map(|point| turn * (point - first.middle)).collect();
    let apart = |start: usize| {
        let others = second.samples(start).map(|point| point - second.middle);
        around
            .iter()
            .zip(others)
            .map(|(a, b)| a.distance_squared(b))
            .sum::<f64>()
    };
    let nearest = (0..second.points.len())
        .map(|start| (apart(start), start))
        .min_by(|a, b| a.0.total_cmp(&b.0))?;
    let start = nearest.1;

    let (n, m) = (first.points.len(), second.points.len());
    let last = points.len() - 1;
    let on_first = |i: usize| (i % n) as u32;
    let on_second = |j: usize| (last - (start + j) % m) as u32;
    let share = |line: &Line, origin: usize, step: usize| {
        let way = line.ways[(origin + step) % line.points.len()] - line.ways[origin];
        match step == line.points.len() {
            true => 1.0,
            false => way.rem_euclid(line.length()) / line.length(),
        }
    };
    if joined.contains(on_first(0), on_second(0)) {
        return None;
    }
    let (mut i, mut j) = (0, 0);
    let mut triangles = Vec::with_capacity(n + m);
    while i < n || j < m {
        let may_first = i < n && !joined.contains(on_first(i + 1), on_second(j));
        let may_second = j < m && !joined.contains(on_first(i), on_second(j + 1));
        let is_first_behind = j == m || (i < n && share(&first, 0, i + 1) <= share(&second, start, j + 1));
        if may_first && (is_first_behind || !may_second) {
            triangles.push([on_first(i), on_first(i + 1), on_second(j)]);
            i += 1;
        } else if may_second {
            triangles.push([on_first(i), on_second(j + 1), on_second(j)]);
            j += 1;
        } else {
            return None;
        }
    }
    Some(triangles)
}

/// A closed line.
struct Line {
    points: Vec<DVec3>,
    /// The way along the line to each point, and the line's length.
    ways: Vec<f64>,
    middle: DVec3,
    /// The unit normal of the surface that would fill it, seen with the line counterclockwise.
    normal: DVec3,
}

impl Line {
    fn of(points: &[DVec3]) -> Self {
        let mut ways = vec![0.0];
        for length in edge_lengths(points) {
            ways.push(ways[ways.len() - 1] + length);
        }
        let middle = points.iter().sum::<DVec3>() / points.len() as f64;
        let arms = (0..points.len()).map(|k| [points[k] - middle, points[(k + 1) % points.len()] - middle]);
        Self {
            points: points.to_vec(),
            ways,
            middle,
            normal: arms.map(|[a, b]| a.cross(b)).sum::<DVec3>().normalize_or_zero(),
        }
    }

    fn length(&self) -> f64 {
        self.ways[self.points.len()]
    }

    /// Points at equal distances along the line, from one of its points on.
    fn samples(&self, start: usize) -> impl Iterator<Item = DVec3> + '_ {
        let step = self.length() / SAMPLES as f64;
        let count = self.points.len();
        (0..SAMPLES).map(move |k| {
            let way = (self.ways[start] + k as f64 * step) % self.length();
            let edge = self.ways.partition_point(|own| *own <= way).clamp(1, count) - 1;
            let share = (way - self.ways[edge]) / (self.ways[edge + 1] - self.ways[edge]).max(f64::MIN_POSITIVE);
            self.points[edge].lerp(self.points[(edge + 1) % count], share.clamp(0.0, 1.0))
        })
    }
}

/// The turn of a frame that is carried from the first line to the second, whose direction is reversed.
fn carried(first: &Line, second: &Line) -> DQuat {
    let way = (second.middle - first.middle).normalize_or_zero();
    // The reversed line's normal points along the tube already.
    let [from, to] = [first.normal, second.normal];
    if [way, from, to].contains(&DVec3::ZERO) {
        return DQuat::IDENTITY;
    }
    DQuat::from_rotation_arc(way, to) * DQuat::from_rotation_arc(from, way)
}
