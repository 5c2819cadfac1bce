//! The appearance of a glTF: attributes of its drawn vertices, materials and images.

pub(crate) mod maps;
pub(crate) mod originals;

use std::collections::HashMap;
use std::ops::Range;

use ::gltf::json;
use ::gltf::json::validation::Checked;
use glam::{DVec3, Vec3};
use pliant_mesh::{Cancel, Object};
use rayon::prelude::*;

use crate::appearance::colour::short;
use crate::appearance::{AlphaMode, Appearance, Group, Image, Material, Origin, Wrap};
use crate::gltf::document::json::At;
use crate::gltf::document::{Document, ImageFile, uri};
use crate::gltf::geometry::primitive::{Mode, Primitive};
use crate::gltf::geometry::{self, Instance, Piece, Pieces};
use crate::objects;

/// The number of vertices for one task.
const CHUNK: usize = 1 << 14;

/// The appearance of the drawn set that `pieces` describe.
pub(crate) fn appearance(document: &Document, meshes: &[Vec<Primitive>], pieces: &Pieces) -> Appearance {
    let mut out = Appearance {
        obj: None,
        normals: gather(pieces, [0.0; 3], |instance| {
            let normals = normals(document, instance, primitive(meshes, instance))?;
            let in_world = in_world(instance, &normals);
            Some(in_world.map(|normal| normal.as_vec3().to_array()).collect())
        }),
        uvs: gather(pieces, [0.0; 2], |instance| {
            let primitive = primitive(meshes, instance);
            let mut uvs = attribute::<2>(document, instance, primitive.uv)?;
            uvs.iter_mut().for_each(|uv| *uv = primitive.uv_transform.apply(*uv));
            Some(uvs)
        }),
        second_uvs: gather(pieces, [0.0; 2], |instance| {
            attribute::<2>(document, instance, primitive(meshes, instance).second_uv)
        }),
        colours: gather(pieces, [u16::MAX; 4], |instance| {
            let accessor = primitive(meshes, instance).colour?;
            let has_alpha = document.layout(accessor).ok()?.lanes == 4;
            let colours = attribute::<4>(document, instance, Some(accessor))?;
            let whole = |[r, g, b, a]: [f32; 4]| [r, g, b, if has_alpha { a } else { 1.0 }].map(short);
            Some(colours.into_iter().map(whole).collect())
        }),
        flat: flat(document, meshes, pieces),
        groups: Vec::new(),
        materials: document
            .materials
            .iter()
            .enumerate()
            .map(|(number, material)| {
                let mut material = self::material(document, material);
                maps::dress(document, number, &mut material);
                material
            })
            .collect(),
        images: (0..document.images.len())
            .map(|image| self::image(document, image))
            .collect(),
    };
    // Primitives without a material share one that comes after the file's own.
    let default_material = out.materials.len();
    if of_triangles(meshes, pieces).any(|piece| {
        of_piece(meshes, pieces, piece.instance, piece.primitive)
            .material
            .is_none()
    }) {
        out.materials.push(material(document, &json::Material::default()));
    }
    let mut names = Names::of(document);
    out.groups = of_triangles(meshes, pieces)
        .map(|piece| Group {
            triangles: piece.triangles.clone(),
            material: of_piece(meshes, pieces, piece.instance, piece.primitive)
                .material
                .unwrap_or(default_material),
            node_name: names.get(document.nodes_at[pieces.instances[piece.instance].node]),
        })
        .collect();
    out
}

/// The vertices of triangles without normals, which glTF shows flat.
fn flat(document: &Document, meshes: &[Vec<Primitive>], pieces: &Pieces) -> Vec<Range<u32>> {
    let mut flat: Vec<Range<u32>> = (of_triangles(meshes, pieces).map(|piece| &pieces.instances[piece.instance]))
        .filter(|instance| normals(document, instance, primitive(meshes, instance)).is_none())
        .map(|instance| instance.vertices.clone())
        .collect();
    flat.sort_unstable_by_key(|range| range.start);
    flat.dedup();
    flat
}

/// The pieces that consist of triangles; lines and points have no groups and are not objects.
fn of_triangles<'a>(meshes: &'a [Vec<Primitive>], pieces: &'a Pieces) -> impl Iterator<Item = &'a Piece> {
    pieces.pieces.iter().filter(|piece| {
        let mode = of_piece(meshes, pieces, piece.instance, piece.primitive).mode;
        mode.is_some_and(Mode::makes_triangles)
    })
}

/// The objects of the drawn set by node and material; a node without a name gets its mesh's.
pub(crate) fn objects(document: &Document, meshes: &[Vec<Primitive>], pieces: &Pieces) -> Vec<Object> {
    let mut names = Names::of(document);
    objects::gathered(of_triangles(meshes, pieces).map(|piece| {
        let instance = &pieces.instances[piece.instance];
        let material = of_piece(meshes, pieces, piece.instance, piece.primitive).material;
        let name = names.get(document.nodes_at[instance.node]);
        objects::TriangleRun {
            key: (instance.node, material),
            name: if name.is_empty() {
                names.get(document.meshes_at[instance.mesh])
            } else {
                name
            },
            material: material.map_or_else(String::new, |material| names.get(document.materials_at[material])),
            triangles: piece.triangles.clone(),
        }
    }))
}

/// Names as they are shown, each read once.
struct Names<'a> {
    document: &'a Document,
    known: HashMap<At, String>,
}

impl<'a> Names<'a> {
    fn of(document: &'a Document) -> Self {
        Self {
            document,
            known: HashMap::new(),
        }
    }

    /// The name of a node, mesh or material.
    fn get(&mut self, object: At) -> String {
        let name = || objects::short_name(&self.document.name(object));
        self.known.entry(object).or_insert_with(name).clone()
    }
}

/// The rest normals of all drawn vertices in world space, unit vectors, zero where there are none.
pub(crate) fn world_normals(document: &Document, meshes: &[Vec<Primitive>], pieces: &Pieces) -> Vec<DVec3> {
    let mut out = Vec::new();
    for instance in &pieces.instances {
        let normals = normals(document, instance, primitive(meshes, instance));
        let normals = normals.unwrap_or_else(|| vec![[0.0; 3]; instance.vertices.len()]);
        out.par_extend(in_world(instance, &normals));
    }
    out
}

/// An instance's normals in world space, unit vectors; zero for those that its skin flattens.
fn in_world<'a>(instance: &'a Instance, normals: &'a [[f32; 3]]) -> impl IndexedParallelIterator<Item = DVec3> + 'a {
    let linear = instance.pose.linear();
    normals
        .par_iter()
        .enumerate()
        .with_min_len(CHUNK)
        .map(move |(element, normal)| {
            let normal = Vec3::from_array(*normal).as_dvec3();
            let world = linear
                .at(element)
                .map(|linear| linear.mesh_from_world.transpose() * normal);
            world.unwrap_or_default().normalize_or_zero()
        })
}

/// An instance's rest normals in its node's space, default morph targets applied; `None` if it has none.
fn normals(document: &Document, instance: &Instance, primitive: &Primitive) -> Option<Vec<[f32; 3]>> {
    let mut normals = attribute::<3>(document, instance, primitive.normal)?;
    let targets = instance
        .weights
        .iter()
        .map(|&(target, weight)| (primitive.targets[target].normal, weight));
    // A target whose normals can't be read is left out.
    let _ = geometry::apply_targets(document, &mut normals, targets, &Cancel::new());
    Some(normals)
}

/// An attribute of an instance's vertices; `None` if it has none with the right count.
pub(crate) fn attribute<const N: usize>(
    document: &Document,
    instance: &Instance,
    accessor: Option<usize>,
) -> Option<Vec<[f32; N]>> {
    let layout = document.layout(accessor?).ok()?;
    (layout.count == instance.vertices.len()).then(|| layout.floats(document))
}

fn primitive<'a>(meshes: &'a [Vec<Primitive>], instance: &Instance) -> &'a Primitive {
    &meshes[instance.mesh][instance.primitive]
}

fn of_piece<'a>(meshes: &'a [Vec<Primitive>], pieces: &Pieces, instance: usize, primitive: usize) -> &'a Primitive {
    &meshes[pieces.instances[instance].mesh][primitive]
}

/// One attribute of all drawn vertices; `None` if no instance has it.
fn gather<T: Copy + Send>(
    pieces: &Pieces,
    missing: T,
    of_instance: impl Fn(&Instance) -> Option<Vec<T>>,
) -> Option<Vec<T>> {
    let mut out: Option<Vec<T>> = None;
    for instance in &pieces.instances {
        let (start, end) = (instance.vertices.start as usize, instance.vertices.end as usize);
        match (of_instance(instance), out.as_mut()) {
            (Some(values), Some(out)) => out.extend(values),
            (Some(values), None) => {
                let mut all = vec![missing; start];
                all.extend(values);
                out = Some(all);
            }
            (None, Some(out)) => out.resize(end, missing),
            (None, None) => {}
        }
    }
    out
}

fn material(document: &Document, material: &json::Material) -> Material {
    let surface = &material.pbr_metallic_roughness;
    let base = surface
        .base_color_texture
        .as_ref()
        .and_then(|info| maps::image_of(document, info.index.value()));
    let alpha = match material.alpha_mode {
        Checked::Valid(json::material::AlphaMode::Mask) => {
            AlphaMode::Mask(material.alpha_cutoff.as_ref().map_or(0.5, |cutoff| cutoff.0))
        }
        Checked::Valid(json::material::AlphaMode::Blend) => AlphaMode::Blend,
        _ => AlphaMode::Opaque,
    };
    Material {
        name: material.name.clone().unwrap_or_default(),
        base_colour: surface.base_color_factor.0,
        base_colour_image: base.map(|(image, _)| image),
        metallic: surface.metallic_factor.0,
        roughness: surface.roughness_factor.0,
        double_sided: material.double_sided,
        alpha,
        wrap: base.map_or([Wrap::Repeat; 2], |(_, wrap)| wrap),
        ..Material::default()
    }
}

fn image(document: &Document, image: usize) -> Image {
    let (name, origin) = match &document.images[image] {
        ImageFile::Neighbour { path, .. } if uri::inside(path).is_none() => (path.clone(), Origin::Outside),
        ImageFile::Neighbour { path, .. } => (path.clone(), Origin::Inside),
        _ => (document.name(document.images_at[image]), Origin::Inside),
    };
    Image {
        name,
        encoded: document.image(image).unwrap_or_default(),
        origin,
    }
}
