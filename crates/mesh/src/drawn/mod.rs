//! The geometry that a file shows: every vertex seen through its node, in world space.

pub(crate) mod drawn_set;
pub(crate) mod drawn_triangles;
mod object;

use std::ops::Range;

use glam::DVec3;

use crate::{DrawnVertex, FileVertex};

pub use drawn_set::DrawnSet;
pub use object::Object;

/// Drawn vertices whose positions are on one grid, like integers or single-precision numbers.
#[derive(Clone, PartialEq, Debug)]
pub struct Rounding {
    /// The drawn vertices.
    pub vertices: Range<u32>,
    /// The largest distance between a position and its rounded one, in world units.
    pub distance: f64,
}

/// The drawn vertices and triangles of a file's default scene, in world space.
///
/// Triangles run counter-clockwise seen from outside; the winding of mirrored nodes is already flipped. Positions may
/// be non-finite if the file's are: welding sets such vertices aside.
#[derive(Clone, Debug, Default)]
pub struct Drawn {
    /// World position of each drawn vertex.
    pub positions: Vec<DVec3>,
    /// Triangles over drawn vertices; every id is in range.
    pub triangles: Vec<[DrawnVertex; 3]>,
    /// Lines between two drawn vertices each, which are shown but not solved for; every id is in range. A line from a
    /// vertex to itself is a point. A vertex of no triangle, line or point is not shown, unless there is no triangle.
    pub lines: Vec<[DrawnVertex; 2]>,
    /// The file vertex behind each drawn vertex.
    pub file_vertex: Vec<FileVertex>,
    /// The number of the file's vertices, drawn or not.
    pub file_vertex_count: usize,
    /// Runs of drawn vertices that were each rounded to their own grid, ascending and disjoint. Borders of different
    /// runs are welded up to the distances of their rounding.
    pub roundings: Vec<Rounding>,
}

impl Drawn {
    /// A file that shows each of its vertices once, in its own order.
    pub fn once(positions: Vec<DVec3>, triangles: Vec<[DrawnVertex; 3]>) -> Self {
        let file_vertex_count = positions.len();
        let file_vertex = (0..file_vertex_count as u32).map(FileVertex).collect();
        Self {
            positions,
            triangles,
            lines: Vec::new(),
            file_vertex,
            file_vertex_count,
            roundings: Vec::new(),
        }
    }
}
