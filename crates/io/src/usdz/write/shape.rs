//! The mesh of a new file: points, faces, the attributes of points, and the faces of each material.

use glam::DVec3;

use super::materials::Materials;
use super::text::{push, push_list};
use crate::SaveError;
use crate::convert::NewMesh;
use crate::save::course::Course;
use crate::text::push_f32;

/// Appends the mesh, whose points are relative to `origin`.
///
/// # Errors
/// The caller cancelled.
pub(super) fn push_mesh(
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
