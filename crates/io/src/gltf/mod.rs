//! glTF 2.0: the JSON and the buffers stay as read, and a save patches them.

mod appearance;
mod compare;
mod document;
mod geometry;
mod neighbours;
mod remarks;
mod save;
pub(crate) mod unread;
mod uv_sets;
pub(crate) mod write;

use std::borrow::Cow;
use std::ops::Range;

use glam::DVec3;
use pliant_mesh::{Cancel, Drawn, Object};

pub use document::uri::{bytes_of_name, name_of_bytes};
pub use neighbours::{is_same_document, neighbours_named, with_neighbours_renamed};

use document::fault::Fault;
use document::{Document, container, uri};
pub use geometry::playback::MorphPlayback;
use geometry::playback::playback;
use geometry::primitive::{self, Primitive};
use geometry::{Linear, Pieces, Pose, draco, meshopt, targets, tree};

use crate::source::Source;
use crate::summary::Summary;
use crate::{Appearance, Difference, Format, ReadError};

/// A glTF as read, and the description of its drawn set.
#[derive(Debug)]
pub(crate) struct Stored {
    format: Format,
    document: Document,
    /// Primitives by mesh.
    meshes: Vec<Vec<Primitive>>,
    pieces: Pieces,
    notes: Vec<String>,
}

/// Reads a GLB or a `.gltf` with its neighbours.
pub(crate) fn read(source: &Source<'_>, format: Format) -> Result<(Stored, Drawn), ReadError> {
    open(source, format).map_err(|fault| fault.of_file(source.name, format))
}

fn open(source: &Source<'_>, format: Format) -> Result<(Stored, Drawn), Fault> {
    let mut document = Document::read(source, format)?;
    document.material_maps = appearance::maps::of_materials(&document);
    let mut notes = std::mem::take(&mut document.notes);
    meshopt::decode(&mut document, source.cancel)?;
    let meshes = primitive::primitives(&document, source.cancel)?;
    draco::decode(&mut document, &meshes, source.cancel)?;
    remarks::add(&document, &meshes, &mut notes);
    let placed = tree::placed_meshes(&document, &mut notes, source.cancel)?;
    let (drawn, pieces) = geometry::drawn(&document, &meshes, &placed, &mut notes, source.progress, source.cancel)?;
    Ok((
        Stored {
            format,
            document,
            meshes,
            pieces,
            notes: notes.sentences(),
        },
        drawn,
    ))
}

/// A GLB of a JSON text and a buffer; `None` beyond 4 GiB.
pub(crate) fn join_glb(json: &[u8], bin: &[u8]) -> Option<Vec<u8>> {
    container::join(json, Some(bin), &[], &[])
}

/// The warning about a neighbour outside the file's folder that a save includes in its result.
pub(crate) const FROM_OUTSIDE: &str = "is outside the file's own folder and was put into the result: share the result \
                                       only if you mean to share it, too.";

/// The warning about a neighbour that is named as an image and isn't one.
pub(crate) const NO_IMAGE: &str = "is outside the file's own folder and is not an image, so it was left out.";

/// Returns true if a neighbour's path stays in the file's own folder.
pub(crate) fn stays_inside(path: &str) -> bool {
    uri::inside(path).is_some()
}

/// A neighbour's path as a URI.
pub(crate) fn encoded_uri(path: &str) -> String {
    uri::encoded(path)
}

impl Stored {
    pub fn notes(&self) -> &[String] {
        &self.notes
    }

    pub fn summary(&self) -> Summary {
        let json = &self.document.json;
        let count = |key: &str| json.member(json.root(), key).map_or(0, |at| json.elements(at).count());
        Summary {
            meshes: self.meshes.len(),
            primitives: self.meshes.iter().map(Vec::len).sum(),
            nodes: self.document.nodes_at.len(),
            materials: self.document.materials.len(),
            images: self.document.images.len(),
            skins: count("skins"),
            animations: count("animations"),
            morph_targets: self
                .meshes
                .iter()
                .flatten()
                .map(|primitive| primitive.targets.len())
                .sum(),
        }
    }

    /// The names of its morph targets.
    pub fn morph_targets(&self) -> Vec<String> {
        targets::names(&self.document, &self.meshes)
    }

    /// The shapes during its last animation of morph targets; `None` if it has none.
    pub fn morph_playback(&self, file: &str, cancel: &Cancel) -> Result<Option<MorphPlayback>, ReadError> {
        let found = playback(&self.document, &self.meshes, &self.pieces, cancel);
        found.map_err(|fault| fault.of_file(file, self.format))
    }

    /// The displacement of each drawn vertex by the morph targets of this name; `None` if there is none.
    pub fn morph_target(
        &self,
        file: &str,
        target: &str,
        vertex_count: usize,
        cancel: &Cancel,
    ) -> Result<Option<Vec<DVec3>>, ReadError> {
        let Self {
            document,
            meshes,
            pieces,
            ..
        } = self;
        let found = targets::displacements(document, meshes, pieces, vertex_count, target, cancel);
        found.map_err(|fault| fault.of_file(file, self.format))
    }

    /// Ranges of drawn vertices, ascending, and the largest error of each of their world coordinates after a save.
    ///
    /// Positions are rounded to f32 in the node's space, and nodes that share a mesh keep sharing it if they differ by
    /// at most four such roundings of its largest coordinate.
    pub fn roundings(&self, drawn: &Drawn) -> Vec<(Range<u32>, DVec3)> {
        let mut roundings = Vec::new();
        for instance in &self.pieces.instances {
            let vertices = instance.vertices.start as usize..instance.vertices.end as usize;
            let positions = &drawn.positions[vertices];
            let largest = |most: DVec3, p: DVec3| most.max(p.abs());
            let finite = positions.iter().copied().filter(|p| p.is_finite());
            let in_world = finite.fold(DVec3::ZERO, largest);
            let mesh_from_world = instance.pose.inverse();
            let in_mesh = positions.iter().enumerate();
            let in_mesh = in_mesh.map(|(element, p)| mesh_from_world(element).transform_point3(*p));
            let in_mesh = in_mesh.filter(|p| p.is_finite()).fold(DVec3::ZERO, largest);
            let within = |element: usize, linear: Option<Cow<'_, Linear>>| {
                // Vertices that a skin flattens stay the same, wherever they were moved.
                let Some(world_from_mesh) = linear.map(|linear| linear.world_from_mesh) else {
                    return DVec3::INFINITY;
                };
                let by_axes = [world_from_mesh.x_axis, world_from_mesh.y_axis, world_from_mesh.z_axis];
                let by_axes: DVec3 = by_axes.into_iter().map(DVec3::abs).sum();
                let of_mesh = f64::from(f32::EPSILON) * in_mesh.max_element() * by_axes;
                let of_place = instance.pose.at(element).translation.abs();
                let of_world = f64::EPSILON * in_world.max(of_place);
                // Below f32's normal numbers, roundings are no longer relative.
                16.0 * (of_mesh + of_world) + f64::from(f32::MIN_POSITIVE) * by_axes
            };
            let linear = instance.pose.linear();
            match instance.pose {
                Pose::Node(_) => roundings.push((instance.vertices.clone(), within(0, linear.at(0)))),
                Pose::Skin(_) => roundings.extend(instance.vertices.clone().enumerate().map(|(element, vertex)| {
                    let range = vertex..vertex + 1;
                    (range, within(element, linear.at(element)))
                })),
            }
        }
        roundings
    }

    /// The differences between this file and another, in the order of this one's text.
    pub fn differences(&self, other: &Self) -> Vec<Difference> {
        compare::differences(&self.document, &other.document)
    }

    pub fn objects(&self) -> Vec<Object> {
        appearance::objects(&self.document, &self.meshes, &self.pieces)
    }

    pub fn appearance(&self) -> Appearance {
        appearance::appearance(&self.document, &self.meshes, &self.pieces)
    }

    /// The same with the materials as the file has them.
    pub fn appearance_with_originals(&self) -> Appearance {
        let mut appearance = self.appearance();
        for (number, material) in appearance.materials.iter_mut().enumerate() {
            let original = appearance::originals::original(&self.document, number);
            material.original = original.map(|(original, _)| original);
        }
        appearance
    }
}
