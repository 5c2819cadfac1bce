//! A new USDZ file from a mesh of any other format: one mesh, with its colours, materials and images, as phones show it.
//!
//! The layer is text. Its numbers are metres, with y up, like glTF's. A shape far from its origin is stored relative to
//! a translation, because points of a mesh are f32.

mod materials;

use glam::DVec3;

use crate::archive::{Packing, archive_of};
use crate::convert::NewMesh;
use crate::convert::faces::{coarse_in_f32, lost, lost_where};
use crate::save::Saved;
use crate::save::course::Course;
use crate::text::{push_f32, push_f64};
use crate::{Format, SaveError};
use materials::{Materials, push_material};

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

fn push(out: &mut Vec<u8>, text: &str) {
    out.extend_from_slice(text.as_bytes());
}

/// Numbers with commas between them.
fn push_list<N: Copy>(out: &mut Vec<u8>, numbers: &[N], push_number: impl Fn(&mut Vec<u8>, N)) {
    for (place, &number) in numbers.iter().enumerate() {
        if place > 0 {
            push(out, ", ");
        }
        push_number(out, number);
    }
}

/// The middle of a shape's box, in whole units.
fn middle(positions: &[DVec3]) -> DVec3 {
    let finite = || positions.iter().filter(|position| position.is_finite());
    let min = finite().fold(DVec3::INFINITY, |min, &position| min.min(position));
    let max = finite().fold(DVec3::NEG_INFINITY, |max, &position| max.max(position));
    (0.5 * (min + max)).round()
}

fn push_mesh(
    out: &mut Vec<u8>,
    mesh: &NewMesh<'_>,
    origin: DVec3,
    materials: &Materials,
    course: &Course<'_>,
) -> Result<(), SaveError> {
    let look = &mesh.appearance;
    let count = mesh.positions.len();
    let (of_points, course) = course.split(0.4);
    let (of_triangles, course) = course.split(0.4);
    push(
        out,
        "    def Mesh \"Shape\" (\n        prepend apiSchemas = [\"MaterialBindingAPI\"]\n    )\n    {\n",
    );
    if look.materials.iter().any(|material| material.double_sided) {
        push(out, "        uniform bool doubleSided = 1\n");
    }
    // f32 begins here: points of a mesh are f32 in USD.
    let point = |position: DVec3| (position - origin).as_vec3();
    push_extent(out, mesh.positions.iter().map(|&position| point(position)));
    push(out, "        int[] faceVertexCounts = [");
    for (place, _) in mesh.triangles.iter().enumerate() {
        of_triangles.pass(place, mesh.triangles.len())?;
        push(out, if place > 0 { ", 3" } else { "3" });
    }
    push(out, "]\n        int[] faceVertexIndices = [");
    for (place, triangle) in mesh.triangles.iter().enumerate() {
        let [a, b, c] = triangle.map(|corner| corner.0);
        push(out, &format!("{}{a}, {b}, {c}", if place > 0 { ", " } else { "" }));
    }
    push(out, "]\n");
    if let [one] = materials.used[..] {
        push(
            out,
            &format!("        rel material:binding = </Model/Materials/Material_{one}>\n"),
        );
    }
    if let Some(normals) = &look.normals {
        push(out, "        normal3f[] normals = [");
        push_vectors(out, normals.iter().copied(), (count, &course))?;
        push(out, "] (\n            interpolation = \"vertex\"\n        )\n");
    }
    push(out, "        point3f[] points = [");
    push_vectors(
        out,
        mesh.positions.iter().map(|&position| point(position).to_array()),
        (count, &of_points),
    )?;
    push(out, "]\n");
    if let Some(colours) = &look.colours {
        push(out, "        color3f[] primvars:displayColor = [");
        let light = |channel: u16| f32::from(channel) / 65535.0;
        let colours = colours
            .iter()
            .map(|[red, green, blue, _]| [*red, *green, *blue].map(light));
        push_vectors(out, colours, (count, &course))?;
        push(out, "] (\n            interpolation = \"vertex\"\n        )\n");
    }
    if let Some(uvs) = &look.uvs {
        push(out, "        texCoord2f[] primvars:st = [");
        push_vectors(out, uvs.iter().map(|&[u, v]| [u, 1.0 - v]), (count, &course))?;
        push(out, "] (\n            interpolation = \"vertex\"\n        )\n");
    }
    push(out, "        uniform token subdivisionScheme = \"none\"\n");
    if materials.used.len() > 1 {
        push(
            out,
            "        uniform token subsetFamily:materialBind:familyType = \"partition\"\n",
        );
        push_subsets(out, mesh, materials);
    }
    push(out, "    }\n");
    Ok(())
}

fn push_extent(out: &mut Vec<u8>, points: impl Iterator<Item = glam::Vec3> + Clone) {
    let finite = || points.clone().filter(|point| point.is_finite());
    if finite().next().is_none() {
        return;
    }
    let min = finite().fold(glam::Vec3::INFINITY, glam::Vec3::min);
    let max = finite().fold(glam::Vec3::NEG_INFINITY, glam::Vec3::max);
    push(out, "        float3[] extent = [(");
    push_list(out, &min.to_array(), push_f32);
    push(out, "), (");
    push_list(out, &max.to_array(), push_f32);
    push(out, ")]\n");
}

fn push_vectors<const N: usize>(
    out: &mut Vec<u8>,
    vectors: impl Iterator<Item = [f32; N]>,
    (count, course): (usize, &Course<'_>),
) -> Result<(), SaveError> {
    for (place, vector) in vectors.enumerate() {
        course.pass(place, count)?;
        push(out, if place > 0 { ", (" } else { "(" });
        push_list(out, &vector, push_f32);
        push(out, ")");
    }
    Ok(())
}

/// The faces of each material.
fn push_subsets(out: &mut Vec<u8>, mesh: &NewMesh<'_>, materials: &Materials) {
    for &number in &materials.used {
        push(
            out,
            &format!(
                "\n        def GeomSubset \"Subset_{number}\" (\n            prepend apiSchemas = [\"MaterialBindingAPI\"]\n        )\n        \
                 {{\n            uniform token elementType = \"face\"\n            uniform token familyName = \"materialBind\"\n            \
                 int[] indices = ["
            ),
        );
        let groups = mesh.appearance.groups.iter().filter(|group| group.material == number);
        let faces: Vec<u32> = groups.flat_map(|group| group.triangles.clone()).collect();
        push_list(out, &faces, |out, face| push(out, &face.to_string()));
        push(
            out,
            &format!("]\n            rel material:binding = </Model/Materials/Material_{number}>\n        }}\n"),
        );
    }
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
