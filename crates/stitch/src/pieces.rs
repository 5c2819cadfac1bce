//! Cut triangles: their pieces, and the points that cuts put on edges and into triangles.

use glam::DVec3;
use pliant_mesh::{DrawnVertex, FileVertex};

use crate::part::Part;
use crate::shape::{NewShape, TriangleSource, VertexSource};

/// A corner of a piece of a triangle.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum Corner {
    Old(DrawnVertex),
    /// By its place among the cut points.
    New(u32),
}

/// A point that a cut puts on an edge of a drawn triangle, or into one.
pub(crate) struct CutPoint {
    /// Drawn vertices of one triangle; the last one has a share of 0 if the point is on the edge of the others.
    pub(crate) corners: [DrawnVertex; 3],
    /// The share of the way from the first corner to the second, and from there to the third.
    pub(crate) shares: [f64; 2],
    pub(crate) position: DVec3,
    /// The number of its point on the surface: cut points on the two sides of a seam have the same.
    pub(crate) on_surface: u32,
}

impl CutPoint {
    fn between(&self, [a, b, c]: [f64; 3]) -> f64 {
        let first = a + (b - a) * self.shares[0];
        first + (c - first) * self.shares[1]
    }

    /// The corner with the greatest weight.
    fn nearest(&self) -> DrawnVertex {
        match self.shares {
            [_, third] if third > 0.5 => self.corners[2],
            [second, _] => self.corners[usize::from(second > 0.5)],
        }
    }
}

/// The triangles that a cut leaves, whole or in pieces.
#[derive(Default)]
pub(crate) struct Pieces {
    pub(crate) points: Vec<CutPoint>,
    /// The count of different [`CutPoint::on_surface`].
    pub(crate) surface_points: usize,
    pub(crate) triangles: Vec<([Corner; 3], TriangleSource)>,
}

impl Pieces {
    /// The shape of all pieces. Vertices that no triangle of the part used stay where `is_kept`.
    pub(crate) fn shape(&self, part: &Part<'_>, is_kept: impl Fn(DrawnVertex) -> bool) -> NewShape {
        let drawn = part.drawn;
        let (mut was_used, mut is_used) = (vec![false; drawn.positions.len()], vec![false; drawn.positions.len()]);
        drawn
            .triangles
            .iter()
            .flatten()
            .for_each(|corner| was_used[corner.index()] = true);
        for (corners, _) in &self.triangles {
            for corner in corners {
                if let Corner::Old(vertex) = corner {
                    is_used[vertex.index()] = true;
                }
            }
        }
        let stays = |v: usize| is_used[v] || (!was_used[v] && is_kept(DrawnVertex(v as u32)));
        let mut shape = NewShape::of_vertices(part, stays);
        let number = shape.numbers(drawn.positions.len());
        let first = shape.positions.len() as u32;
        self.add_points(part, &mut shape);
        let here = |corner: Corner| match corner {
            Corner::Old(vertex) => number[vertex.index()],
            Corner::New(point) => DrawnVertex(first + point),
        };
        for (corners, source) in &self.triangles {
            shape.triangles.push(corners.map(here));
            shape.triangle_sources.push(*source);
        }
        shape
    }

    /// Adds the cut points, with the numbers and normals between those of their corners.
    fn add_points(&self, part: &Part<'_>, shape: &mut NewShape) {
        let (first_file, attributes) = (shape.file_vertex_count as u32, &part.attributes);
        for (row, point) in (0..).zip(&self.points) {
            let vertex = DrawnVertex(shape.positions.len() as u32);
            let value = |channel| point.between(point.corners.map(|corner| (attributes.value)(corner, channel)));
            shape.values.extend((0..attributes.width()).map(value));
            shape.vertices.push(VertexSource::New {
                part: 0,
                like: point.nearest(),
                row,
            });
            shape.positions.push(point.position);
            shape.file_vertices.push(FileVertex(first_file + point.on_surface));
            if let Some(normal) = part.normals {
                let [a, b, c] = point.corners.map(normal);
                let between = a.lerp(b, point.shares[0]).lerp(c, point.shares[1]);
                shape.normals.push((vertex, between.normalize_or_zero()));
            }
        }
        shape.file_vertex_count += self.surface_points;
    }
}
