//! The distance within which two vertices count as one. The mesh around each of them determines it.
//!
//! A vertex's *size* is the longest edge of the smallest triangle that uses it. So the distance does not depend on the
//! rest of the scene, is never above a share of the finer of two parts, and scales and turns with the mesh.

use std::collections::HashMap;
use std::ops::Range;

use glam::DVec3;

use super::nearby::MayJoin;
use crate::Rounding;
use crate::drawn::drawn_set::NONE;
use crate::drawn::drawn_triangles::Corners;

/// Vertices on borders are joined within this share of their size: exporters that cut a mesh apart compute its corners
/// again, with the errors of single precision.
const BORDERS: f64 = 1e-4;

/// The limit as a share of their shortest edge: strips may be far narrower than long.
const OF_EDGE: f64 = 0.25;

/// Other vertices are joined within this share of their size. A larger one would flatten thin plates.
const ANY: f64 = 1e-7;

/// Borders that were rounded apart are joined no further than this share of their size, and a distance that a person
/// gives extends to at most twice this: well-shaped triangles must not collapse.
const LARGEST: f64 = 0.25;

/// A little more than the rounding itself, for the errors of the transforms that place the rounded vertices.
const ALLOWANCE: f64 = 1.001;

/// The distances of a mesh's groups.
pub(super) struct Closeness<'a> {
    /// Zero for a group that no proper triangle uses.
    sizes: Vec<f64>,
    /// The distance that a person gives.
    given: Option<f64>,
    roundings: &'a [Rounding],
    /// The largest of their distances.
    largest_rounding: f64,
}

impl<'a> Closeness<'a> {
    /// The distances of `count` groups, given the group of each drawn vertex.
    pub(super) fn of(positions: &[DVec3], corners: &Corners, groups: &[u32], count: usize) -> Self {
        let middle = corners.len() / 2;
        let (mut squared, of_second_half) = rayon::join(
            || squared_sizes(positions, corners, 0..middle, groups, count),
            || squared_sizes(positions, corners, middle..corners.len(), groups, count),
        );
        squared
            .iter_mut()
            .zip(of_second_half)
            .for_each(|(size, other)| *size = size.min(other));
        let size = |squared: f64| if squared.is_finite() { squared.sqrt() } else { 0.0 };
        Self {
            sizes: squared.into_iter().map(size).collect(),
            given: None,
            roundings: &[],
            largest_rounding: 0.0,
        }
    }

    /// The same with the distance that a person gives, if any.
    pub(super) fn with_distance(self, given: Option<f64>) -> Self {
        Self { given, ..self }
    }

    /// The same for runs of drawn vertices that were rounded apart.
    pub(super) fn with_roundings(self, roundings: &'a [Rounding]) -> Self {
        Self {
            roundings,
            largest_rounding: roundings.iter().map(|run| run.distance).fold(0.0, f64::max),
            ..self
        }
    }

    /// The distance that a person gives.
    pub(super) fn given(&self) -> Option<f64> {
        self.given
    }

    /// The distance that a group's own never exceeds.
    pub(super) fn reach(&self, group: u32) -> f64 {
        let size = self.sizes[group as usize];
        match self.given {
            Some(given) => given.min(2.0 * LARGEST * size),
            None => (2.0 * ALLOWANCE * self.largest_rounding)
                .min(LARGEST * size)
                .max(BORDERS * size),
        }
    }

    /// The rule for groups that have neighbours, given positions and groups of all drawn vertices.
    pub(super) fn rule(&self, near: &[u32], positions: &[DVec3], corners: &Corners, groups: &[u32]) -> Rule<'_> {
        if self.given.is_some() {
            return Rule {
                closeness: self,
                of_group: HashMap::new(),
            };
        }
        let mut of_group: HashMap<u32, Surroundings> = near.iter().map(|&g| (g, Surroundings::unknown())).collect();
        for (vertex, group) in (0..).zip(groups) {
            if let Some(known) = of_group.get_mut(group) {
                let (run, rounding) = self.run_of(vertex);
                if !known.runs.contains(&run) {
                    known.runs.push(run);
                }
                known.rounding = known.rounding.max(rounding);
            }
        }
        let mut edges: Vec<[u32; 2]> = Vec::new();
        for triangle in corners.iter() {
            let own = triangle.map(|v| groups[v.index()]);
            if !is_proper(own) {
                continue;
            }
            for [one, other] in [[0, 1], [1, 2], [2, 0]] {
                let length = || positions[triangle[one].index()].distance(positions[triangle[other].index()]);
                let ends = [own[one], own[other]];
                for end in ends {
                    if let Some(known) = of_group.get_mut(&end) {
                        known.shortest = known.shortest.min(length());
                    }
                }
                if ends.iter().any(|end| of_group.contains_key(end)) {
                    edges.push([ends[0].min(ends[1]), ends[0].max(ends[1])]);
                }
            }
        }
        edges.sort_unstable();
        let of_one_triangle = edges.chunk_by(|a, b| a == b).filter(|same| same.len() == 1);
        for group in of_one_triangle.flatten().flatten() {
            if let Some(known) = of_group.get_mut(group) {
                known.is_on_border = true;
            }
        }
        Rule {
            closeness: self,
            of_group,
        }
    }

    /// The run with which a drawn vertex was rounded, and its rounding.
    fn run_of(&self, vertex: u32) -> (u32, f64) {
        let after = self.roundings.partition_point(|run| run.vertices.start <= vertex);
        match self.roundings[..after].last() {
            Some(run) if run.vertices.contains(&vertex) => (after as u32, run.distance),
            _ => (0, 0.0),
        }
    }
}

/// The squared sizes of groups by some of the triangles; infinite for a group that none of these uses.
fn squared_sizes(
    positions: &[DVec3],
    corners: &Corners,
    triangles: Range<usize>,
    groups: &[u32],
    count: usize,
) -> Vec<f64> {
    let mut squared = vec![f64::INFINITY; count];
    for triangle in triangles.map(|t| corners.of(t)) {
        let of_corners = triangle.map(|v| groups[v.index()]);
        if !is_proper(of_corners) {
            continue;
        }
        let [a, b, c] = triangle.map(|v| positions[v.index()]);
        let longest = a
            .distance_squared(b)
            .max(b.distance_squared(c))
            .max(c.distance_squared(a));
        for group in of_corners {
            let size = &mut squared[group as usize];
            *size = size.min(longest);
        }
    }
    squared
}

/// Returns true if a triangle's corners are in three groups.
fn is_proper([a, b, c]: [u32; 3]) -> bool {
    ![a, b, c].contains(&NONE) && a != b && b != c && c != a
}

/// The data of a group that has neighbours.
struct Surroundings {
    is_on_border: bool,
    /// Its shortest edge.
    shortest: f64,
    /// The runs with which its members were rounded.
    runs: Vec<u32>,
    /// The largest of their roundings.
    rounding: f64,
}

impl Surroundings {
    fn unknown() -> Self {
        Self {
            is_on_border: false,
            shortest: f64::INFINITY,
            runs: Vec::new(),
            rounding: 0.0,
        }
    }
}

/// The rule for joining groups.
pub(super) struct Rule<'a> {
    closeness: &'a Closeness<'a>,
    of_group: HashMap<u32, Surroundings>,
}

impl MayJoin for Rule<'_> {
    fn may_join(&self, place: u32, other: u32, distance: f64) -> bool {
        if self.closeness.given.is_some() {
            // Both distances are large enough.
            return true;
        }
        let size = |group: u32| self.closeness.sizes[group as usize];
        let size = size(place).min(size(other));
        let (Some(a), Some(b)) = (self.of_group.get(&place), self.of_group.get(&other)) else {
            return false;
        };
        if !(a.is_on_border && b.is_on_border) {
            return distance <= ANY * size;
        }
        let were_rounded_apart = a.runs.iter().all(|run| !b.runs.contains(run));
        let rounding = ALLOWANCE * (a.rounding + b.rounding);
        let borders = (BORDERS * size)
            .min(OF_EDGE * a.shortest.min(b.shortest))
            .max(ANY * size);
        distance <= borders || (were_rounded_apart && distance <= rounding.min(LARGEST * size))
    }

    fn has_joined(&mut self, place: u32, other: u32) {
        let Some(joined) = self.of_group.remove(&place) else {
            return;
        };
        if let Some(known) = self.of_group.get_mut(&other) {
            known.runs.extend(joined.runs);
            known.rounding = known.rounding.max(joined.rounding);
        }
    }
}
