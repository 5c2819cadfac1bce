//! Changed attributes: written over an accessor's own bytes if these can hold them, otherwise into a new accessor.

use std::collections::{BTreeMap, BTreeSet, HashMap};

use ::gltf::json::accessor::ComponentType;

use crate::gltf::document::accessor::Layout;
use crate::gltf::document::json::At;
use crate::gltf::document::{Buffer, Document};
use crate::gltf::geometry::Pieces;
use crate::gltf::geometry::primitive::Primitive;
use crate::gltf::save::changes::{Change, InstanceChange, Semantic};
use crate::gltf::save::copy_on_write::{self, AccessorPlan, AccessorVersion};
use crate::gltf::save::overlap::Places;
use crate::gltf::save::patch::{Patch, Patched, cannot_hold};
use crate::gltf::save::turned_triangles::Turned;
use crate::quote::quoted;
use crate::save::course::Course;
use crate::source::notes::Notes;
use crate::{Format, SaveError};

/// The document with each instance's attributes changed and its triangles turned.
pub(crate) fn with_changes<'a>(
    document: &'a Document,
    meshes: &[Vec<Primitive>],
    pieces: &Pieces,
    (changes, turned): (&[InstanceChange], &Turned),
    format: Format,
    course: &Course<'_>,
) -> Result<Patched<'a>, SaveError> {
    let (of_plan, course) = course.split(0.5);
    let hashes = copy_on_write::hashes(changes);
    let copies = copy_on_write::plan_meshes(document, meshes, pieces, (changes, turned), &hashes, &of_plan)?;
    let plans = copy_on_write::plan_accessors(document, meshes, &copies, changes, &hashes, &of_plan)?;
    let mut patch = Patch::new(document);
    let places = Places::of(document);
    for (number, (&accessor, plan)) in plans.iter().enumerate() {
        course.reach(number, plans.len())?;
        if !plan.in_place.change.is_empty() {
            match patch.in_place(accessor, &plan.in_place, &plans, &places) {
                Some(()) => {}
                None => {
                    let text = patch.new_accessor(accessor, &plan.in_place, format)?;
                    patch
                        .edits
                        .replace(document.json.span(document.accessors_at[accessor]), text);
                }
            }
        }
        for version in &plan.copies {
            course.reach(number, plans.len())?;
            let text = patch.new_accessor(accessor, version, format)?;
            let number = patch.push_accessor(text);
            for attribute in &version.used_by {
                patch.rename(meshes, &copies, attribute, number);
            }
        }
    }
    patch.unpack(meshes, &copies, &plans, turned, format)?;
    patch.turn(meshes, &copies, turned, &places, format)?;
    patch.turn_targets(meshes, &copies, changes, format)?;
    patch.clone_meshes(&copies, format)?;
    let mut patched = patch.finished(format)?;
    patched
        .warnings
        .extend(morph_warnings(document, meshes, pieces, changes));
    Ok(patched)
}

impl Patch<'_> {
    /// Writes a change over the accessor's own bytes. `None`, with nothing written, if they can't hold it: they are not
    /// f32, missing (sparse zeros), or shared with another accessor.
    fn in_place(
        &mut self,
        accessor: usize,
        version: &AccessorVersion<'_>,
        plans: &BTreeMap<usize, AccessorPlan<'_>>,
        places: &Places,
    ) -> Option<()> {
        let document = self.document;
        let layout = document.layout(accessor).ok()?;
        if layout.component != ComponentType::F32 || layout.lanes != version.semantic.lanes() {
            return None;
        }
        let (group, twins) = places.twins(accessor);
        let wants_the_same = |other: &usize| {
            let plan = plans.get(other);
            plan.is_some_and(|plan| plan.in_place.change == version.change)
        };
        let are_alike = self.are_twins_alike.entry(group);
        let are_alike = *are_alike.or_insert_with(|| twins.len() == 1 || twins.iter().all(wants_the_same));
        let is_shared = !are_alike || places.is_overlapped(accessor);
        let places = places.of_accessor(accessor);
        let is_decoded = places
            .iter()
            .any(|place| matches!(document.buffers[place.buffer], Buffer::Decoded(_)));
        let laps_itself = places.iter().any(|place| place.count > 1 && place.stride < place.size);
        if is_shared || laps_itself || is_decoded {
            return None;
        }
        let entries = layout.sparse_elements(document);
        let entries: HashMap<u32, usize> = entries
            .into_iter()
            .enumerate()
            .map(|(k, element)| (element, k))
            .collect();
        let bytes_of = |element: u32| match (entries.get(&element), &layout.sparse, &layout.dense) {
            (Some(&entry), Some(sparse), _) => Some((sparse.values.buffer, sparse.values.element(entry))),
            (None, _, Some(dense)) => Some((dense.buffer, dense.element(element as usize))),
            _ => None,
        };
        if version.change.iter().any(|&(element, _)| bytes_of(element).is_none()) {
            return None;
        }
        for &(element, new) in version.change {
            let (buffer, range) = bytes_of(element)?;
            let bytes = &mut self.own(buffer)?[range];
            for (bytes, number) in bytes.chunks_exact_mut(4).zip(&new[..layout.lanes]) {
                bytes.copy_from_slice(&number.to_le_bytes());
            }
        }
        self.set_bounds(accessor, &whole(document, &layout, version.change), layout.lanes);
        Some(())
    }

    /// Sets the accessor's min and max, if it has them, to the bounds of its new elements. A number that is unchanged
    /// keeps its text.
    fn set_bounds(&mut self, accessor: usize, elements: &[[f32; 4]], lanes: usize) {
        let json = &self.document.json;
        let bounds = Bounds::of(elements);
        for (key, bound) in [("min", bounds.min), ("max", bounds.max)] {
            let Some(list) = json.member(self.document.accessors_at[accessor], key) else {
                continue;
            };
            let numbers: Vec<At> = json.elements(list).collect();
            if numbers.len() != lanes {
                continue;
            }
            for (at, new) in numbers.into_iter().zip(bound) {
                let is_said = json.number(at).is_some_and(|old| old as f32 == new);
                if new.is_finite() && !is_said {
                    self.edits.replace(json.span(at), number(new));
                }
            }
        }
    }

    /// The text of a copy of `accessor` with the change, its bytes appended to a buffer's others.
    fn new_accessor(
        &mut self,
        accessor: usize,
        version: &AccessorVersion<'_>,
        format: Format,
    ) -> Result<String, SaveError> {
        let document = self.document;
        let json = &document.json;
        let old = document.accessors_at[accessor];
        let cannot = |what: String| cannot_hold(what, format);
        let layout = document.layout(accessor).map_err(cannot)?;
        let lanes = version.semantic.lanes();
        let elements = whole(document, &layout, version.change);
        let home = layout.dense.as_ref().map(|dense| dense.buffer);
        let home = home.or_else(|| layout.sparse.as_ref().map(|sparse| sparse.values.buffer));
        let numbers = elements.iter().flat_map(|element| &element[..lanes]);
        let view = self.new_view(
            home,
            numbers.flat_map(|number| number.to_le_bytes()),
            ",\"target\":34962",
        );
        let view = view.ok_or_else(|| cannot(self.why_no_view(accessor)))?;
        let mut text = format!(
            "{{\"bufferView\":{view},\"componentType\":5126,\"count\":{},\"type\":\"VEC{lanes}\"",
            layout.count
        );
        let has_bounds = version.semantic == Semantic::Position || json.member(old, "min").is_some();
        let bounds = Bounds::of(&elements);
        if has_bounds && bounds.is_finite(lanes) {
            for (key, bound) in [("max", bounds.max), ("min", bounds.min)] {
                let numbers: Vec<String> = bound[..lanes].iter().map(|&bound| number(bound)).collect();
                text += &format!(",\"{key}\":[{}]", numbers.join(","));
            }
        }
        for key in ["name", "extras"] {
            if let Some(at) = json.member(old, key) {
                text += &format!(",\"{key}\":{}", String::from_utf8_lossy(json.raw(at)));
            }
        }
        text.push('}');
        Ok(text)
    }
}

/// Bounds of elements, number by number; not finite if no element's number is.
pub(crate) struct Bounds {
    pub min: [f32; 4],
    pub max: [f32; 4],
}

impl Bounds {
    pub fn of(elements: &[[f32; 4]]) -> Self {
        let mut bounds = Self {
            min: [f32::INFINITY; 4],
            max: [f32::NEG_INFINITY; 4],
        };
        for element in elements {
            for lane in 0..4 {
                // `min` and `max` ignore NaN.
                bounds.min[lane] = bounds.min[lane].min(element[lane]);
                bounds.max[lane] = bounds.max[lane].max(element[lane]);
            }
        }
        bounds
    }

    fn is_finite(&self, lanes: usize) -> bool {
        self.min[..lanes]
            .iter()
            .chain(&self.max[..lanes])
            .all(|bound| bound.is_finite())
    }
}

/// An f32 as text that reads back as the same number, both as f32 and as f64: validators do either.
pub(crate) fn number(value: f32) -> String {
    let value = f64::from(value);
    // Rust writes no exponent by default, and a bound may be 1e-38.
    if value == 0.0 || (1e-5..1e15).contains(&value.abs()) {
        format!("{value}")
    } else {
        format!("{value:e}")
    }
}

/// All elements of an accessor with a change applied.
fn whole(document: &Document, layout: &Layout, change: &Change) -> Vec<[f32; 4]> {
    let mut elements = layout.floats::<4>(document);
    change
        .iter()
        .for_each(|&(element, new)| elements[element as usize] = new);
    elements
}

/// A sentence for each edited mesh with morph targets.
fn morph_warnings(
    document: &Document,
    meshes: &[Vec<Primitive>],
    pieces: &Pieces,
    changes: &[InstanceChange],
) -> Vec<String> {
    let instances = pieces.instances.iter().zip(changes);
    let edited = instances.filter(|(_, change)| !change.is_empty());
    let edited: BTreeSet<usize> = edited.map(|(instance, _)| instance.mesh).collect();
    let has_targets = |mesh: &usize| meshes[*mesh].iter().any(|primitive| !primitive.targets.is_empty());
    let is_turned = |mesh: usize| {
        let mut instances = pieces.instances.iter().zip(changes);
        instances.any(|(instance, change)| instance.mesh == mesh && change.target_turns.is_some())
    };
    let mut notes = Notes::default();
    for mesh in edited.into_iter().filter(has_targets) {
        let name = document.name(document.meshes_at[mesh]);
        let called = if name.is_empty() {
            String::new()
        } else {
            format!(" ({})", quoted(&name))
        };
        let note = match is_turned(mesh) {
            true => format!("The morph targets of mesh {mesh}{called} turned with the edit."),
            false => {
                format!("The morph targets of mesh {mesh}{called} did not turn with the edit.")
            }
        };
        notes.add("meshes", Some(note));
    }
    notes.sentences()
}
