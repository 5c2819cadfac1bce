//! Writes Draco-compressed meshes that an edit changed or turned without compression.
//!
//! A mesh's compressed data holds all its attributes at once, so that one of them can't change alone: its accessors
//! get bytes of their own and its primitives lose the extension, in the mesh and in its clones alike.

use std::collections::{BTreeMap, BTreeSet};

use ::gltf::json::accessor::ComponentType;

use crate::gltf::document::Document;
use crate::gltf::document::json::{At, Edits};
use crate::gltf::document::layout::Layout;
use crate::gltf::geometry::draco::{self, Filled};
use crate::gltf::geometry::primitive::Primitive;
use crate::gltf::save::accessors::number;
use crate::gltf::save::copy_on_write::{AccessorPlan, MeshCopy};
use crate::gltf::save::patch::{Patch, cannot_hold};
use crate::gltf::save::turned_triangles::Turned;
use crate::{Format, SaveError};

/// The role of an accessor that compressed data fills.
#[derive(Clone, Copy, PartialEq)]
enum Filling {
    /// The numbers of a primitive's corners.
    Corners,
    /// An attribute of vertices.
    Attribute,
}

impl Patch<'_> {
    /// Unpacks every mesh of which a compressed accessor changed or triangles are turned.
    pub(crate) fn unpack(
        &mut self,
        meshes: &[Vec<Primitive>],
        copies: &[MeshCopy],
        plans: &BTreeMap<usize, AccessorPlan<'_>>,
        turned: &Turned,
        format: Format,
    ) -> Result<(), SaveError> {
        let document = self.document;
        let is_changed = |accessor: usize| document.is_filled(accessor) && plans.contains_key(&accessor);
        let mut copies_of_mesh: Vec<Vec<usize>> = vec![Vec::new(); meshes.len()];
        for (number, copy) in copies.iter().enumerate() {
            copies_of_mesh[copy.mesh].push(number);
        }
        let mut plain: BTreeSet<usize> = BTreeSet::new();
        let mut lists_of_corners: BTreeSet<usize> = BTreeSet::new();
        let (mut unpacked, mut packed) = (0, 0);
        for (mesh, primitives) in meshes.iter().enumerate() {
            let compressed: Vec<(&Primitive, Filled)> = primitives
                .iter()
                .filter_map(|primitive| {
                    let extension = draco::extension_of(document, primitive)?;
                    Some((primitive, Filled::of(document, primitive, extension)))
                })
                .collect();
            let is_turned = (0..primitives.len()).any(|primitive| turned.contains_key(&(mesh, primitive)));
            if !is_turned && !compressed.iter().any(|(_, filled)| filled.accessors().any(is_changed)) {
                packed += compressed.len();
                continue;
            }
            unpacked += compressed.len();
            for (primitive, filled) in &compressed {
                plain.extend(filled.accessors());
                lists_of_corners.extend(filled.indices);
                for &number in &copies_of_mesh[mesh] {
                    remove_extension(document, self.edits_of_copy(copies, number), primitive.at);
                }
            }
        }
        for accessor in plain {
            // An accessor whose own numbers changed is already written.
            let is_written = plans
                .get(&accessor)
                .is_some_and(|plan| !plan.in_place.change.is_empty());
            if document.is_filled(accessor) && !is_written {
                let role = match lists_of_corners.contains(&accessor) {
                    true => Filling::Corners,
                    false => Filling::Attribute,
                };
                self.write_out(accessor, role, format)?;
            }
        }
        if unpacked > 0 && packed == 0 {
            self.take_off_lists(draco::EXTENSION);
        }
        Ok(())
    }

    /// Gives an accessor its decoded bytes, and its min and max the bounds of these: the old ones may describe the data
    /// before compression.
    fn write_out(&mut self, accessor: usize, role: Filling, format: Format) -> Result<(), SaveError> {
        let document = self.document;
        let layout = document.layout(accessor).map_err(|what| cannot_hold(what, format))?;
        let Some(dense) = layout.dense else { return Ok(()) };
        // Vertex attributes begin at multiples of four.
        let padding = match role {
            Filling::Corners => 0,
            Filling::Attribute => dense.size.next_multiple_of(4) - dense.size,
        };
        let bytes = document.buffer(dense.buffer);
        let content = (0..dense.count).flat_map(|element| {
            let element = bytes[dense.element(element)].iter().copied();
            element.chain(std::iter::repeat_n(0, padding))
        });
        let members = match (role, padding) {
            (Filling::Corners, _) => ",\"target\":34963".to_owned(),
            (Filling::Attribute, 0) => ",\"target\":34962".to_owned(),
            (Filling::Attribute, _) => format!(",\"byteStride\":{},\"target\":34962", dense.size + padding),
        };
        let view = self.new_view(None, content, &members);
        let view = view.ok_or_else(|| cannot_hold(self.why_no_view(accessor), format))?;
        let at = document.accessors_at[accessor];
        self.edits
            .set_member(&document.json, at, "bufferView", &view.to_string());
        // Without a view the accessor's offset had no meaning; in the new view its elements begin at the start.
        if let Some(offset) = document.json.member(at, "byteOffset") {
            self.edits.replace(document.json.span(offset), "0");
        }
        self.renew_bounds(accessor, &layout);
        Ok(())
    }

    /// Gives an accessor's min and max, if it has them, the least and the largest of its stored numbers.
    fn renew_bounds(&mut self, accessor: usize, layout: &Layout) {
        let json = &self.document.json;
        let at = self.document.accessors_at[accessor];
        let bounds = ["min", "max"].map(|key| json.member(at, key));
        if bounds == [None, None] || layout.lanes > 4 {
            return;
        }
        let stored = Layout {
            normalized: false,
            ..layout.clone()
        };
        // f32 represents whole numbers of 16 bits, and corners that exceed it are read separately.
        let numbers: Vec<[f64; 4]> = match stored.component {
            ComponentType::U32 => {
                let corners = stored.indices(self.document).unwrap_or_default();
                corners
                    .into_iter()
                    .map(|corner| [f64::from(corner), 0.0, 0.0, 0.0])
                    .collect()
            }
            _ => stored
                .floats::<4>(self.document)
                .into_iter()
                .map(|element| element.map(f64::from))
                .collect(),
        };
        let least = |a: [f64; 4], b: &[f64; 4]| std::array::from_fn(|lane| a[lane].min(b[lane]));
        let most = |a: [f64; 4], b: &[f64; 4]| std::array::from_fn(|lane| a[lane].max(b[lane]));
        let new = [
            numbers.iter().fold([f64::INFINITY; 4], least),
            numbers.iter().fold([f64::NEG_INFINITY; 4], most),
        ];
        for (list, new) in bounds.into_iter().zip(new) {
            let told: Vec<At> = list.into_iter().flat_map(|list| json.elements(list)).collect();
            for (at, new) in told.into_iter().zip(new).take(layout.lanes) {
                let is_said = json.number(at).is_some_and(|old| old as f32 == new as f32);
                if new.is_finite() && !is_said {
                    self.edits.replace(json.span(at), number(new as f32));
                }
            }
        }
    }

    /// Removes an extension from the lists of those used and required.
    fn take_off_lists(&mut self, name: &str) {
        let json = &self.document.json;
        let mut emptied = Vec::new();
        for list in ["extensionsUsed", "extensionsRequired"] {
            let Some(at) = json.member(json.root(), list) else {
                continue;
            };
            let names: Vec<Option<String>> = json.elements(at).map(|at| json.string(at)).collect();
            match names.iter().position(|other| other.as_deref() == Some(name)) {
                None => {}
                // An empty list is not allowed.
                Some(_) if names.len() == 1 => emptied.push(list),
                Some(place) => self.edits.remove_element(json, at, place),
            }
        }
        self.edits.remove_members(json, json.root(), &emptied);
    }
}

fn remove_extension(document: &Document, edits: &mut Edits, primitive: At) {
    let json = &document.json;
    let Some(extensions) = json.member(primitive, "extensions") else {
        return;
    };
    if json.members(extensions).count() == 1 {
        edits.remove_members(json, primitive, &["extensions"]);
    } else {
        edits.remove_members(json, extensions, &[draco::EXTENSION]);
    }
}
