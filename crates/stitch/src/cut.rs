//! Cutting: vertices are deleted with every triangle that uses one of them.

use pliant_mesh::{DrawnVertex, FileVertex};

use crate::error::StitchError;
use crate::part::Part;
use crate::shape::{Age, NewShape, TriangleSource, VertexSource};

impl NewShape {
    /// Deletes the chosen vertices of a part's surface (a flag for each) and the triangles that use them. Triangles with
    /// a corner that is not finite go, too, and so do vertices that only deleted triangles used; all others keep their
    /// order.
    ///
    /// # Errors
    /// [`StitchError::NothingSelected`] and [`StitchError::NothingLeft`].
    pub fn cut(part: &Part<'_>, delete: &[bool]) -> Result<Self, StitchError> {
        if !delete.contains(&true) {
            return Err(StitchError::NothingSelected);
        }
        let drawn = part.drawn;
        let is_deleted = |vertex: DrawnVertex| {
            let surface = part.model.drawn.surface_vertex(vertex);
            surface.is_some_and(|surface| delete.get(surface.index()) == Some(&true))
        };
        let goes =
            |corners: &[DrawnVertex; 3]| part.is_broken(corners) || corners.iter().any(|&corner| is_deleted(corner));
        let (mut was_used, mut is_used) = (vec![false; drawn.positions.len()], vec![false; drawn.positions.len()]);
        for corners in &drawn.triangles {
            let stays = !goes(corners);
            for corner in corners {
                was_used[corner.index()] = true;
                is_used[corner.index()] |= stays;
            }
        }
        if !is_used.contains(&true) {
            return Err(StitchError::NothingLeft);
        }
        let stays = |v: usize| is_used[v] || (!was_used[v] && !is_deleted(DrawnVertex(v as u32)));
        let mut shape = Self::of_vertices(part, stays);
        let number = shape.numbers(drawn.positions.len());
        for (triangle, corners) in (0..).zip(&drawn.triangles) {
            if !goes(corners) {
                shape.triangles.push(corners.map(|corner| number[corner.index()]));
                shape.triangle_sources.push(TriangleSource {
                    part: 0,
                    triangle,
                    age: Age::Old,
                });
            }
        }
        Ok(shape)
    }

    /// The vertices of a part that stay, in their order, without triangles.
    pub(crate) fn of_vertices(part: &Part<'_>, stays: impl Fn(usize) -> bool) -> Self {
        let drawn = part.drawn;
        let mut file_number = vec![u32::MAX; drawn.file_vertex_count];
        for v in (0..drawn.positions.len()).filter(|&v| stays(v)) {
            file_number[drawn.file_vertex[v].index()] = 0;
        }
        let mut file_vertex_count = 0;
        for number in file_number.iter_mut().filter(|number| **number == 0) {
            *number = file_vertex_count;
            file_vertex_count += 1;
        }
        let mut shape = Self {
            file_vertex_count: file_vertex_count as usize,
            ..Self::default()
        };
        for v in (0..drawn.positions.len()).filter(|&v| stays(v)) {
            let vertex = DrawnVertex(v as u32);
            shape.vertices.push(VertexSource::Old { part: 0, vertex });
            shape.positions.push(drawn.positions[v]);
            shape
                .file_vertices
                .push(FileVertex(file_number[drawn.file_vertex[v].index()]));
        }
        shape
    }

    /// The number here of each of the `count` drawn vertices of the part; no vertex for those that are not left.
    pub(crate) fn numbers(&self, count: usize) -> Vec<DrawnVertex> {
        let mut number = vec![DrawnVertex(u32::MAX); count];
        for (own, source) in (0..).zip(&self.vertices) {
            if let VertexSource::Old { vertex, .. } = source {
                number[vertex.index()] = DrawnVertex(own);
            }
        }
        number
    }
}
