//! A new glTF from the other kinds: a node and a mesh for each named part, a primitive for each material in it.
//!
//! A file of one part keeps the order and number of the drawn vertices; of several, each takes the vertices that it
//! uses, in their order, so that those on a rim between two come twice. Where the shape stands so far out that f32 would round it,
//! the vertices are taken relative to its centre and the node carries the way there.

use std::collections::{BTreeMap, HashMap};
use std::ops::Range;

use glam::{DVec3, Vec3};
use pliant_mesh::{Cancelled, DrawnVertex, bounding_box};
use serde_json::{Value, json};

use crate::appearance::{AlphaMode, Material, Origin, Wrap};
use crate::course::Course;
use crate::gltf::{FROM_OUTSIDE, NO_IMAGE, join_glb};
use crate::image::mime_type;
use crate::images::decodes;
use crate::new_faces::coarse_in_f32;
use crate::new_mesh::{NewMesh, Parting};
use crate::quote::quoted;
use crate::save::{OutputFile, Role, Saved, own_stem};
use crate::{Format, SaveError};

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

/// The mesh as a `.gltf` and its buffer, which is called as OUT is.
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

/// A glTF that is being put together.
#[derive(Default)]
struct Built {
    root: Value,
    bin: Vec<u8>,
    views: Vec<Value>,
    accessors: Vec<Value>,
    warnings: Vec<String>,
    /// As [`Saved::triangles`].
    triangles: Option<Vec<u32>>,
}

/// More parts than this are joined: viewers draw each by itself.
const MOST_PARTS: usize = 1024;

const ARRAY_BUFFER: u32 = 34962;
const ELEMENT_ARRAY_BUFFER: u32 = 34963;
const UNSIGNED_BYTE: u32 = 5121;
const UNSIGNED_SHORT: u32 = 5123;
const UNSIGNED_INT: u32 = 5125;
const FLOAT: u32 = 5126;

fn build(mesh: &NewMesh<'_>, format: Format, course: &Course<'_>) -> Result<Built, SaveError> {
    course.reach(0, 1)?;
    let (of_looks, course) = course.split(0.5);
    let (of_parts, of_normals) = of_looks.split(0.5);
    let mut out = Built::default();
    let finite: Vec<DVec3> = mesh
        .positions
        .iter()
        .copied()
        .filter(|position| position.is_finite())
        .collect();
    let centre = coarse_in_f32(&finite).and_then(|_| bounding_box(&finite));
    let centre = centre.map_or(DVec3::ZERO, |bounds| bounds.centre());
    // f32 begins here: glTF positions are f32.
    let positions: Vec<Vec3> = mesh
        .positions
        .iter()
        .map(|&position| (position - centre).as_vec3())
        .collect();
    let parts = parts(mesh, &positions, &mut out.warnings, &of_parts)?;
    if parts.is_empty() {
        return Err(SaveError::CannotHold {
            what: "a shape without triangles".to_owned(),
            format,
            remedy: "save it as the kind it was".to_owned(),
        });
    }
    out.triangles = order(&parts, mesh.triangles.len());
    let normals = unit_normals(mesh, &of_normals)?;
    let mut looks = Looks::default();
    let mut number = vec![u32::MAX; positions.len()];
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
        for (own, &v) in (0..).zip(&vertices) {
            number[v as usize] = own;
        }
        let (of_attributes, course) = course.split(0.7);
        let attributes = attributes(&mut out, mesh, &positions, &normals, &vertices, &of_attributes)?;
        let mut primitives = Vec::new();
        for (place, (material, triangles)) in part.triangles.iter().enumerate() {
            course.reach(place, part.triangles.len())?;
            let corner = |k: usize| mesh.triangles[triangles[k / 3] as usize][k % 3];
            let corners = (0..3 * triangles.len()).map(|k| number[corner(k).index()]);
            let indices = indices(&mut out, corners, vertices.len());
            let mut primitive = json!({ "attributes": attributes, "indices": indices });
            if let Some(known) = mesh.appearance.materials.get(*material) {
                primitive["material"] = looks.material(&mut out, mesh, *material, known).into();
            }
            primitives.push(primitive);
        }
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
    out.root = root;
    Ok(out)
}

/// What becomes a node.
struct Part<'a> {
    name: &'a str,
    /// The numbers of its triangles, by material.
    triangles: BTreeMap<usize, Vec<u32>>,
}

impl Part<'_> {
    /// The vertices that it uses, ascending.
    fn vertices(&self, mesh: &NewMesh<'_>) -> Vec<u32> {
        let mut vertices: Vec<u32> = self.corners(mesh).map(|corner| corner.0).collect();
        vertices.sort_unstable();
        vertices.dedup();
        vertices
    }

    /// The corners of its triangles.
    fn corners<'a>(&'a self, mesh: &'a NewMesh<'_>) -> impl Iterator<Item = DrawnVertex> + 'a {
        let triangles = self.triangles.values().flatten();
        triangles.flat_map(|&triangle| mesh.triangles[triangle as usize])
    }
}

/// The triangles in the order in which the parts hold them; `None` where that is all of them, as they were.
fn order(parts: &[Part<'_>], count: usize) -> Option<Vec<u32>> {
    let written = || parts.iter().flat_map(|part| part.triangles.values().flatten().copied());
    let is_old = written().eq(0..count as u32);
    (!is_old).then(|| written().collect())
}

/// The parts in the order in which the file first names them, triangles with a vertex that glTF can't hold left out.
fn parts<'a>(
    mesh: &'a NewMesh<'_>,
    positions: &[Vec3],
    warnings: &mut Vec<String>,
    course: &Course<'_>,
) -> Result<Vec<Part<'a>>, Cancelled> {
    let groups = &mesh.appearance.groups;
    let mut names: Vec<&str> = Vec::new();
    let mut place_of: HashMap<&str, usize> = HashMap::new();
    for group in groups {
        place_of.entry(&group.node_name).or_insert_with(|| {
            names.push(&group.node_name);
            names.len() - 1
        });
    }
    let is_parted = mesh.parting == Parting::ByName && names.len() <= MOST_PARTS;
    if !is_parted {
        let lost = (names.len() > 1).then(|| {
            format!(
                "The file's {} groups became one mesh: save as .obj to keep them apart.",
                names.len()
            )
        });
        warnings.extend(lost);
        names.truncate(usize::from(names.len() == 1));
    }
    if names.is_empty() {
        names.push("");
    }
    let mut parts: Vec<Part<'_>> = names
        .into_iter()
        .map(|name| Part {
            name,
            triangles: BTreeMap::new(),
        })
        .collect();
    let mut left_out = 0;
    let grouped = groups.iter().map(|group| {
        let place = if is_parted {
            place_of[group.node_name.as_str()]
        } else {
            0
        };
        (place, group.material, group.triangles.clone())
    });
    let ungrouped = groups
        .is_empty()
        .then_some((0, usize::MAX, 0..mesh.triangles.len() as u32));
    for (place, material, range) in grouped.chain(ungrouped) {
        let (start, end) = (range.start as usize, range.end as usize);
        for (number, triangle) in (start..).zip(&mesh.triangles[start..end]) {
            course.pass(number, mesh.triangles.len())?;
            if triangle.iter().all(|corner| positions[corner.index()].is_finite()) {
                parts[place].triangles.entry(material).or_default().push(number as u32);
            } else {
                left_out += 1;
            }
        }
    }
    if left_out > 0 {
        warnings.push(format!(
            "glTF output leaves out {left_out} triangles with a vertex that is not a finite number."
        ));
    }
    parts.retain(|part| !part.triangles.is_empty());
    if parts.len() > 1 {
        let mut is_used = vec![false; positions.len()];
        let corners = parts.iter().flat_map(|part| part.corners(mesh));
        corners.for_each(|corner| is_used[corner.index()] = true);
        let unused = is_used.iter().filter(|is_used| !**is_used).count();
        if unused > 0 {
            warnings.push(format!(
                "glTF output leaves out the vertices that no triangle uses ({unused}): save as .obj to keep them."
            ));
        }
    }
    Ok(parts)
}

/// The accessors of the attributes of `vertices`.
fn attributes(
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
    // A vertex that is not finite is used by no triangle; it keeps its number and stands with the first sound one.
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
    let view = out.view(
        each().flat_map(|v| normals[v].to_array()),
        f32::to_le_bytes,
        ARRAY_BUFFER,
    );
    let normal = out.accessor(floats("VEC3", view));
    course.reach(2, 4)?;
    let mut attributes = json!({ "POSITION": position, "NORMAL": normal });
    if let Some(uvs) = &looks.uvs {
        let finite = |number: f32| if number.is_finite() { number } else { 0.0 };
        let numbers = each().flat_map(|v| uvs[v].map(finite));
        let view = out.view(numbers, f32::to_le_bytes, ARRAY_BUFFER);
        attributes["TEXCOORD_0"] = out.accessor(floats("VEC2", view)).into();
    }
    course.reach(3, 4)?;
    if let Some(colours) = &looks.colours {
        let view = out.view(each().flat_map(|v| colours[v]), u8::to_le_bytes, ARRAY_BUFFER);
        attributes["COLOR_0"] = out
            .accessor(json!({
                "bufferView": view, "componentType": UNSIGNED_BYTE, "normalized": true,
                "count": count, "type": "VEC4",
            }))
            .into();
    }
    Ok(attributes)
}

/// Normals of unit length, as glTF insists: the file's own, or where it has none the mean of the faces around, by
/// area; vertices of one file vertex share it.
fn unit_normals(mesh: &NewMesh<'_>, course: &Course<'_>) -> Result<Vec<Vec3>, Cancelled> {
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
fn indices(out: &mut Built, corners: impl ExactSizeIterator<Item = u32>, vertex_count: usize) -> usize {
    let count = corners.len();
    // The largest number of each type is kept for restarting strips.
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

impl Built {
    /// Puts numbers into the buffer, as a view for vertices or indices.
    fn view<T, const N: usize>(
        &mut self,
        numbers: impl Iterator<Item = T>,
        bytes: impl Fn(T) -> [u8; N],
        target: u32,
    ) -> usize {
        let view = self.bytes(numbers.flat_map(bytes));
        self.views[view]["target"] = target.into();
        view
    }

    /// Puts bytes into the buffer, as a view.
    fn bytes(&mut self, bytes: impl Iterator<Item = u8>) -> usize {
        let start = self.bin.len();
        self.bin.extend(bytes);
        let length = self.bin.len() - start;
        self.bin.resize(self.bin.len().next_multiple_of(4), 0);
        self.views
            .push(json!({ "buffer": 0, "byteOffset": start, "byteLength": length }));
        self.views.len() - 1
    }

    fn accessor(&mut self, accessor: Value) -> usize {
        self.accessors.push(accessor);
        self.accessors.len() - 1
    }
}

/// Materials, textures, samplers and images, those that are used.
#[derive(Default)]
struct Looks {
    materials: Vec<Value>,
    /// The written material of each of the appearance's.
    material_of: BTreeMap<usize, usize>,
    textures: Vec<Value>,
    samplers: Vec<Value>,
    images: Vec<Value>,
    /// The written image of each of the appearance's; `None` where it can't be held.
    image_of: BTreeMap<usize, Option<usize>>,
    /// The written texture of each image and wrapping.
    texture_of: HashMap<(usize, [Wrap; 2]), usize>,
    /// The image that was made of bytes at each place.
    image_at: HashMap<(usize, Range<usize>), usize>,
}

impl Looks {
    fn material(&mut self, out: &mut Built, mesh: &NewMesh<'_>, number: usize, material: &Material) -> usize {
        if let Some(&known) = self.material_of.get(&number) {
            return known;
        }
        let unit = |number: f32| {
            f64::from(if number.is_finite() {
                number.clamp(0.0, 1.0)
            } else {
                1.0
            })
        };
        let mut surface = json!({
            "baseColorFactor": material.base_colour.map(unit),
            "metallicFactor": unit(material.metallic),
            "roughnessFactor": unit(material.roughness),
        });
        // A texture without coordinates to look it up by is an error in glTF.
        let image = material.base_colour_image.filter(|_| mesh.appearance.uvs.is_some());
        if let Some(image) = image.and_then(|image| self.image(out, mesh, image)) {
            surface["baseColorTexture"] = json!({ "index": self.texture(image, material.wrap) });
        }
        let mut value = json!({ "pbrMetallicRoughness": surface });
        if !material.name.is_empty() {
            value["name"] = material.name.as_str().into();
        }
        if material.double_sided {
            value["doubleSided"] = true.into();
        }
        match material.alpha {
            AlphaMode::Opaque => {}
            AlphaMode::Blend => value["alphaMode"] = "BLEND".into(),
            AlphaMode::Mask(cutoff) => {
                value["alphaMode"] = "MASK".into();
                value["alphaCutoff"] = unit(cutoff).into();
            }
        }
        self.materials.push(value);
        self.material_of.insert(number, self.materials.len() - 1);
        self.materials.len() - 1
    }

    fn texture(&mut self, image: usize, wrap: [Wrap; 2]) -> usize {
        let mode = |wrap| match wrap {
            Wrap::ClampToEdge => 33071,
            Wrap::MirroredRepeat => 33648,
            Wrap::Repeat => 10497,
        };
        *self.texture_of.entry((image, wrap)).or_insert_with(|| {
            let sampler = json!({ "wrapS": mode(wrap[0]), "wrapT": mode(wrap[1]) });
            let sampler = index_of(&mut self.samplers, sampler);
            self.textures.push(json!({ "source": image, "sampler": sampler }));
            self.textures.len() - 1
        })
    }

    fn image(&mut self, out: &mut Built, mesh: &NewMesh<'_>, image: usize) -> Option<usize> {
        if let Some(&known) = self.image_of.get(&image) {
            return known;
        }
        let found = mesh.appearance.images.get(image)?;
        let name = quoted(&found.name);
        if let Some(&same) = self.image_at.get(&found.encoded.place()) {
            self.image_of.insert(image, Some(same));
            return Some(same);
        }
        if found.origin == Origin::Outside && !decodes(&found.encoded) {
            // A stranger's file may point at anything there, and would carry it away as an image.
            out.warnings.push(format!("{name} {NO_IMAGE}"));
            self.image_of.insert(image, None);
            return None;
        }
        let mime = mime_type(&found.encoded).filter(|mime| matches!(*mime, "image/png" | "image/jpeg"));
        let written = match mime {
            Some(mime) => {
                let view = out.bytes(found.encoded.iter().copied());
                let mut value = json!({ "bufferView": view, "mimeType": mime });
                if !found.name.is_empty() {
                    value["name"] = found.name.as_str().into();
                }
                self.images.push(value);
                self.image_at.insert(found.encoded.place(), self.images.len() - 1);
                if found.origin == Origin::Outside {
                    out.warnings.push(format!("{name} {FROM_OUTSIDE}"));
                }
                Some(self.images.len() - 1)
            }
            None if found.encoded.is_empty() => {
                out.warnings
                    .push(format!("The image {name} was missing and could not be embedded."));
                None
            }
            None => {
                out.warnings.push(format!(
                    "The image {name} is neither PNG nor JPEG, so glTF can't embed it."
                ));
                None
            }
        };
        self.image_of.insert(image, written);
        written
    }

    fn add_to(self, root: &mut Value) {
        let sections = [
            ("materials", self.materials),
            ("textures", self.textures),
            ("samplers", self.samplers),
            ("images", self.images),
        ];
        for (key, section) in sections {
            if !section.is_empty() {
                root[key] = section.into();
            }
        }
    }
}

/// Where a value stands in a section, which it joins if it is new.
fn index_of(section: &mut Vec<Value>, value: Value) -> usize {
    let known = section.iter().position(|other| *other == value);
    known.unwrap_or_else(|| {
        section.push(value);
        section.len() - 1
    })
}

fn stem(name: &str) -> &str {
    name.rsplit_once('.').map_or(name, |(stem, _)| stem)
}
