//! The common code of the writers of OBJ, PLY, STL and OFF: the file's own faces, vertices without needless copies, and
//! the precision that numbers need.

use glam::DVec3;
use pliant_mesh::{Cancelled, DrawnVertex};

use crate::Appearance;
use crate::convert::NewMesh;
use crate::save::bits::bit_equal;
use crate::save::course::Course;

/// Calls `visit` with the corners of each face and the number of its first triangle: the file's own polygons if it has
/// any, otherwise the triangles.
pub(crate) fn for_each_face(
    mesh: &NewMesh<'_>,
    course: &Course<'_>,
    mut visit: impl FnMut(&[DrawnVertex], usize),
) -> Result<(), Cancelled> {
    let count = face_count(mesh);
    match &mesh.polygons {
        Some(polygons) => {
            let mut triangle = 0;
            for face in 0..count {
                course.pass(face, count)?;
                let corners = polygons.face(face);
                visit(corners, triangle);
                triangle += corners.len().saturating_sub(2);
            }
        }
        None => {
            for (triangle, corners) in mesh.triangles.iter().enumerate() {
                course.pass(triangle, count)?;
                visit(corners, triangle);
            }
        }
    }
    Ok(())
}

/// The number of faces that [`for_each_face`] visits.
pub(crate) fn face_count(mesh: &NewMesh<'_>) -> usize {
    mesh.polygons
        .as_ref()
        .map_or(mesh.triangles.len(), |polygons| polygons.len())
}

/// The vertices that a file without texture coordinates and normals needs, and each drawn vertex's number among them:
/// vertices that a texture seam or a hard edge split are merged again.
pub(crate) fn merged(mesh: &NewMesh<'_>) -> (Vec<DrawnVertex>, Vec<u32>) {
    let mut first_of_file: Vec<Option<u32>> = vec![None; mesh.file_vertex_count];
    let mut kept = Vec::new();
    let mut number = Vec::with_capacity(mesh.positions.len());
    let colour = |v: usize| mesh.appearance.colours.as_ref().map(|colours| colours[v]);
    for (v, file) in mesh.file_vertex.iter().enumerate() {
        let first = first_of_file.get_mut(file.index());
        let twin = first.as_ref().and_then(|first| **first).filter(|&twin| {
            let DrawnVertex(other) = kept[twin as usize];
            bit_equal(mesh.positions[other as usize], mesh.positions[v]) && colour(other as usize) == colour(v)
        });
        number.push(twin.unwrap_or_else(|| {
            let fresh = kept.len() as u32;
            kept.push(DrawnVertex(v as u32));
            if let Some(first) = first {
                first.get_or_insert(fresh);
            }
            fresh
        }));
    }
    (kept, number)
}

/// The largest rounding of these coordinates to 32 bits, if it is more than a ten-millionth of the shape's size, as for
/// scans at geographic coordinates; `None` if 32 bits are precise enough.
pub(crate) fn coarse_in_f32(positions: &[DVec3]) -> Option<f64> {
    let finite = || positions.iter().filter(|position| position.is_finite());
    let min = finite().fold(DVec3::INFINITY, |min, &position| min.min(position));
    let max = finite().fold(DVec3::NEG_INFINITY, |max, &position| max.max(position));
    let rounding = min.abs().max(max.abs()).max_element() * f64::from(f32::EPSILON) / 2.0;
    (rounding > 1.5e-7 * min.distance(max)).then_some(rounding)
}

/// Returns true if the mesh has materials that differ from the plain one.
pub(crate) fn has_materials(look: &Appearance) -> bool {
    look.materials
        .iter()
        .any(|material| material.base_colour != [1.0; 4] || !material.name.is_empty())
}

/// A warning that names the parts of the mesh's appearance that a format can't hold; `None` if it holds everything.
pub(crate) fn lost(kind: &str, lost: &[(&str, Held)]) -> Option<String> {
    let names: Vec<&str> = lost
        .iter()
        .filter(|(_, held)| *held == Held::Lost)
        .map(|(name, _)| *name)
        .collect();
    let list = match names.as_slice() {
        [] => return None,
        [one] => (*one).to_owned(),
        [most @ .., last] => format!("{} and {last}", most.join(", ")),
    };
    Some(format!(
        "{kind} output leaves out the {list}: save as .glb to keep them."
    ))
}

/// The fate of a property that the mesh may have.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum Held {
    /// The mesh has none, or the target holds it.
    Kept,
    /// The mesh has it and the target can't hold it.
    Lost,
}

/// [`Held::Lost`] if the mesh has it and the target can't hold it.
pub(crate) fn lost_where(mesh_has_it: bool) -> Held {
    if mesh_has_it { Held::Lost } else { Held::Kept }
}
