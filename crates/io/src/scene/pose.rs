//! Poses: files with the same vertices and faces in other places.
//!
//! Two poses may be drawn with different triangles and drawn vertices: a polygon is cut by its shape, and corners of
//! one vertex are drawn separately if their normals differ. The file's own faces and vertices stay the same.

use glam::DVec3;
use pliant_mesh::{Drawn, DrawnVertex};

use crate::save::bits::bit_equal;
use crate::scene::check::Faces;
use crate::scene::stored::Scene;

/// The pose's position for each of the drawn vertices of `rest`; `None` if it has other vertices or faces. `rest` and
/// `pose` are scenes with their drawn sets.
pub fn positions_in_pose(rest: (&Scene, &Drawn), pose: (&Scene, &Drawn)) -> Option<Vec<DVec3>> {
    let (own, other) = (rest.1, pose.1);
    if own.positions.len() == other.positions.len() && own.triangles == other.triangles {
        return Some(other.positions.clone());
    }
    if own.file_vertex_count != other.file_vertex_count || !has_same_faces(rest, pose) {
        return None;
    }
    let places = places(other)?;
    own.file_vertex.iter().map(|vertex| places[vertex.index()]).collect()
}

/// Returns true if two files have the same faces over their own vertices.
pub(crate) fn has_same_faces((scene, drawn): (&Scene, &Drawn), (other, other_drawn): (&Scene, &Drawn)) -> bool {
    let (own, other) = (Faces::of(scene, drawn), Faces::of(other, other_drawn));
    let (mut own, mut other) = (own.iter(), other.iter());
    let vertices = |drawn: &Drawn, face: &[DrawnVertex]| {
        let corners = face.iter().map(|corner| drawn.file_vertex[corner.index()]);
        corners.collect::<Vec<_>>()
    };
    loop {
        match (own.next(), other.next()) {
            (None, None) => return true,
            (Some(a), Some(b)) if vertices(drawn, a) == vertices(other_drawn, b) => {}
            _ => return false,
        }
    }
}

/// The position of each vertex of the file; `None` if one is at several places.
fn places(drawn: &Drawn) -> Option<Vec<Option<DVec3>>> {
    let mut places: Vec<Option<DVec3>> = vec![None; drawn.file_vertex_count];
    for (vertex, &position) in drawn.file_vertex.iter().zip(&drawn.positions) {
        let known = places[vertex.index()].get_or_insert(position);
        if !bit_equal(*known, position) {
            return None;
        }
    }
    Some(places)
}
