//! A shape that no file has yet: vertices and triangles that were put together in memory.

use std::borrow::Cow;

use glam::DVec3;
use pliant_mesh::{Cancel, DrawnVertex, FileVertex, Progress};

use crate::convert::{NewMesh, Parting, Polygons};
use crate::save::Saved;
use crate::save::course::Course;
use crate::save::moved::check_single;
use crate::scene::writing::write_new;
use crate::{Appearance, Format, SaveError};

/// A shape with its appearance, to be written as a new file of any format.
#[derive(Clone, Debug)]
pub struct UnsavedShape<'a> {
    /// World positions, one per drawn vertex.
    pub positions: &'a [DVec3],
    /// Triangles over drawn vertices, in the order of the appearance's groups; every id is in range.
    pub triangles: &'a [[DrawnVertex; 3]],
    /// Its faces if some are not triangles: a face with n corners is n − 2 of the triangles, in order.
    pub polygons: Option<Polygons>,
    /// For each drawn vertex its number in a format without texture coordinates and normals: drawn vertices that differ
    /// only in those share it.
    pub file_vertex: &'a [FileVertex],
    /// The count of these numbers.
    pub file_vertex_count: usize,
    /// Its appearance.
    pub appearance: Appearance,
}

impl UnsavedShape<'_> {
    /// The file, and its neighbours, under the name `name`.
    ///
    /// # Errors
    /// A finite position beyond single precision, or a shape that the format can't hold; [`SaveError::Cancelled`] soon
    /// after `cancel` is raised.
    pub fn save(&self, format: Format, name: &str, progress: &Progress, cancel: &Cancel) -> Result<Saved, SaveError> {
        let course = Course::new(progress, cancel);
        let (of_check, course) = course.split(0.1);
        for (v, &position) in self.positions.iter().enumerate() {
            of_check.pass(v, self.positions.len())?;
            if position.is_finite() {
                check_single(position, self.file_vertex[v])?;
            }
        }
        let mesh = NewMesh {
            name,
            positions: self.positions,
            triangles: Cow::Borrowed(self.triangles),
            polygons: self.polygons.clone(),
            file_vertex: self.file_vertex,
            file_vertex_count: self.file_vertex_count,
            parting: Parting::ByName,
            appearance: self.appearance.clone(),
        };
        let saved = write_new(&mesh, format, &course)?;
        progress.set(1.0);
        Ok(saved)
    }
}
