//! A new glTF from another format: a node and a mesh for each named part, a primitive for each material in it.
//!
//! A file of one part keeps the order and number of the drawn vertices. If there are several parts, each has the
//! vertices that it uses, in their order, so that vertices between two parts occur twice. If the shape is so far from
//! the origin that f32 would round it, its vertices are relative to its centre, and the node has the translation.

mod attributes;
mod buffer;
mod looks;
mod maps;
mod materials;
mod originals;
mod parts;

use glam::{DVec3, Vec3};
use pliant_mesh::bounding_box;
use serde_json::{Value, json};

use crate::convert::NewMesh;
use crate::convert::faces::coarse_in_f32;
use crate::gltf::join_glb;
use crate::save::course::Course;
use crate::save::{OutputFile, Role, Saved, own_stem};
use crate::{Format, SaveError};
use attributes::{attributes, indices, unit_normals};
use buffer::Built;
use looks::Looks;
use parts::{NamedPart, order, parts};

/// The mesh as a GLB.
pub(crate) fn write_new(mesh: &NewMesh<'_>, course: &Course<'_>) -> Result<Saved, SaveError> {
    let built = build(mesh, Format::Glb, course)?;
    let text = built.root.to_string();
    let bytes = join_glb(text.as_bytes(), &built.bin).ok_or(SaveError::TooLarge { format: Format::Glb })?;
    Ok(Saved {
        triangles: built.triangles,
        ..Saved::alone(mesh.name, bytes, built.warnings)
    })
}

/// The mesh as a `.gltf` and its buffer, which has OUT's name.
pub(crate) fn write_new_gltf(mesh: &NewMesh<'_>, course: &Course<'_>) -> Result<Saved, SaveError> {
    let mut built = build(mesh, Format::Gltf, course)?;
    let buffer_name = format!("{}.bin", own_stem(mesh.name));
    built.root["buffers"][0]["uri"] = crate::gltf::encoded_uri(&buffer_name).into();
    let text = format!("{:#}\n", built.root);
    let mut saved = Saved::alone(mesh.name, text.into_bytes(), built.warnings);
    saved.triangles = built.triangles;
    saved.files.push(OutputFile {
        name: buffer_name,
        role: Role::Buffer,
        bytes: built.bin,
    });
    Ok(saved)
}

fn build(mesh: &NewMesh<'_>, format: Format, course: &Course<'_>) -> Result<Built, SaveError> {
    course.reach(0, 1)?;
    let (of_looks, course) = course.split(0.5);
    let (of_parts, of_normals) = of_looks.split(0.5);
    let mut out = Built::default();
    let (positions, centre) = about_centre(mesh);
    let parts = parts(mesh, &positions, &mut out.warnings, &of_parts)?;
    if parts.is_empty() {
        return Err(SaveError::CannotHold {
            what: "a shape without triangles".to_owned(),
            format,
            remedy: "save it in its own format".to_owned(),
        });
    }
    out.triangles = order(&parts, mesh.triangles.len());
    let normals = unit_normals(mesh, &of_normals)?;
    let mut looks = Looks::default();
    let mut numbering = Numbering {
        own: vec![u32::MAX; positions.len()],
        count: 0,
    };
    let (mut nodes, mut meshes) = (Vec::new(), Vec::new());
    for (place, part) in parts.iter().enumerate() {
        let course = course.part(
            place as f32 / parts.len() as f32,
            (place + 1) as f32 / parts.len() as f32,
        );
        let vertices = match parts.len() {
            1 => (0..positions.len() as u32).collect(),
            _ => part.vertices(mesh),
        };
        numbering.number(&vertices);
        let (of_attributes, course) = course.split(0.7);
        let attributes = attributes(&mut out, mesh, &positions, &normals, &vertices, &of_attributes)?;
        let primitives = primitives(&mut out, &mut looks, mesh, part, &attributes, &numbering, &course)?;
        let name = if part.name.is_empty() {
            stem(mesh.name)
        } else {
            part.name
        };
        let mut node = json!({ "name": name, "mesh": place });
        if centre != DVec3::ZERO {
            node["translation"] = json!(centre.to_array());
        }
        nodes.push(node);
        meshes.push(json!({ "name": name, "primitives": primitives }));
    }
    let mut root = json!({
        "asset": { "version": "2.0", "generator": "Pliant" },
        "scene": 0,
        "scenes": [{ "nodes": (0..nodes.len()).collect::<Vec<_>>() }],
        "nodes": nodes,
        "meshes": meshes,
        "buffers": [{ "byteLength": out.bin.len() }],
        "bufferViews": out.views,
        "accessors": out.accessors,
    });
    looks.add_to(&mut root);
    if mesh.polygons.is_some() {
        let warning = format!("{format} holds only triangles, so polygons were cut: save as .obj to keep them.");
        out.warnings.push(warning);
    }
    out.root = root;
    Ok(out)
}

/// The positions relative to a centre, which is zero unless f32 would round them.
fn about_centre(mesh: &NewMesh<'_>) -> (Vec<Vec3>, DVec3) {
    let finite: Vec<DVec3> = mesh
        .positions
        .iter()
        .copied()
        .filter(|position| position.is_finite())
        .collect();
    let centre = coarse_in_f32(&finite).and_then(|_| bounding_box(&finite));
    let centre = centre.map_or(DVec3::ZERO, |bounds| bounds.centre());
    // f32 begins here: glTF positions are f32.
    let relative = |&position: &DVec3| (position - centre).as_vec3();
    (mesh.positions.iter().map(relative).collect(), centre)
}

/// The numbers of vertices in the present part.
struct Numbering {
    /// By the mesh's number; vertices of other parts keep earlier values.
    own: Vec<u32>,
    count: usize,
}

impl Numbering {
    /// Numbers the vertices of a part in order.
    fn number(&mut self, vertices: &[u32]) {
        for (own, &v) in (0..).zip(vertices) {
            self.own[v as usize] = own;
        }
        self.count = vertices.len();
    }
}

/// A part's primitives, one for each material.
fn primitives(
    out: &mut Built,
    looks: &mut Looks,
    mesh: &NewMesh<'_>,
    part: &NamedPart<'_>,
    attributes: &Value,
    numbering: &Numbering,
    course: &Course<'_>,
) -> Result<Vec<Value>, SaveError> {
    let mut primitives = Vec::new();
    for (place, (material, triangles)) in part.triangles.iter().enumerate() {
        course.reach(place, part.triangles.len())?;
        let corner = |k: usize| mesh.triangles[triangles[k / 3] as usize][k % 3];
        let corners = (0..3 * triangles.len()).map(|k| numbering.own[corner(k).index()]);
        let indices = indices(out, corners, numbering.count);
        let mut primitive = json!({ "attributes": attributes, "indices": indices });
        if let Some(known) = mesh.appearance.materials.get(*material) {
            primitive["material"] = looks.material(out, mesh, *material, known).into();
        }
        primitives.push(primitive);
    }
    Ok(primitives)
}

fn stem(name: &str) -> &str {
    name.rsplit_once('.').map_or(name, |(stem, _)| stem)
}
