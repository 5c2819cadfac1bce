//! Other vertex colours: each primitive that shows them gets an accessor of 16-bit numbers as `COLOR_0`, and everything
//! else keeps its bytes.

use std::collections::BTreeMap;

use crate::gltf::document::Document;
use crate::gltf::geometry::Pieces;
use crate::gltf::geometry::draco;
use crate::gltf::geometry::primitive::Primitive;
use crate::gltf::save::changes::InstanceChange;
use crate::gltf::save::copy_on_write;
use crate::gltf::save::patch::{Patch, Patched, cannot_hold};
use crate::gltf::save::turned_triangles::Turned;
use crate::save::course::Course;
use crate::{Format, SaveError};

const NAME: &str = "COLOR_0";

/// The document with these colours of the drawn vertices. Those that are as in `old`, the file's own or white, are not
/// written.
pub(crate) fn with_colours<'a>(
    document: &'a Document,
    meshes: &[Vec<Primitive>],
    pieces: &Pieces,
    (old, new): (&[[u16; 4]], &[[u16; 4]]),
    format: Format,
    course: &Course<'_>,
) -> Result<Patched<'a>, SaveError> {
    let (of_plan, course) = course.split(0.5);
    // As the positions of an edit, colours decide which nodes can go on sharing a mesh.
    let changes: Vec<InstanceChange> = pieces
        .instances
        .iter()
        .map(|instance| {
            let own = instance.vertices.start as usize..instance.vertices.end as usize;
            let is_changed = old[own.clone()] != new[own.clone()];
            let elements = (0..).zip(new[own].iter().filter(|_| is_changed));
            InstanceChange {
                position: elements
                    .map(|(element, colour)| (element, colour.map(f32::from)))
                    .collect(),
                ..InstanceChange::default()
            }
        })
        .collect();
    let hashes = copy_on_write::hashes(&changes);
    let copies = copy_on_write::plan_meshes(document, meshes, pieces, (&changes, &Turned::new()), &hashes, &of_plan)?;
    let mut patch = Patch::new(document);
    let mut accessors: BTreeMap<usize, usize> = BTreeMap::new();
    for (number, copy) in copies.iter().enumerate() {
        course.reach(number, copies.len())?;
        let primitives = &meshes[copy.mesh];
        for (primitive, instance) in primitives.iter().zip(copy.followed_instances(primitives)) {
            let Some(instance) = instance.filter(|&instance| !changes[instance].is_empty()) else {
                continue;
            };
            let json = &document.json;
            let Some(attributes) = json.member(primitive.at, "attributes") else {
                continue;
            };
            let accessor = match accessors.get(&instance) {
                Some(&accessor) => accessor,
                None => {
                    let own = &pieces.instances[instance].vertices;
                    let accessor = patch.push_colours(&new[own.start as usize..own.end as usize], format)?;
                    accessors.insert(instance, accessor);
                    accessor
                }
            };
            let edits = patch.edits_of_copy(&copies, number);
            edits.set_member(json, attributes, NAME, &accessor.to_string());
            // Compressed data would fill the old colours in.
            let compressed = draco::extension_of(document, primitive).and_then(|at| json.member(at, "attributes"));
            if let Some(compressed) = compressed.filter(|&at| json.member(at, NAME).is_some()) {
                edits.remove_members(json, compressed, &[NAME]);
            }
        }
    }
    patch.clone_meshes(&copies, format)?;
    patch.finished(format)
}

impl Patch<'_> {
    /// Adds an accessor of colours, and gives its number.
    fn push_colours(&mut self, colours: &[[u16; 4]], format: Format) -> Result<usize, SaveError> {
        let bytes = colours.iter().flatten().flat_map(|channel| channel.to_le_bytes());
        let view = self.new_view(None, bytes, ",\"target\":34962");
        let view = view.ok_or_else(|| cannot_hold("colours in a file without a buffer".to_owned(), format))?;
        Ok(self.push_accessor(format!(
            "{{\"bufferView\":{view},\"componentType\":5123,\"count\":{},\"normalized\":true,\"type\":\"VEC4\"}}",
            colours.len()
        )))
    }
}
