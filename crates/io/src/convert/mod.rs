//! A shape with its appearance, from which a new file of any format can be written.

pub(crate) mod faces;

use std::borrow::Cow;
use std::ops::Range;

use glam::DVec3;
use pliant_mesh::{DrawnVertex, FileVertex};

use crate::save::course::Course;
use crate::save::moved::{Moved, check_single};
use crate::save::turned::wound_back;
use crate::{Appearance, SaveError};

/// A deformed shape with its appearance, independent of the format that it came from.
///
/// Vertices are the drawn ones (an OBJ's corner with its own UV is a vertex of its own); `file_vertex` gives the vertex
/// of the input file behind each.
pub(crate) struct NewMesh<'a> {
    /// OUT's file name.
    pub name: &'a str,
    /// New world positions, one per drawn vertex; may be non-finite if the file's were.
    pub positions: &'a [DVec3],
    /// Triangles over drawn vertices, in `appearance.groups`' order.
    pub triangles: Cow<'a, [[DrawnVertex; 3]]>,
    /// The file's own polygons, if it has any that are not triangles.
    pub polygons: Option<Polygons>,
    /// The file vertex behind each drawn vertex.
    pub file_vertex: &'a [FileVertex],
    /// The number of vertices of the input file.
    pub file_vertex_count: usize,
    /// The treatment of named parts in formats that need separate vertices for them.
    pub parting: Parting,
    /// The appearance, with the normals already transformed by the deformation.
    pub appearance: Appearance,
}

/// The treatment of named parts in a format whose parts do not share vertices.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum Parting {
    /// Each name is a separate part.
    ByName,
    /// All become one, so that vertices keep their order and number.
    Joined,
}

/// Faces as the file has them, triangles among them: a face with n corners is n − 2 of the drawn triangles, in order.
#[derive(Clone, PartialEq, Debug, Default)]
pub struct Polygons {
    /// The start of each face's corners in `corners`; one entry more than there are faces.
    pub offsets: Vec<u32>,
    /// Drawn vertices, counterclockwise seen from outside.
    pub corners: Vec<DrawnVertex>,
}

impl Polygons {
    /// The number of faces.
    pub fn len(&self) -> usize {
        self.offsets.len().saturating_sub(1)
    }

    /// Returns true if there is no face.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The faces with their final winding.
    fn turned(mut self, moved: &Moved<'_>) -> Self {
        if moved.turns_any() {
            for face in 0..self.len() {
                let corners = self.face(face);
                if corners.first().is_some_and(|first| moved.turns(*first)) {
                    let corners: Vec<DrawnVertex> = wound_back(corners).copied().collect();
                    let start = self.offsets[face] as usize;
                    self.corners[start..start + corners.len()].copy_from_slice(&corners);
                }
            }
        }
        self
    }

    /// The corners of a face.
    pub fn face(&self, face: usize) -> &[DrawnVertex] {
        let span: Range<usize> = self.offsets[face] as usize..self.offsets[face + 1] as usize;
        &self.corners[span]
    }
}

impl<'a> NewMesh<'a> {
    /// The moved shape with `appearance`, whose normals are transformed here. Refuses a position beyond single
    /// precision.
    pub fn of(
        moved: &Moved<'a>,
        mut appearance: Appearance,
        name: &'a str,
        polygons: Option<Polygons>,
        parting: Parting,
        course: &Course<'_>,
    ) -> Result<Self, SaveError> {
        let (of_check, course) = course.split(0.1);
        // A position that is not finite in the file stays so; every other one must stay finite.
        for (v, &position) in moved.positions.iter().enumerate() {
            of_check.pass(v, moved.positions.len())?;
            if position.is_finite() {
                check_single(position, moved.drawn.file_vertex[v])?;
            }
        }
        if let Some(normals) = appearance.normals.as_mut()
            && !moved.moves_nothing()
        {
            let rest: Vec<DVec3> = normals.iter().map(|&n| glam::Vec3::from(n).as_dvec3()).collect();
            let (of_frames, course) = course.split(0.9);
            let frames = moved.frames(&rest, &of_frames)?;
            for (v, normal) in normals.iter_mut().enumerate() {
                course.pass(v, rest.len())?;
                let vertex = DrawnVertex(v as u32);
                if moved.moves(vertex) {
                    // f32 begins here: normals are displayed and saved as f32 in every kind of file.
                    *normal = frames.carry_normal(vertex, rest[v]).as_vec3().to_array();
                }
            }
        }
        if let Some(normals) = appearance.normals.as_mut() {
            for (v, normal) in normals.iter_mut().enumerate() {
                if moved.turns(DrawnVertex(v as u32)) {
                    *normal = normal.map(|number| -number);
                }
            }
        }
        Ok(Self {
            name,
            positions: moved.positions,
            triangles: moved.triangles(),
            polygons: polygons.map(|polygons| polygons.turned(moved)),
            file_vertex: &moved.drawn.file_vertex,
            file_vertex_count: moved.drawn.file_vertex_count,
            parting,
            appearance,
        })
    }
}
