//! A new PLY file, binary and little-endian, from any other format.

use pliant_mesh::DrawnVertex;

use crate::SaveError;
use crate::appearance::colour::SrgbBytes;
use crate::convert::NewMesh;
use crate::convert::faces::{coarse_in_f32, face_count, for_each_face, has_materials, lost, lost_where, merged};
use crate::save::Saved;
use crate::save::course::Course;

/// Writes a mesh as PLY: positions (as `double` if `float` would round visibly), and normals, texture coordinates and
/// colours if the mesh has them.
pub(crate) fn write_new(mesh: &NewMesh<'_>, course: &Course<'_>) -> Result<Saved, SaveError> {
    let look = &mesh.appearance;
    let (vertices, number) = if look.normals.is_none() && look.uvs.is_none() {
        merged(mesh)
    } else {
        let count = mesh.positions.len() as u32;
        ((0..count).map(DrawnVertex).collect(), (0..count).collect())
    };
    let is_double = coarse_in_f32(mesh.positions).is_some();
    let mut most_corners = 0;
    let (of_widths, course) = course.split(0.1);
    let (of_vertices, of_faces) = course.split(0.6);
    for_each_face(mesh, &of_widths, |corners, _| {
        most_corners = most_corners.max(corners.len());
    })?;
    let is_wide = most_corners > 255;

    let mut out = header(mesh, vertices.len(), is_double, is_wide).into_bytes();
    push_vertices(&mut out, mesh, &vertices, is_double, &of_vertices)?;
    for_each_face(mesh, &of_faces, |corners, _| {
        if is_wide {
            out.extend_from_slice(&(corners.len() as u32).to_le_bytes());
        } else {
            out.push(corners.len() as u8);
        }
        for corner in corners {
            out.extend_from_slice(&number[corner.index()].to_le_bytes());
        }
    })?;
    let warning = lost(
        "PLY",
        &[
            ("materials", lost_where(has_materials(look))),
            ("textures", lost_where(!look.images.is_empty())),
        ],
    );
    Ok(Saved::alone(mesh.name, out, warning.into_iter().collect()))
}

fn header(mesh: &NewMesh<'_>, vertex_count: usize, is_double: bool, is_wide: bool) -> String {
    let look = &mesh.appearance;
    let mut header = format!("ply\nformat binary_little_endian 1.0\nelement vertex {vertex_count}\n");
    let mut property = |kind: &str, names: &[&str]| {
        names
            .iter()
            .for_each(|name| header.push_str(&format!("property {kind} {name}\n")));
    };
    property(if is_double { "double" } else { "float" }, &["x", "y", "z"]);
    if look.normals.is_some() {
        property("float", &["nx", "ny", "nz"]);
    }
    if look.uvs.is_some() {
        property("float", &["s", "t"]);
    }
    if look.colours.is_some() {
        property("uchar", &["red", "green", "blue", "alpha"]);
    }
    let count_kind = if is_wide { "uint" } else { "uchar" };
    header
        + &format!(
            "element face {}\nproperty list {count_kind} int vertex_indices\nend_header\n",
            face_count(mesh)
        )
}

fn push_vertices(
    out: &mut Vec<u8>,
    mesh: &NewMesh<'_>,
    vertices: &[DrawnVertex],
    is_double: bool,
    course: &Course<'_>,
) -> Result<(), SaveError> {
    let look = &mesh.appearance;
    let srgb = SrgbBytes::new();
    for (place, vertex) in vertices.iter().enumerate() {
        course.pass(place, vertices.len())?;
        let v = vertex.index();
        for coordinate in mesh.positions[v].to_array() {
            if is_double {
                out.extend_from_slice(&coordinate.to_le_bytes());
                continue;
            }
            // f32: precise enough here, as `coarse_in_f32` found.
            out.extend_from_slice(&(coordinate as f32).to_le_bytes());
        }
        for number in look.normals.iter().flat_map(|normals| normals[v]) {
            out.extend_from_slice(&number.to_le_bytes());
        }
        if let Some(uvs) = &look.uvs {
            let [s, t] = uvs[v];
            out.extend_from_slice(&s.to_le_bytes());
            out.extend_from_slice(&(1.0 - t).to_le_bytes());
        }
        if let Some(colours) = &look.colours {
            out.extend_from_slice(&srgb.of_linear(colours[v]));
        }
    }
    Ok(())
}
