//! The two sides of a track: the surface is joined again everywhere but across it.

use std::collections::{BTreeMap, BTreeSet};

use pliant_mesh::{Model, SurfaceVertex};

use super::polygons::{Divided, FIRST_STATION};
use super::track::{Station, Track};

/// Vertices and polygons in groups that are joined without crossing the track.
pub(super) struct Sides {
    /// A group's parent, by numbers of vertices and then of polygons.
    parents: Vec<u32>,
    vertex_count: usize,
    left: BTreeSet<u32>,
    right: BTreeSet<u32>,
}

impl Sides {
    /// The sides of a track that divides these triangles; a polygon's number counts all before it.
    pub(super) fn of<'a>(model: &Model, track: &Track, divided: impl Iterator<Item = &'a Divided>) -> Self {
        let vertex_count = model.surface.positions.len();
        let mut sides = Self {
            parents: (0..vertex_count as u32).collect(),
            vertex_count,
            left: BTreeSet::new(),
            right: BTreeSet::new(),
        };
        let on_edge = |station: &Station| match station {
            Station::On(crossing) => Some(crossing.ends),
            Station::Inside { .. } => None,
        };
        let crossed: BTreeSet<[SurfaceVertex; 2]> = track.stations.iter().filter_map(on_edge).collect();
        for [a, b] in model.topology.edges() {
            if !crossed.contains(&[a.min(b), a.max(b)]) {
                sides.join(a.0, b.0);
            }
        }
        let (mut on_left, mut on_right) = (Vec::new(), Vec::new());
        let mut beyond: BTreeMap<[u32; 2], u32> = BTreeMap::new();
        let count = track.stations.len() as u32;
        let step =
            |from: u32, to: u32| from >= FIRST_STATION && (from - FIRST_STATION + 1) % count == to - FIRST_STATION;
        for (corners, polygon) in divided.flat_map(|own| own.polygons.iter().map(move |polygon| (own.corners, polygon)))
        {
            let number = sides.parents.len() as u32;
            sides.parents.push(number);
            let next = polygon.iter().cycle().skip(1);
            for (&from, &to) in polygon.iter().zip(next) {
                if from < FIRST_STATION {
                    sides.join(number, corners[from as usize].0);
                }
                if from < FIRST_STATION || to < FIRST_STATION {
                    continue;
                }
                if step(from, to) {
                    on_left.push(number);
                } else if step(to, from) {
                    on_right.push(number);
                } else if let Some(other) = beyond.insert([from.min(to), from.max(to)], number) {
                    sides.join(number, other);
                }
            }
        }
        sides.left = on_left.into_iter().map(|polygon| sides.group(polygon)).collect();
        sides.right = on_right.into_iter().map(|polygon| sides.group(polygon)).collect();
        sides
    }

    /// Returns false if the surface goes on from one side to the other around the track.
    pub(super) fn are_apart(&self) -> bool {
        self.left.is_disjoint(&self.right)
    }

    /// Whether a vertex is on the left, or else on the right; `None` on a part beside the track.
    pub(super) fn of_vertex(&self, vertex: SurfaceVertex) -> Option<bool> {
        self.side(vertex.0)
    }

    /// The same for a polygon, by its number.
    pub(super) fn of_polygon(&self, polygon: usize) -> Option<bool> {
        self.side((self.vertex_count + polygon) as u32)
    }

    fn side(&self, member: u32) -> Option<bool> {
        let group = self.group(member);
        let is_left = self.left.contains(&group);
        (is_left || self.right.contains(&group)).then_some(is_left)
    }

    fn group(&self, mut member: u32) -> u32 {
        while self.parents[member as usize] != member {
            member = self.parents[member as usize];
        }
        member
    }

    /// Joins two groups; the lower root leads.
    fn join(&mut self, a: u32, b: u32) {
        let [a, b] = [a, b].map(|mut member| {
            while self.parents[member as usize] != member {
                let above = self.parents[self.parents[member as usize] as usize];
                self.parents[member as usize] = above;
                member = above;
            }
            member
        });
        self.parents[a.max(b) as usize] = a.min(b);
    }
}
