//! glTF 2.0: the JSON and the buffers stay as read, and a save patches them.

mod appearance;
mod compare;
mod document;
mod geometry;
mod neighbours;
mod save;
pub(crate) mod write;

use std::ops::Range;

use glam::DVec3;
use pliant_mesh::{Cancel, Drawn, Object};

pub use document::uri::{bytes_of_name, name_of_bytes};
pub use neighbours::{is_same_document, neighbours_named, with_neighbours_renamed};

use document::fault::Fault;
use document::{Document, container, uri};
use geometry::primitive::{self, Primitive};
use geometry::{Pieces, draco, meshopt, targets, tree};

use crate::scene::summary::Summary;
use crate::source::Source;
use crate::{Appearance, Difference, Format, ReadError};

/// A glTF as read, and how its drawn set is made up.
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
    let placed = tree::placed_meshes(&document, &mut notes, source.cancel)?;
    let (drawn, pieces) = geometry::drawn(&document, &meshes, &placed, source.progress, source.cancel)?;
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
pub(crate) const FROM_OUTSIDE: &str =
    "lies outside the file's own folder and was put into the result: share that only if you mean to share it too.";

/// The warning about one that is named as an image and isn't one.
pub(crate) const NO_IMAGE: &str = "lies outside the file's own folder and is no image, so it was left out.";

/// Whether a neighbour's path stays in the file's own folder.
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

    /// How far each drawn vertex is moved by the morph targets of this name; `None` if there is none.
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

    /// Ranges of drawn vertices, ascending, and how far each of their world coordinates may be off after a save.
    ///
    /// Positions are rounded to f32 in the node's space, and nodes that share a mesh keep sharing it where they differ
    /// by four such roundings of its largest coordinate.
    pub fn roundings(&self, drawn: &Drawn) -> Vec<(Range<u32>, DVec3)> {
        let of_instance = |instance: &geometry::Instance| {
            let vertices = instance.vertices.start as usize..instance.vertices.end as usize;
            let positions = || drawn.positions[vertices.clone()].iter().filter(|p| p.is_finite());
            let node_from_world = instance.world_from_node.inverse();
            let largest = |most: DVec3, p: DVec3| most.max(p.abs());
            let in_node = positions().map(|p| node_from_world.transform_point3(*p));
            let in_node = in_node.filter(|p| p.is_finite()).fold(DVec3::ZERO, largest);
            let in_world = positions().copied().fold(DVec3::ZERO, largest);
            let matrix = instance.world_from_node.matrix3;
            let by_axes = [matrix.x_axis, matrix.y_axis, matrix.z_axis].map(DVec3::abs);
            let of_node = in_node.max_element() * (by_axes[0] + by_axes[1] + by_axes[2]);
            let within = 16.0 * (f64::from(f32::EPSILON) * of_node + f64::EPSILON * in_world);
            // Below f32's normal numbers, roundings are no longer relative.
            let smallest = f64::from(f32::MIN_POSITIVE) * (by_axes[0] + by_axes[1] + by_axes[2]);
            (instance.vertices.clone(), within + smallest)
        };
        self.pieces.instances.iter().map(of_instance).collect()
    }

    /// What differs between this file and another, in the order of this one's text.
    pub fn differences(&self, other: &Self) -> Vec<Difference> {
        compare::differences(&self.document, &other.document)
    }

    pub fn objects(&self) -> Vec<Object> {
        appearance::objects(&self.document, &self.meshes, &self.pieces)
    }

    pub fn appearance(&self) -> Appearance {
        appearance::appearance(&self.document, &self.meshes, &self.pieces)
    }
}
