//! What a file shows: every vertex seen through its node, in world space.

use std::ops::Range;

use glam::DVec3;

use crate::{DrawnVertex, FileVertex};

/// Drawn vertices whose positions one grid holds, as integers or single-precision numbers do.
#[derive(Clone, PartialEq, Debug)]
pub struct Rounding {
    /// The drawn vertices.
    pub vertices: Range<u32>,
    /// How far, at most, a position is from the one that was rounded to it, in world units.
    pub distance: f64,
}

/// The drawn vertices and triangles of a file's default scene, in world space.
///
/// Triangles run counter-clockwise seen from outside; mirrored nodes' windings are flipped already. Positions may be
/// non-finite where the file's are: welding sets such vertices aside.
#[derive(Clone, Debug, Default)]
pub struct Drawn {
    /// World position of each drawn vertex.
    pub positions: Vec<DVec3>,
    /// Triangles over drawn vertices; every id is in range.
    pub triangles: Vec<[DrawnVertex; 3]>,
    /// Lines between two drawn vertices each, which are shown and not solved; every id is in range.
    pub lines: Vec<[DrawnVertex; 2]>,
    /// The file vertex behind each drawn vertex.
    pub file_vertex: Vec<FileVertex>,
    /// How many vertices the file has, drawn or not.
    pub file_vertex_count: usize,
    /// Runs of drawn vertices that were rounded each to a grid of its own: ascending, none in two of them. Borders of
    /// different runs are welded up to the distances of their rounding.
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
