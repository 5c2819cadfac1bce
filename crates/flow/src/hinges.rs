//! The triangles beside each triangle.
//!
//! A *corner* has the number 3 t + k: corner k of triangle t. Each edge is named by the corner opposite to it.

use pliant_mesh::{Surface, SurfaceVertex, Topology};
use rayon::prelude::*;

use crate::sums::CHUNK;

/// No triangle beside: a border.
pub(crate) const WALL: u32 = u32::MAX;

/// For each edge the edge of the triangle beside it.
#[derive(Clone, Debug)]
pub(crate) struct Hinges {
    beside: Vec<[u32; 3]>,
}

impl Hinges {
    /// Edges with exactly two triangles, which agree about the outside, are hinges; all others are walls.
    pub fn of(surface: &Surface, topology: &Topology) -> Self {
        let beside = (0..surface.triangles.len() as u32)
            .into_par_iter()
            .with_min_len(CHUNK)
            .map(|t| [0, 1, 2].map(|k| beside(surface, topology, t, k)))
            .collect();
        Self { beside }
    }

    /// The edge of the triangle beside the edge opposite `corner`, or [`WALL`].
    #[inline]
    pub fn beside(&self, corner: u32) -> u32 {
        self.beside[corner as usize / 3][corner as usize % 3]
    }

    /// The corners at the vertex of `corner`, counterclockwise, and whether they go all around. An open fan begins at
    /// a wall, a closed one at `corner`.
    pub fn fan(&self, corner: u32) -> (Vec<u32>, bool) {
        let mut first = corner;
        let before_first = loop {
            let before = self.before(first);
            if before == WALL || before == corner {
                break before;
            }
            first = before;
        };
        let is_closed = before_first == corner;
        if is_closed {
            first = corner;
        }
        let mut fan = vec![first];
        loop {
            let after = self.after(fan[fan.len() - 1]);
            if after == WALL || after == first {
                return (fan, is_closed);
            }
            fan.push(after);
        }
    }

    /// The next corner counterclockwise around the same vertex, or [`WALL`].
    #[inline]
    pub fn after(&self, corner: u32) -> u32 {
        match self.beside(next(corner)) {
            WALL => WALL,
            edge => next(edge),
        }
    }

    /// The next corner clockwise around the same vertex, or [`WALL`].
    #[inline]
    pub fn before(&self, corner: u32) -> u32 {
        match self.beside(last(corner)) {
            WALL => WALL,
            edge => last(edge),
        }
    }
}

/// The next corner of the same triangle.
#[inline]
pub(crate) fn next(corner: u32) -> u32 {
    if corner % 3 == 2 { corner - 2 } else { corner + 1 }
}

/// The corner before it in the same triangle.
#[inline]
pub(crate) fn last(corner: u32) -> u32 {
    if corner.is_multiple_of(3) {
        corner + 2
    } else {
        corner - 1
    }
}

fn beside(surface: &Surface, topology: &Topology, t: u32, k: usize) -> u32 {
    let triangles = &surface.triangles;
    let own = triangles[t as usize];
    let (from, to) = (own[(k + 1) % 3], own[(k + 2) % 3]);
    let shared = |&other: &u32| other != t && triangles[other as usize].contains(&to);
    let mut others = topology.faces(from, triangles).filter(shared);
    let (Some(other), None) = (others.next(), others.next()) else {
        return WALL;
    };
    let corners = triangles[other as usize];
    let is_reversed = |k: &usize| corners[(k + 1) % 3] == to && corners[(k + 2) % 3] == from;
    (0..3).find(is_reversed).map_or(WALL, |k| 3 * other + k as u32)
}

/// The number of a vertex's corner in one of its triangles.
pub(crate) fn corner_at(surface: &Surface, triangle: u32, vertex: SurfaceVertex) -> u32 {
    let corners = surface.triangles[triangle as usize];
    3 * triangle + corners.iter().position(|&corner| corner == vertex).unwrap_or(0) as u32
}
