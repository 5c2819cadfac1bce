//! The output shape: old and new vertices and triangles, each with its source.

use glam::DVec3;
use pliant_mesh::{DrawnVertex, FileVertex};

/// A shape made of one or two parts and of new vertices and triangles.
#[derive(Clone, PartialEq, Debug, Default)]
pub struct NewShape {
    /// The source of each vertex.
    pub vertices: Vec<VertexSource>,
    /// The world position of each vertex.
    pub positions: Vec<DVec3>,
    /// The number of each vertex in a file without texture coordinates and normals: the vertices at one point of the
    /// surface share it.
    pub file_vertices: Vec<FileVertex>,
    /// The count of these numbers.
    pub file_vertex_count: usize,
    /// They are counterclockwise seen from outside.
    pub triangles: Vec<[DrawnVertex; 3]>,
    /// The source of each triangle.
    pub triangle_sources: Vec<TriangleSource>,
    /// The numbers of the new vertices, [`crate::Attributes::width`] for each.
    pub values: Vec<f64>,
    /// The blended numbers ([`crate::Attributes::blended`]) of vertices on a common border, whose two sides agree
    /// there; ascending by vertex.
    pub blended: Vec<(DrawnVertex, Vec<f64>)>,
    /// The unit normals that differ from the sources', including those of new vertices; ascending by vertex.
    pub normals: Vec<(DrawnVertex, DVec3)>,
}

/// The source of a vertex.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum VertexSource {
    /// A drawn vertex of a part.
    Old {
        /// 0 or 1.
        part: u8,
        /// The vertex.
        vertex: DrawnVertex,
    },
    /// A new vertex.
    New {
        /// The part that it continues.
        part: u8,
        /// A drawn vertex of that part nearby.
        like: DrawnVertex,
        /// Its row in [`NewShape::values`].
        row: u32,
    },
}

impl VertexSource {
    /// The part that it belongs to: 0 or 1.
    pub fn part(self) -> u8 {
        match self {
            Self::Old { part, .. } | Self::New { part, .. } => part,
        }
    }
}

/// The source of a triangle.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct TriangleSource {
    /// 0 or 1.
    pub part: u8,
    /// The drawn triangle that is its source or gives its group.
    pub triangle: u32,
    /// The triangle's age.
    pub age: Age,
}

/// The age of a triangle.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Age {
    /// It has the corners of its source.
    Old,
    /// It is new, or was cut from its source.
    New,
}
