//! Writes a new binary STL file from a mesh of any other format.

use crate::SaveError;
use crate::convert::NewMesh;
use crate::convert::faces::{coarse_in_f32, has_materials, lost, lost_where};
use crate::save::Saved;
use crate::save::course::Course;

use super::facets::facet_normal;

/// Writes a mesh's triangles as binary STL, which stores only their corners.
pub(crate) fn write_new(mesh: &NewMesh<'_>, course: &Course<'_>) -> Result<Saved, SaveError> {
    let look = &mesh.appearance;
    let mut out = Vec::with_capacity(84 + 50 * mesh.triangles.len());
    // Not "solid", because readers recognise ascii files by it.
    out.extend_from_slice(b"Pliant");
    out.resize(80, b' ');
    out.extend_from_slice(&(mesh.triangles.len() as u32).to_le_bytes());
    for (place, triangle) in mesh.triangles.iter().enumerate() {
        course.pass(place, mesh.triangles.len())?;
        let corners = triangle.map(|corner| mesh.positions[corner.index()]);
        let mut push = |vector: glam::DVec3| {
            // f32 is the format's precision.
            vector
                .as_vec3()
                .to_array()
                .iter()
                .for_each(|number| out.extend_from_slice(&number.to_le_bytes()));
        };
        push(facet_normal(corners));
        corners.into_iter().for_each(&mut push);
        out.extend_from_slice(&[0; 2]);
    }
    let mut warnings: Vec<String> = lost(
        "STL",
        &[
            ("normals", lost_where(look.normals.is_some())),
            ("colours", lost_where(look.colours.is_some())),
            ("texture coordinates", lost_where(look.uvs.is_some())),
            ("materials", lost_where(has_materials(look))),
            ("textures", lost_where(!look.images.is_empty())),
        ],
    )
    .into_iter()
    .collect();
    if mesh.polygons.is_some() {
        warnings.push("STL holds only triangles, so polygons were cut: save as .obj to keep them.".to_owned());
    }
    if let Some(rounding) = coarse_in_f32(mesh.positions) {
        warnings.push(format!(
            "STL holds 32-bit numbers, which round positions this far from the origin by up to {rounding:.1e}: save as .obj to keep them."
        ));
    }
    Ok(Saved::alone(mesh.name, out, warnings))
}
