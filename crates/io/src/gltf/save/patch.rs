//! A save's changes to the JSON text and to the buffers' bytes.

use std::borrow::Cow;
use std::collections::{BTreeMap, HashMap};

use crate::gltf::document::json::Edits;
use crate::gltf::document::{Buffer, Document};
use crate::gltf::geometry::primitive::Primitive;
use crate::gltf::save::copy_on_write::{AttributeUse, MeshCopy};
use crate::{Format, SaveError};

/// The JSON text and the buffers after an edit.
#[derive(Debug)]
pub(crate) struct Patched<'a> {
    /// Without a byte-order mark.
    pub text: Cow<'a, [u8]>,
    /// By buffer; borrowed if nothing changed.
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

    /// Returns true if this is the document as it was read.
    pub fn is_unchanged(&self) -> bool {
        let is_borrowed = |cow: &Cow<'_, [u8]>| matches!(cow, Cow::Borrowed(_));
        is_borrowed(&self.text) && self.buffers.iter().all(is_borrowed)
    }
}

/// The parts of the new file.
pub(crate) struct Patch<'a> {
    pub document: &'a Document,
    pub out: Patched<'a>,
    pub edits: Edits,
    /// Edits of each mesh copy's primitives: of clones only, as they apply to a copy of the text.
    clone_edits: BTreeMap<usize, Edits>,
    new_accessors: Vec<String>,
    new_views: Vec<String>,
    pub(super) new_nodes: Vec<String>,
    /// The number of bytes that buffers may still take for themselves.
    room: Option<usize>,
    /// For each group of accessors at one place, whether all of them get the same change.
    pub(super) are_twins_alike: HashMap<usize, bool>,
}

impl<'a> Patch<'a> {
    /// No change yet.
    pub fn new(document: &'a Document) -> Self {
        Self {
            document,
            out: Patched::unchanged(document),
            edits: Edits::default(),
            clone_edits: BTreeMap::new(),
            new_accessors: Vec::new(),
            new_views: Vec::new(),
            new_nodes: Vec::new(),
            room: Some(document.drawing_budget().saturating_mul(MOST_SAVED)),
            are_twins_alike: HashMap::new(),
        }
    }

    /// Adds an accessor, written out, and gives its number.
    pub fn push_accessor(&mut self, text: String) -> usize {
        self.new_accessors.push(text);
        self.document.accessors_at.len() + self.new_accessors.len() - 1
    }

    /// The reason why an accessor gets no view of its own.
    pub(crate) fn why_no_view(&self, accessor: usize) -> String {
        match self.room {
            None => TOO_MANY_COPIES.to_owned(),
            Some(_) => format!("accessor {accessor}, which is in no buffer,"),
        }
    }

    /// Appends bytes to a buffer (`home`, if it can take them) and returns the number of a new view of them, which has
    /// `members` besides its place; `None` if the file has no buffer with bytes.
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

    /// A buffer's bytes, to be changed; `None` if the save already takes more memory than the file justifies.
    pub(super) fn own(&mut self, buffer: usize) -> Option<&mut Vec<u8>> {
        let bytes = &mut self.out.buffers[buffer];
        if matches!(bytes, Cow::Borrowed(_)) {
            self.room = self.room.and_then(|room| room.checked_sub(bytes.len()));
        }
        self.room?;
        Some(bytes.to_mut())
    }

    /// Lets a primitive's attribute name another accessor.
    pub(super) fn rename(
        &mut self,
        meshes: &[Vec<Primitive>],
        copies: &[MeshCopy],
        attribute: &AttributeUse,
        accessor: usize,
    ) {
        let json = &self.document.json;
        let copy = &copies[attribute.copy];
        let primitive = meshes[copy.mesh][attribute.primitive].at;
        let Some(at) = json.path(primitive, &["attributes", attribute.semantic.key()]) else {
            return;
        };
        self.edits_of_copy(copies, attribute.copy)
            .replace(json.span(at), accessor.to_string());
    }

    /// The edits of a mesh's own text, or of its clone's text.
    pub(crate) fn edits_of_copy(&mut self, copies: &[MeshCopy], number: usize) -> &mut Edits {
        match copies[number].is_clone {
            false => &mut self.edits,
            true => self.clone_edits.entry(number).or_default(),
        }
    }

    /// Adds the clones after the meshes and makes their nodes refer to them.
    ///
    /// # Errors
    /// Copies of one node that differ and can't become nodes.
    pub(crate) fn clone_meshes(&mut self, copies: &[MeshCopy], format: Format) -> Result<(), SaveError> {
        let json = &self.document.json;
        let mut clones = Vec::new();
        // For each node, the mesh of each of its copies.
        let mut shown: BTreeMap<usize, Vec<(usize, usize)>> = BTreeMap::new();
        for (number, copy) in copies.iter().enumerate() {
            for &(node, copy_of_node) in &copy.uses {
                shown.entry(node).or_default().push((copy_of_node, number));
            }
            if copy.is_clone {
                let span = json.span(self.document.meshes_at[copy.mesh]);
                let edits = self.clone_edits.remove(&number).unwrap_or_default();
                clones.push(String::from_utf8_lossy(&edits.apply(json.text(), span)).into_owned());
            }
        }
        for (node, mut of_node) in shown {
            of_node.sort_unstable();
            let numbers: Vec<usize> = of_node.into_iter().map(|(_, number)| number).collect();
            let at = json.member(self.document.nodes_at[node], "mesh");
            match (numbers.iter().all(|number| *number == numbers[0]), at) {
                (false, _) => self.unpack_copies(node, &numbers, format)?,
                (true, Some(at)) if copies[numbers[0]].is_clone => {
                    self.edits.replace(json.span(at), numbers[0].to_string());
                }
                (true, _) => {}
            }
        }
        self.append("meshes", &clones);
        let nodes = std::mem::take(&mut self.new_nodes);
        self.append("nodes", &nodes);
        Ok(())
    }

    /// The complete new file.
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

    pub(super) fn append(&mut self, section: &str, elements: &[String]) {
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

/// The bytes that a save may make for each byte that the drawn set may take.
const MOST_SAVED: usize = 4;

const TOO_MANY_COPIES: &str = "an edit that needs too many copies of the same bytes for a file of its size";

/// The refusal of `what`, which does not fit the file's accessors.
pub(crate) fn cannot_hold(what: String, format: Format) -> SaveError {
    SaveError::CannotHold {
        what,
        format,
        remedy: "save as .ply, or export the file again with plain f32 attributes".to_owned(),
    }
}
