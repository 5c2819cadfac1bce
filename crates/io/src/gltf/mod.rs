//! glTF 2.0: the JSON and the buffers stay as read, and a save patches them.

mod accessor;
mod changes;
mod claims;
mod compare;
mod container;
mod deliver;
mod document;
mod draco;
mod fault;
mod geometry;
mod json;
mod layout;
mod look;
mod maps;
mod meshopt;
mod morph;
mod neighbours;
mod overlap;
mod pack;
mod patch;
mod primitive;
mod tree;
mod unpack;
mod uri;
mod uv_sets;

use std::ops::Range;

use glam::DVec3;
use pliant_mesh::{Drawn, Object};

pub use neighbours::{is_same_document, neighbours_named, with_neighbours_renamed};
pub use uri::{bytes_of_name, name_of_bytes};

use self::document::Document;
use self::fault::Fault;
use self::geometry::Pieces;
use self::patch::Patched;
use self::primitive::Primitive;
use crate::course::Course;
use crate::moved::Moved;
use crate::save::{MorphTarget, Save, Saved};
use crate::source::Source;
use crate::summary::Summary;
use crate::{Appearance, Difference, Format, ReadError, SaveError};

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
    document.material_maps = maps::of_materials(&document);
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

/// What is said of a neighbour outside the file's folder that a save takes into its result.
pub(crate) const FROM_OUTSIDE: &str =
    "lies outside the file's own folder and was put into the result: share that only if you mean to share it too.";

/// What is said of one that is named as an image and is none.
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

    /// Ranges of drawn vertices, ascending, and how far each of their world coordinates may be off after a save.
    ///
    /// Positions are rounded to f32 in the node's space, and nodes that share a mesh keep sharing it where they differ
    /// by four such roundings of its largest coordinate.
    pub fn roundings(&self, drawn: &Drawn) -> Vec<(Range<u32>, DVec3)> {
        let of_part = |part: &geometry::Part| {
            let vertices = part.vertices.start as usize..part.vertices.end as usize;
            let positions = || drawn.positions[vertices.clone()].iter().filter(|p| p.is_finite());
            let node_from_world = part.world_from_node.inverse();
            let largest = |most: DVec3, p: DVec3| most.max(p.abs());
            let in_node = positions().map(|p| node_from_world.transform_point3(*p));
            let in_node = in_node.filter(|p| p.is_finite()).fold(DVec3::ZERO, largest);
            let in_world = positions().copied().fold(DVec3::ZERO, largest);
            let matrix = part.world_from_node.matrix3;
            let by_axes = [matrix.x_axis, matrix.y_axis, matrix.z_axis].map(DVec3::abs);
            let of_node = in_node.max_element() * (by_axes[0] + by_axes[1] + by_axes[2]);
            let within = 16.0 * (f64::from(f32::EPSILON) * of_node + f64::EPSILON * in_world);
            // Below f32's normal numbers, roundings are no longer relative.
            let smallest = f64::from(f32::MIN_POSITIVE) * (by_axes[0] + by_axes[1] + by_axes[2]);
            (part.vertices.clone(), within + smallest)
        };
        self.pieces.parts.iter().map(of_part).collect()
    }

    /// What differs between this file and another, in the order of this one's text.
    pub fn differences(&self, other: &Self) -> Vec<Difference> {
        compare::differences(&self.document, &other.document)
    }

    pub fn objects(&self) -> Vec<Object> {
        look::objects(&self.document, &self.meshes, &self.pieces)
    }

    pub fn appearance(&self) -> Appearance {
        look::appearance(&self.document, &self.meshes, &self.pieces)
    }

    /// The file as GLB or `.gltf`, with the moved vertices' numbers in place of the stored ones.
    pub fn save(&self, save: &Save<'_>, moved: &Moved<'_>, course: &Course<'_>) -> Result<Saved, SaveError> {
        let Self {
            document,
            meshes,
            pieces,
            ..
        } = self;
        let patched = if moved.is_nothing() {
            Patched::unchanged(document)
        } else {
            let changes = changes::changes(document, meshes, pieces, moved, &course.part(0.0, 0.8))?;
            patch::patch(document, meshes, pieces, &changes, save.format, &course.part(0.8, 0.9))?
        };
        course.reach(9, 10)?;
        self.deliver(patched, save)
    }

    /// The file as GLB or `.gltf`, its shape as it was, with the moved vertices' way as one more morph target.
    pub fn save_as_morph(
        &self,
        save: &Save<'_>,
        moved: &Moved<'_>,
        target: &MorphTarget<'_>,
        course: &Course<'_>,
    ) -> Result<Saved, SaveError> {
        let Self {
            document,
            meshes,
            pieces,
            ..
        } = self;
        let mut patched = Patched::unchanged(document);
        if moved.is_nothing() {
            patched
                .warnings
                .push("Nothing moved, so no morph target was added.".to_owned());
        } else {
            let changes = changes::changes(document, meshes, pieces, moved, &course.part(0.0, 0.8))?;
            let course = course.part(0.8, 0.9);
            patched = morph::with_target(document, meshes, pieces, &changes, target, save.format, &course)?;
        }
        course.reach(9, 10)?;
        self.deliver(patched, save)
    }

    fn deliver(&self, patched: Patched<'_>, save: &Save<'_>) -> Result<Saved, SaveError> {
        let document = &self.document;
        match (self.format, save.format) {
            (Format::Glb, Format::Gltf) => deliver::unpacked(document, patched, save),
            // A GLB that is called .gltf goes through `in_its_kind`, which keeps its container.
            (Format::Gltf, Format::Glb) if document.container.is_none() => pack::packed(document, patched, save),
            _ => deliver::in_its_kind(document, patched, save),
        }
    }
}
