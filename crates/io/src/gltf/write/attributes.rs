//! The numbers of a primitive: attributes of its vertices, and indices.

use glam::{DVec3, Vec3};
use pliant_mesh::Cancelled;
use serde_json::{Value, json};

use super::buffer::Built;
use super::maps::second_set;
use crate::convert::NewMesh;
use crate::save::course::Course;

const ARRAY_BUFFER: u32 = 34962;
const ELEMENT_ARRAY_BUFFER: u32 = 34963;
const UNSIGNED_SHORT: u32 = 5123;
const UNSIGNED_INT: u32 = 5125;
const FLOAT: u32 = 5126;

/// The accessors of the attributes of `vertices`.
pub(super) fn attributes(
    out: &mut Built,
    mesh: &NewMesh<'_>,
    positions: &[Vec3],
    normals: &[Vec3],
    vertices: &[u32],
    course: &Course<'_>,
) -> Result<Value, Cancelled> {
    course.reach(0, 4)?;
    let looks = &mesh.appearance;
    let count = vertices.len();
    let each = || vertices.iter().map(|&v| v as usize);
    // A vertex that is not finite is used by no triangle; it keeps its number and gets the position of the first finite
    // one.
    let stand_in = each().map(|v| positions[v]).find(|position| position.is_finite());
    let stand_in = stand_in.unwrap_or(Vec3::ZERO);
    let sound = |v: usize| {
        if positions[v].is_finite() {
            positions[v]
        } else {
            stand_in
        }
    };
    let low = each().map(sound).fold(Vec3::INFINITY, Vec3::min);
    let high = each().map(sound).fold(Vec3::NEG_INFINITY, Vec3::max);
    let floats =
        |kind: &str, view: usize| json!({ "bufferView": view, "componentType": FLOAT, "count": count, "type": kind });
    let view = out.view(each().flat_map(|v| sound(v).to_array()), f32::to_le_bytes, ARRAY_BUFFER);
    let mut position = floats("VEC3", view);
    position["min"] = json!(low.as_dvec3().to_array());
    position["max"] = json!(high.as_dvec3().to_array());
    let position = out.accessor(position);
    course.reach(1, 4)?;
    let mut attributes = json!({ "POSITION": position });
    // Vertices without normals are shown flat.
    if !is_flat(mesh, vertices) {
        let numbers = each().flat_map(|v| normals[v].to_array());
        let view = out.view(numbers, f32::to_le_bytes, ARRAY_BUFFER);
        attributes["NORMAL"] = out.accessor(floats("VEC3", view)).into();
    }
    course.reach(2, 4)?;
    if let Some(uvs) = &looks.uvs {
        let finite = |number: f32| if number.is_finite() { number } else { 0.0 };
        let numbers = each().flat_map(|v| uvs[v].map(finite));
        let view = out.view(numbers, f32::to_le_bytes, ARRAY_BUFFER);
        attributes["TEXCOORD_0"] = out.accessor(floats("VEC2", view)).into();
    }
    if let (Some(uvs), Some(set)) = (&looks.second_uvs, second_set(mesh)) {
        let finite = |number: f32| if number.is_finite() { number } else { 0.0 };
        let numbers = each().flat_map(|v| uvs[v].map(finite));
        let view = out.view(numbers, f32::to_le_bytes, ARRAY_BUFFER);
        attributes[format!("TEXCOORD_{set}")] = out.accessor(floats("VEC2", view)).into();
    }
    course.reach(3, 4)?;
    if let Some(colours) = &looks.colours {
        // Linear light in 8 bits would lose a quarter of the greys of sRGB in 8 bits.
        let view = out.view(each().flat_map(|v| colours[v]), u16::to_le_bytes, ARRAY_BUFFER);
        attributes["COLOR_0"] = out
            .accessor(json!({
                "bufferView": view, "componentType": UNSIGNED_SHORT, "normalized": true,
                "count": count, "type": "VEC4",
            }))
            .into();
    }
    Ok(attributes)
}

/// Returns true if all of these vertices, which are in order, belong to flat triangles, or none does.
fn is_flat(mesh: &NewMesh<'_>, vertices: &[u32]) -> bool {
    let flat = &mesh.appearance.flat;
    let is_in = |v: u32| {
        let next = flat.partition_point(|range| range.end <= v);
        flat.get(next).is_some_and(|range| range.contains(&v))
    };
    let mut is_used = vec![false; if flat.is_empty() { 0 } else { mesh.positions.len() }];
    if flat.is_empty() {
        return false;
    }
    mesh.triangles
        .iter()
        .flatten()
        .for_each(|corner| is_used[corner.index()] = true);
    vertices.iter().all(|&v| is_in(v) || !is_used[v as usize])
}

/// Normals as unit vectors, as glTF requires: the file's own, or else the area-weighted mean of the faces around; the
/// drawn vertices of one file vertex share it.
pub(super) fn unit_normals(mesh: &NewMesh<'_>, course: &Course<'_>) -> Result<Vec<Vec3>, Cancelled> {
    let count = mesh.positions.len();
    let (of_faces_around, of_vertices) = course.split(0.6);
    let own = |v: usize| {
        let normals = mesh.appearance.normals.as_ref()?;
        Vec3::from(normals[v]).as_dvec3().try_normalize()
    };
    let lacks_some = (0..count).any(|v| own(v).is_none());
    let mut of_file = vec![DVec3::ZERO; if lacks_some { mesh.file_vertex_count } else { 0 }];
    if lacks_some {
        for (number, corners) in mesh.triangles.iter().enumerate() {
            of_faces_around.pass(number, mesh.triangles.len())?;
            let [a, b, c] = corners.map(|corner| mesh.positions[corner.index()]);
            let normal = (b - a).cross(c - a);
            for file in corners.map(|corner| mesh.file_vertex[corner.index()]) {
                if normal.is_finite() {
                    of_file[file.index()] += normal;
                }
            }
        }
    }
    let of_faces = |v: usize| of_file[mesh.file_vertex[v].index()].try_normalize();
    let normal = |v: usize| own(v).or_else(|| of_faces(v)).unwrap_or(DVec3::Z).as_vec3();
    let mut normals = Vec::with_capacity(count);
    for v in 0..count {
        of_vertices.pass(v, count)?;
        normals.push(normal(v));
    }
    Ok(normals)
}

/// The accessor of the corners of a primitive's triangles.
pub(super) fn indices(out: &mut Built, corners: impl ExactSizeIterator<Item = u32>, vertex_count: usize) -> usize {
    let count = corners.len();
    // The largest number of each type is reserved for restarting strips.
    let is_short = vertex_count <= usize::from(u16::MAX);
    let view = if is_short {
        out.view(
            corners.map(|corner| corner as u16),
            u16::to_le_bytes,
            ELEMENT_ARRAY_BUFFER,
        )
    } else {
        out.view(corners, u32::to_le_bytes, ELEMENT_ARRAY_BUFFER)
    };
    let kind = if is_short { UNSIGNED_SHORT } else { UNSIGNED_INT };
    out.accessor(json!({
        "bufferView": view, "componentType": kind, "count": count, "type": "SCALAR",
    }))
}
