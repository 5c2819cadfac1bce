//! A new OFF file (COFF if there are colours) from any other format.

use crate::SaveError;
use crate::appearance::colour::SrgbBytes;
use crate::convert::NewMesh;
use crate::convert::faces::{face_count, for_each_face, has_materials, lost, lost_where, merged};
use crate::save::Saved;
use crate::save::course::Course;
use crate::text::push_f64;

/// Writes a mesh's positions, colours and faces. Normals are left to the reader: few programs read the variants with
/// normals beside colours.
pub(crate) fn write_new(mesh: &NewMesh<'_>, course: &Course<'_>) -> Result<Saved, SaveError> {
    let look = &mesh.appearance;
    let srgb = SrgbBytes::new();
    let (vertices, number) = merged(mesh);
    let keyword = if look.colours.is_some() { "COFF" } else { "OFF" };
    let mut out = format!("{keyword}\n{} {} 0\n", vertices.len(), face_count(mesh)).into_bytes();
    let (of_vertices, of_faces) = course.split(0.5);
    for (place, vertex) in vertices.iter().enumerate() {
        of_vertices.pass(place, vertices.len())?;
        for (axis, coordinate) in mesh.positions[vertex.index()].to_array().into_iter().enumerate() {
            if axis > 0 {
                out.push(b' ');
            }
            push_f64(&mut out, coordinate);
        }
        if let Some(colours) = &look.colours {
            for channel in srgb.of_linear(colours[vertex.index()]) {
                out.push(b' ');
                push_f64(&mut out, f64::from(channel));
            }
        }
        out.push(b'\n');
    }
    for_each_face(mesh, &of_faces, |corners, _| {
        push_f64(&mut out, corners.len() as f64);
        for corner in corners {
            out.push(b' ');
            push_f64(&mut out, f64::from(number[corner.index()]));
        }
        out.push(b'\n');
    })?;
    let warning = lost(
        "OFF",
        &[
            ("normals", lost_where(look.normals.is_some())),
            ("texture coordinates", lost_where(look.uvs.is_some())),
            ("materials", lost_where(has_materials(look))),
            ("textures", lost_where(!look.images.is_empty())),
        ],
    );
    Ok(Saved::alone(mesh.name, out, warning.into_iter().collect()))
}
