//! A new OBJ file from any other format, with a material library and its textures if the mesh has materials.

use std::collections::{HashMap, HashSet};
use std::ops::Range;

use pliant_mesh::{Cancelled, DrawnVertex};

use crate::appearance::colour::{SrgbBytes, srgb_of_linear};
use crate::appearance::{AlphaMode, Material, Origin};
use crate::convert::NewMesh;
use crate::convert::faces::{for_each_face, lost, lost_where, merged};
use crate::gltf::{FROM_OUTSIDE, NO_IMAGE};
use crate::images::decodes;
use crate::obj::materials::neighbours;
use crate::obj::smoothing::is_flat;
use crate::quote::quoted;
use crate::save::colours::unit;
use crate::save::course::Course;
use crate::save::{OutputFile, Role, Saved, own_stem};
use crate::text::{push_f32, push_f64};
use crate::{Appearance, ObjNames, SaveError};

/// Writes a mesh as OBJ: a `v` line (with its colour) per vertex, a `vt` and a `vn` line per drawn vertex (vertices
/// that a texture seam or a hard edge split are merged again), and its faces by object and material.
pub(crate) fn write_new(mesh: &NewMesh<'_>, course: &Course<'_>) -> Result<Saved, SaveError> {
    let look = &mesh.appearance;
    let stem = &own_stem(mesh.name);
    if let Some(own) = &look.obj {
        return write_again(mesh, own, course);
    }
    let has_materials = look.materials.iter().any(|material| !is_plain(material));
    let names = material_names(look);
    let mut out = Vec::new();
    if has_materials {
        push_line(&mut out, &["mtllib ", stem, ".mtl"]);
    }
    let (of_vertices, of_faces) = course.split(0.6);
    let (vertices, number) = merged(mesh);
    push_vertices(&mut out, mesh, &vertices, &of_vertices)?;
    let names_of_faces = has_materials.then_some(names.as_slice());
    push_faces(&mut out, mesh, &number, names_of_faces, &of_faces)?;
    let mut saved = Saved::alone(mesh.name, out, Vec::new());
    if has_materials {
        let images = image_files(look, stem, &mut saved.warnings);
        saved.files.push(OutputFile {
            name: format!("{stem}.mtl"),
            role: Role::Library,
            bytes: library(look, &names, &images),
        });
        let mut written = HashSet::new();
        for (image, name) in look.images.iter().zip(images) {
            if let Some(name) = name.filter(|name| written.insert(name.clone())) {
                saved.files.push(OutputFile {
                    name,
                    role: Role::Image,
                    bytes: image.encoded.to_vec(),
                });
            }
        }
    }
    saved.warnings.extend(left_out(look));
    Ok(saved)
}

/// The same with the libraries, names and groups of the OBJ files that the mesh is made of.
fn write_again(mesh: &NewMesh<'_>, own: &ObjNames, course: &Course<'_>) -> Result<Saved, SaveError> {
    let mut out = Vec::new();
    for (path, _) in &own.libraries {
        push_line(&mut out, &["mtllib ", path]);
    }
    let (of_vertices, of_faces) = course.split(0.6);
    let (vertices, number) = merged(mesh);
    push_vertices(&mut out, mesh, &vertices, &of_vertices)?;
    let materials = mesh.appearance.materials.iter();
    let names: Vec<String> = materials.map(|material| material.name.clone()).collect();
    push_faces(&mut out, mesh, &number, Some(&names), &of_faces)?;
    let (neighbours, warnings) = neighbours(own);
    let mut saved = Saved::alone(mesh.name, out, warnings);
    saved.files.extend(neighbours);
    Ok(saved)
}

/// The properties of the materials that a material library can't express.
fn left_out(look: &Appearance) -> Option<String> {
    let any = |has: &dyn Fn(&Material) -> bool| lost_where(look.materials.iter().any(has));
    // Fully rough metal is glTF's default, for a file that does not specify it.
    let is_said = |material: &Material| material.metallic > 0.0 && material.roughness < 1.0;
    lost(
        "OBJ",
        &[
            (
                "metal and roughness",
                any(&|material| material.metallic_roughness_map.is_some() || is_said(material)),
            ),
            ("normal maps", any(&|material| material.normal_map.is_some())),
            ("occlusion maps", any(&|material| material.occlusion_map.is_some())),
            (
                "emission",
                any(&|material| material.emissive != [0.0; 3] || material.emissive_map.is_some()),
            ),
            ("second texture coordinates", lost_where(look.second_uvs.is_some())),
        ],
    )
}

/// Returns true if a material is the reader's default.
fn is_plain(material: &Material) -> bool {
    let plain = Material {
        double_sided: material.double_sided,
        ..Material::plain("")
    };
    *material == plain
}

fn push_line(out: &mut Vec<u8>, parts: &[&str]) {
    parts.iter().for_each(|part| out.extend_from_slice(part.as_bytes()));
    out.push(b'\n');
}

fn push_numbers<T: Copy>(out: &mut Vec<u8>, keyword: &str, numbers: &[T], push: impl Fn(&mut Vec<u8>, T)) {
    out.extend_from_slice(keyword.as_bytes());
    for &number in numbers {
        out.push(b' ');
        push(out, number);
    }
}

fn push_vertices(
    out: &mut Vec<u8>,
    mesh: &NewMesh<'_>,
    vertices: &[DrawnVertex],
    course: &Course<'_>,
) -> Result<(), Cancelled> {
    let srgb = SrgbBytes::new();
    let count = mesh.positions.len();
    let look = &mesh.appearance;
    let share_before = |is_more: bool| if is_more { 0.5 } else { 1.0 };
    let (of_positions, course) = course.split(share_before(look.uvs.is_some() || look.normals.is_some()));
    let (of_uvs, of_normals) = course.split(match (&look.uvs, &look.normals) {
        (None, _) => 0.0,
        (Some(_), normals) => share_before(normals.is_some()),
    });
    for (place, vertex) in vertices.iter().enumerate() {
        of_positions.pass(place, vertices.len())?;
        let v = vertex.index();
        push_numbers(out, "v", &mesh.positions[v].to_array(), push_f64);
        if let Some(colours) = &mesh.appearance.colours {
            let [r, g, b, _] = srgb.of_linear(colours[v]).map(unit);
            push_numbers(out, "", &[r, g, b], push_f32);
        }
        out.push(b'\n');
    }
    for (place, &[u, v]) in mesh.appearance.uvs.iter().flatten().enumerate() {
        of_uvs.pass(place, count)?;
        push_numbers(out, "vt", &[u, 1.0 - v], push_f32);
        out.push(b'\n');
    }
    for (place, normal) in mesh.appearance.normals.iter().flatten().enumerate() {
        of_normals.pass(place, count)?;
        push_numbers(out, "vn", normal, push_f32);
        out.push(b'\n');
    }
    Ok(())
}

fn push_faces(
    out: &mut Vec<u8>,
    mesh: &NewMesh<'_>,
    vertex_number: &[u32],
    material_names: Option<&[String]>,
    course: &Course<'_>,
) -> Result<(), Cancelled> {
    let mut groups = (0..).zip(&mesh.appearance.groups).peekable();
    let names_again = mesh.appearance.obj.as_ref();
    let (mut object, mut group_name, mut material) = (String::new(), String::new(), None);
    let mut smoothing = String::new();
    let count = mesh.positions.len() as u32;
    if names_again.is_none() && matches!(&mesh.appearance.flat[..], [whole] if *whole == (0..count)) {
        push_line(out, &["s off"]);
    }
    let (has_uvs, has_normals) = (mesh.appearance.uvs.is_some(), mesh.appearance.normals.is_some());
    let (mut number, mut own) = (Vec::new(), Vec::new());
    for_each_face(mesh, course, |corners, triangle| {
        while let Some((place, group)) = groups.next_if(|(_, group)| group.triangles.start as usize <= triangle) {
            if group.triangles.is_empty() {
                continue;
            }
            let names: Option<&[String; 3]> = names_again.and_then(|again| again.groups.get(place));
            let [own_object, own_group, own_smoothing] = names.map_or([&*group.node_name, "", ""], |names| {
                names.each_ref().map(|name| &**name)
            });
            let own_smoothing = match own_smoothing {
                // Faces without a group are drawn smooth, so flat ones before them end.
                "" if is_flat(&smoothing) => "1",
                "" => &*smoothing.clone(),
                group => group,
            };
            for (keyword, name, present) in [
                ("o ", own_object, &mut object),
                ("g ", own_group, &mut group_name),
                ("s ", own_smoothing, &mut smoothing),
            ] {
                if name != present {
                    push_line(out, &[keyword, &one_line(name)]);
                    name.clone_into(present);
                }
            }
            if let Some(names) = material_names
                && material != Some(group.material)
                && !names[group.material].is_empty()
            {
                push_line(out, &["usemtl ", &names[group.material]]);
                material = Some(group.material);
            }
        }
        out.push(b'f');
        for corner in corners {
            number.clear();
            push_f64(&mut number, f64::from(corner.0) + 1.0);
            own.clear();
            push_f64(&mut own, f64::from(vertex_number[corner.index()]) + 1.0);
            out.push(b' ');
            out.extend_from_slice(&own);
            if has_uvs || has_normals {
                out.push(b'/');
            }
            if has_uvs {
                out.extend_from_slice(&number);
            }
            if has_normals {
                out.push(b'/');
                out.extend_from_slice(&number);
            }
        }
        out.push(b'\n');
    })
}

/// A name that fits on a line.
fn one_line(name: &str) -> String {
    name.chars().map(|c| if c.is_control() { ' ' } else { c }).collect()
}

/// A unique name for each material, without the blanks at which many readers end a name.
fn material_names(look: &Appearance) -> Vec<String> {
    let mut taken = HashSet::new();
    let mut names = Vec::new();
    for (index, material) in look.materials.iter().enumerate() {
        let safe: String = material
            .name
            .chars()
            .map(|c| {
                if c.is_control() || c.is_whitespace() || c == '#' {
                    '_'
                } else {
                    c
                }
            })
            .collect();
        let mut name = if safe.is_empty() {
            format!("material_{index}")
        } else {
            safe
        };
        while !taken.insert(name.clone()) {
            name = format!("{name}_{index}");
        }
        names.push(name);
    }
    names
}

/// The file of each image; `None` for images that no material shows or whose bytes are missing.
fn image_files(look: &Appearance, stem: &str, warnings: &mut Vec<String>) -> Vec<Option<String>> {
    let used: HashSet<usize> = look
        .materials
        .iter()
        .filter_map(|material| material.base_colour_image)
        .collect();
    // One file for images of the same bytes.
    let mut name_of: HashMap<(usize, Range<usize>), String> = HashMap::new();
    let name = |(index, image): (usize, &crate::Image)| {
        let extension = match &*image.encoded {
            [] => return None,
            [0x89, b'P', b'N', b'G', ..] => "png",
            [0xff, 0xd8, ..] => "jpg",
            [b'R', b'I', b'F', b'F', ..] => "webp",
            [0xab, b'K', b'T', b'X', ..] => "ktx2",
            _ => image.name.rsplit_once('.').map_or("img", |(_, extension)| extension),
        };
        let is_safe = extension.len() <= 8 && extension.bytes().all(|byte| byte.is_ascii_alphanumeric());
        if !used.contains(&index) {
            return None;
        }
        if image.origin == Origin::Outside && !name_of.contains_key(&image.encoded.place()) {
            let name = quoted(&image.name);
            // A file from a stranger may name any file there, and a private file would be copied as an image.
            if !decodes(&image.encoded) {
                warnings.push(format!("{name} {NO_IMAGE}"));
                return None;
            }
            warnings.push(format!("{name} {FROM_OUTSIDE}"));
        }
        let name = || format!("{stem}_{index}.{}", if is_safe { extension } else { "img" });
        Some(name_of.entry(image.encoded.place()).or_insert_with(name).clone())
    };
    look.images.iter().enumerate().map(name).collect()
}

fn library(look: &Appearance, names: &[String], images: &[Option<String>]) -> Vec<u8> {
    let mut out = Vec::new();
    for (material, name) in look.materials.iter().zip(names) {
        push_line(&mut out, &["newmtl ", name]);
        let [r, g, b, alpha] = material.base_colour;
        push_numbers(
            &mut out,
            "Kd",
            &[r, g, b].map(|light| (srgb_of_linear(light) * 1e5).round() / 1e5),
            push_f32,
        );
        out.push(b'\n');
        if material.alpha == AlphaMode::Blend {
            push_numbers(&mut out, "d", &[alpha], push_f32);
            out.push(b'\n');
        }
        let image = material.base_colour_image.and_then(|index| images.get(index)?.as_ref());
        if let Some(image) = image {
            push_line(&mut out, &["map_Kd ", image]);
        }
    }
    out
}
