//! A save's changes to the JSON text and the buffers' bytes, and to nothing else.

use std::borrow::Cow;
use std::collections::{BTreeMap, BTreeSet, HashMap};

use ::gltf::json::accessor::ComponentType;

use crate::gltf::document::accessor::Layout;
use crate::gltf::document::json::{At, Edits};
use crate::gltf::document::{Buffer, Document};
use crate::gltf::geometry::Pieces;
use crate::gltf::geometry::primitive::Primitive;
use crate::gltf::save::changes::{Change, PartChange, Semantic};
use crate::gltf::save::claims::{self, Claim, MeshCopy, Naming, Outcome};
use crate::gltf::save::overlap::Places;
use crate::quote::quoted;
use crate::save::course::Course;
use crate::source::notes::Notes;
use crate::{Format, SaveError};

/// The JSON text and the buffers after an edit.
#[derive(Debug)]
pub(crate) struct Patched<'a> {
    /// Without a byte-order mark.
    pub text: Cow<'a, [u8]>,
    /// By buffer; borrowed where nothing changed.
    pub buffers: Vec<Cow<'a, [u8]>>,
    pub warnings: Vec<String>,
}

impl<'a> Patched<'a> {
    /// The document as it was read.
    pub fn unchanged(document: &'a Document) -> Self {
        let buffers = (0..document.buffers.len())
            .map(|buffer| Cow::Borrowed(document.buffer(buffer)))
            .collect();
        Self {
            text: Cow::Borrowed(document.json.text()),
            buffers,
            warnings: Vec::new(),
        }
    }

    /// Whether this is the document as it was read.
    pub fn is_unchanged(&self) -> bool {
        let is_borrowed = |cow: &Cow<'_, [u8]>| matches!(cow, Cow::Borrowed(_));
        is_borrowed(&self.text) && self.buffers.iter().all(is_borrowed)
    }
}

/// Everything that is being put together.
pub(crate) struct Patch<'a> {
    pub document: &'a Document,
    pub out: Patched<'a>,
    pub edits: Edits,
    /// Edits of each mesh copy's primitives: of clones only, as they apply to a copy of the text.
    clone_edits: BTreeMap<usize, Edits>,
    new_accessors: Vec<String>,
    new_views: Vec<String>,
    /// How many bytes buffers may yet take for themselves.
    room: Option<usize>,
    /// For each group of accessors at one place whether all of them become the same.
    are_twins_alike: HashMap<usize, bool>,
}

/// The document with each part's attributes changed.
pub(crate) fn patch<'a>(
    document: &'a Document,
    meshes: &[Vec<Primitive>],
    pieces: &Pieces,
    changes: &[PartChange],
    format: Format,
    course: &Course<'_>,
) -> Result<Patched<'a>, SaveError> {
    let (of_claims, course) = course.split(0.5);
    let copies = claims::copies(document, meshes, pieces, changes, &of_claims)?;
    let outcomes = claims::outcomes(document, meshes, &copies, changes, &of_claims)?;
    let mut patch = Patch::new(document);
    let places = Places::of(document);
    for (number, (&accessor, outcome)) in outcomes.iter().enumerate() {
        course.reach(number, outcomes.len())?;
        if !outcome.kept.change.is_empty() {
            match patch.in_place(accessor, &outcome.kept, &outcomes, &places) {
                Some(()) => {}
                None => {
                    let text = patch.new_accessor(accessor, &outcome.kept, format)?;
                    patch
                        .edits
                        .replace(document.json.span(document.accessors_at[accessor]), text);
                }
            }
        }
        for claim in &outcome.moved_out {
            course.reach(number, outcomes.len())?;
            let text = patch.new_accessor(accessor, claim, format)?;
            let number = patch.push_accessor(text);
            for naming in &claim.namings {
                patch.rename(meshes, &copies, naming, number);
            }
        }
    }
    patch.unpack(meshes, &copies, &outcomes, format)?;
    patch.clone_meshes(&copies);
    let mut patched = patch.finished(format)?;
    patched
        .warnings
        .extend(morph_warnings(document, meshes, pieces, changes));
    Ok(patched)
}

impl<'a> Patch<'a> {
    /// Nothing changed yet.
    pub fn new(document: &'a Document) -> Self {
        Self {
            document,
            out: Patched::unchanged(document),
            edits: Edits::default(),
            clone_edits: BTreeMap::new(),
            new_accessors: Vec::new(),
            new_views: Vec::new(),
            room: Some(document.drawing_budget().saturating_mul(MOST_SAVED)),
            are_twins_alike: HashMap::new(),
        }
    }

    /// Adds an accessor, written out, and gives its number.
    pub fn push_accessor(&mut self, text: String) -> usize {
        self.new_accessors.push(text);
        self.document.accessors_at.len() + self.new_accessors.len() - 1
    }
}

impl<'a> Patch<'a> {
    /// Writes a change over the accessor's own bytes; `None`, and nothing written, where they can't hold it: they are
    /// not f32, not there (sparse zeros), or another accessor's too.
    fn in_place(
        &mut self,
        accessor: usize,
        claim: &Claim<'_>,
        outcomes: &BTreeMap<usize, Outcome<'_>>,
        places: &Places,
    ) -> Option<()> {
        let document = self.document;
        let layout = document.layout(accessor).ok()?;
        if layout.component != ComponentType::F32 || layout.lanes != claim.semantic.lanes() {
            return None;
        }
        let (group, twins) = places.twins(accessor);
        let wants_the_same = |other: &usize| {
            let outcome = outcomes.get(other);
            outcome.is_some_and(|outcome| outcome.kept.change == claim.change)
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
        let places: Vec<_> = claim
            .change
            .iter()
            .map(|&(element, _)| bytes_of(element))
            .collect::<Option<_>>()?;
        for ((buffer, range), (_, new)) in places.into_iter().zip(claim.change) {
            let bytes = &mut self.own(buffer)?[range];
            for (bytes, number) in bytes.chunks_exact_mut(4).zip(&new[..layout.lanes]) {
                bytes.copy_from_slice(&number.to_le_bytes());
            }
        }
        self.set_bounds(accessor, &whole(document, &layout, claim.change), layout.lanes);
        Some(())
    }

    /// Brings the accessor's min and max, where it has them, to the bounds of its new elements. A number that still
    /// says the same keeps its text.
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

    /// The text of an accessor of its own bytes, put behind a buffer's others, that is `accessor` with the change.
    fn new_accessor(&mut self, accessor: usize, claim: &Claim<'_>, format: Format) -> Result<String, SaveError> {
        let document = self.document;
        let json = &document.json;
        let old = document.accessors_at[accessor];
        let cannot = |what: String| cannot_hold(what, format);
        let layout = document.layout(accessor).map_err(cannot)?;
        let lanes = claim.semantic.lanes();
        let elements = whole(document, &layout, claim.change);
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
        let has_bounds = claim.semantic == Semantic::Position || json.member(old, "min").is_some();
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

    /// Why an accessor gets no view of its own.
    pub(crate) fn why_no_view(&self, accessor: usize) -> String {
        match self.room {
            None => TOO_MANY_COPIES.to_owned(),
            Some(_) => format!("accessor {accessor}, which is in no buffer,"),
        }
    }

    /// Puts bytes behind a buffer's others (those of `home` where it can take them) and gives the number of a view of
    /// them, which has `members` beside its place; `None` where the file has no buffer with bytes.
    pub(crate) fn new_view(
        &mut self,
        home: Option<usize>,
        content: impl Iterator<Item = u8>,
        members: &str,
    ) -> Option<usize> {
        let buffers = &self.document.buffers;
        let can_take = |buffer: &usize| !matches!(buffers[*buffer], Buffer::Absent | Buffer::Decoded(_));
        let buffer = home.filter(can_take).or_else(|| (0..buffers.len()).find(can_take))?;
        let bytes = self.own(buffer)?;
        let offset = bytes.len().next_multiple_of(4);
        bytes.resize(offset, 0);
        bytes.extend(content);
        let length = bytes.len() - offset;
        self.room = self.room.and_then(|room| room.checked_sub(length));
        let view = self.document.views_at.len() + self.new_views.len();
        self.new_views.push(format!(
            "{{\"buffer\":{buffer},\"byteOffset\":{offset},\"byteLength\":{length}{members}}}"
        ));
        Some(view)
    }

    /// A buffer's bytes, to be changed; `None` where the save already takes more than the file justifies.
    fn own(&mut self, buffer: usize) -> Option<&mut Vec<u8>> {
        let bytes = &mut self.out.buffers[buffer];
        if matches!(bytes, Cow::Borrowed(_)) {
            self.room = self.room.and_then(|room| room.checked_sub(bytes.len()));
        }
        self.room?;
        Some(bytes.to_mut())
    }

    /// Lets a primitive's attribute name another accessor.
    fn rename(&mut self, meshes: &[Vec<Primitive>], copies: &[MeshCopy], naming: &Naming, accessor: usize) {
        let json = &self.document.json;
        let copy = &copies[naming.copy];
        let primitive = meshes[copy.mesh][naming.primitive].at;
        let Some(at) = json.path(primitive, &["attributes", naming.semantic.key()]) else {
            return;
        };
        self.edits_of_copy(copies, naming.copy)
            .replace(json.span(at), accessor.to_string());
    }

    /// The edits of a mesh's own text, or of the text that its clone gets.
    pub(crate) fn edits_of_copy(&mut self, copies: &[MeshCopy], number: usize) -> &mut Edits {
        match copies[number].clone_for {
            None => &mut self.edits,
            Some(_) => self.clone_edits.entry(number).or_default(),
        }
    }

    /// Adds the clones behind the meshes and lets their nodes show them.
    pub(crate) fn clone_meshes(&mut self, copies: &[MeshCopy]) {
        let json = &self.document.json;
        let mut clones = Vec::new();
        for (number, copy) in copies.iter().enumerate() {
            let Some(nodes) = &copy.clone_for else { continue };
            let span = json.span(self.document.meshes_at[copy.mesh]);
            let edits = self.clone_edits.remove(&number).unwrap_or_default();
            clones.push(String::from_utf8_lossy(&edits.apply(json.text(), span)).into_owned());
            for &node in nodes {
                if let Some(at) = json.member(self.document.nodes_at[node], "mesh") {
                    self.edits.replace(json.span(at), number.to_string());
                }
            }
        }
        self.append("meshes", &clones);
    }

    /// The whole, put together.
    pub(crate) fn finished(mut self, format: Format) -> Result<Patched<'a>, SaveError> {
        if self.room.is_none() {
            return Err(cannot_hold(TOO_MANY_COPIES.to_owned(), format));
        }
        let document = self.document;
        let json = &document.json;
        let (accessors, views) = (
            std::mem::take(&mut self.new_accessors),
            std::mem::take(&mut self.new_views),
        );
        self.append("accessors", &accessors);
        self.append("bufferViews", &views);
        for (buffer, &at) in document.buffers_at.iter().enumerate() {
            let length = self.out.buffers[buffer].len();
            if length != document.buffer(buffer).len() {
                self.edits.set_member(json, at, "byteLength", &length.to_string());
            }
        }
        if !self.edits.is_empty() {
            self.out.text = Cow::Owned(self.edits.apply(json.text(), 0..json.text().len()));
        }
        Ok(self.out)
    }

    fn append(&mut self, section: &str, elements: &[String]) {
        let json = &self.document.json;
        match json.member(json.root(), section) {
            Some(list) => self.edits.append_elements(json, list, elements),
            None if elements.is_empty() => {}
            None => self
                .edits
                .set_member(json, json.root(), section, &format!("[{}]", elements.join(","))),
        }
    }
}

/// How many bytes a save may make for each that the drawn set may take.
const MOST_SAVED: usize = 4;

const TOO_MANY_COPIES: &str = "an edit that needs more copies of the same bytes than a file of its size justifies";

/// The refusal of something that no accessor of the file's can be.
pub(crate) fn cannot_hold(what: String, format: Format) -> SaveError {
    SaveError::CannotHold {
        what,
        format,
        remedy: "save as .ply, or export the file again with plain f32 attributes".to_owned(),
    }
}

/// Bounds of elements, number by number; not finite where no element's number is.
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
                // `min` and `max` pass over NaN.
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

/// An f32 as text that reads back as the same number, as f64 too: validators compare either way.
pub(crate) fn number(value: f32) -> String {
    let value = f64::from(value);
    // Rust writes no exponent by itself, and a bound may be 1e-38.
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

/// A sentence for each edited mesh whose morph targets did not turn with it.
fn morph_warnings(
    document: &Document,
    meshes: &[Vec<Primitive>],
    pieces: &Pieces,
    changes: &[PartChange],
) -> Vec<String> {
    let parts = pieces.parts.iter().zip(changes);
    let edited = parts.filter(|(_, change)| !change.is_empty());
    let edited: BTreeSet<usize> = edited.map(|(part, _)| part.mesh).collect();
    let has_targets = |mesh: &usize| meshes[*mesh].iter().any(|primitive| !primitive.targets.is_empty());
    let mut notes = Notes::default();
    for mesh in edited.into_iter().filter(has_targets) {
        let name = document.name(document.meshes_at[mesh]);
        let called = if name.is_empty() {
            String::new()
        } else {
            format!(" ({})", quoted(&name))
        };
        let note =
            format!("The morph targets of mesh {mesh}{called} keep their deltas: they did not turn with the edit.");
        notes.add("meshes", Some(note));
    }
    notes.sentences()
}
