//! A new USDZ file from a mesh of any other format: one mesh, with its colours, materials and images, as phones show it.
//!
//! The layer is text. Its numbers are metres, with y up, like glTF's. A shape far from its origin is stored relative to
//! a translation, because points of a mesh are f32.

mod materials;
mod shape;
mod text;
mod texture;

use glam::DVec3;

use crate::archive::{Packing, archive_of};
use crate::convert::NewMesh;
use crate::convert::faces::{coarse_in_f32, lost, lost_where};
use crate::save::Saved;
use crate::save::course::Course;
use crate::text::push_f64;
use crate::{Format, SaveError};
use materials::{Materials, push_material};
use shape::push_mesh;
use text::{push, push_list};

/// The layer's name, which is the first in the archive.
const LAYER: &str = "model.usda";

/// Writes a mesh's triangles as USDZ.
pub(crate) fn write_new(mesh: &NewMesh<'_>, course: &Course<'_>) -> Result<Saved, SaveError> {
    let materials = Materials::of(mesh);
    let origin = match coarse_in_f32(mesh.positions) {
        Some(_) => middle(mesh.positions),
        None => DVec3::ZERO,
    };
    let mut layer = Vec::new();
    push(
        &mut layer,
        "#usda 1.0\n(\n    defaultPrim = \"Model\"\n    metersPerUnit = 1\n    upAxis = \"Y\"\n)\n\n\
         def Xform \"Model\" (\n    kind = \"component\"\n)\n{\n",
    );
    if origin != DVec3::ZERO {
        push(&mut layer, "    double3 xformOp:translate = (");
        push_list(&mut layer, &origin.to_array(), push_f64);
        push(
            &mut layer,
            ")\n    uniform token[] xformOpOrder = [\"xformOp:translate\"]\n\n",
        );
    }
    push_mesh(&mut layer, mesh, origin, &materials, course)?;
    push(&mut layer, "\n    def Scope \"Materials\"\n    {\n");
    for &number in &materials.used {
        push_material(&mut layer, number, mesh, &materials);
    }
    push(&mut layer, "    }\n}\n");

    let mut parts: Vec<(&str, &[u8])> = vec![(LAYER, &layer)];
    for (image, path) in mesh.appearance.images.iter().zip(&materials.images) {
        if let Some(path) = path {
            parts.push((path, &image.encoded));
        }
    }
    let bytes = archive_of(&parts, Packing::Aligned).map_err(|what| SaveError::CannotHold {
        what: format!("this file, because {what},"),
        format: Format::Usdz,
        remedy: "save in another format".to_owned(),
    })?;
    Ok(Saved::alone(mesh.name, bytes, left_out(mesh, &materials)))
}

/// The middle of a shape's box, in whole units.
fn middle(positions: &[DVec3]) -> DVec3 {
    let finite = || positions.iter().filter(|position| position.is_finite());
    let min = finite().fold(DVec3::INFINITY, |min, &position| min.min(position));
    let max = finite().fold(DVec3::NEG_INFINITY, |max, &position| max.max(position));
    (0.5 * (min + max)).round()
}

/// Warnings about data that USDZ can't hold.
fn left_out(mesh: &NewMesh<'_>, materials: &Materials) -> Vec<String> {
    let look = &mesh.appearance;
    let has_alpha = |colours: &Vec<[u16; 4]>| colours.iter().any(|colour| colour[3] != u16::MAX);
    let is_missing = look
        .images
        .iter()
        .zip(&materials.images)
        .any(|(_, path)| path.is_none());
    let mut warnings: Vec<String> = lost(
        "USDZ",
        &[
            ("second texture coordinates", lost_where(look.second_uvs.is_some())),
            (
                "opacity of vertices",
                lost_where(look.colours.as_ref().is_some_and(has_alpha)),
            ),
            ("images that are neither PNG nor JPEG", lost_where(is_missing)),
            (
                "textures that are moved or turned on the surface",
                lost_where(materials.has_moved_maps),
            ),
        ],
    )
    .into_iter()
    .collect();
    if mesh.polygons.is_some() {
        warnings.push("USDZ is written with triangles, so polygons were cut: save as .obj to keep them.".to_owned());
    }
    warnings
}
