//! The files that a glTF names: collected for a save, each name once, and read from a text.

use std::collections::{BTreeMap, BTreeSet};

use crate::gltf::document::container;
use crate::gltf::document::container::without_padding;
use crate::gltf::document::json::{At, Edits, Json};
use crate::gltf::document::uri::{self, Address};
use crate::gltf::document::{Buffer, Document, ImageFile};
use crate::save::{OutputFile, Role, numbered};

/// The neighbours that a save writes, as they are gathered.
pub(crate) struct Gathered {
    pub files: Vec<OutputFile>,
    /// The place of each name among the files.
    place_of: BTreeMap<String, usize>,
    /// The last number that was tried for a name: all smaller ones are taken.
    last_number: BTreeMap<String, usize>,
    /// Names that are not free for a neighbour with a new name.
    taken: BTreeSet<String>,
}

impl Gathered {
    /// No files yet; the names of the input's neighbours are taken.
    pub fn of(document: &Document) -> Self {
        Self {
            files: Vec::new(),
            place_of: BTreeMap::new(),
            last_number: BTreeMap::new(),
            taken: paths(document).filter_map(uri::inside).collect(),
        }
    }

    /// Adds a neighbour and returns its name: `name`, or another if a neighbour with other bytes has that one.
    ///
    /// Two buffers of a file may name the same file. As long as their bytes are the same they share it; as soon as an
    /// edit makes them differ, each gets its own.
    pub fn add(&mut self, name: String, role: Role, bytes: &[u8]) -> String {
        let known = self.place_of.get(&name).map(|&place| &self.files[place]);
        let name = match known {
            Some(known) if known.bytes == bytes => return name,
            Some(_) => self.free_name(&name),
            None => name,
        };
        self.taken.insert(name.clone());
        self.place_of.insert(name.clone(), self.files.len());
        self.files.push(OutputFile {
            name: name.clone(),
            role,
            bytes: bytes.to_vec(),
        });
        name
    }

    /// Returns true if the neighbour `name` is written with other bytes than these.
    pub fn differs(&self, name: &str, bytes: &[u8]) -> bool {
        let known = self.place_of.get(name).map(|&place| &self.files[place]);
        known.is_some_and(|file| file.bytes != bytes)
    }

    /// `name` with the first number that makes it free.
    fn free_name(&mut self, name: &str) -> String {
        let last = self.last_number.entry(name.to_owned()).or_insert(1);
        loop {
            *last += 1;
            let free = numbered(name, *last);
            if !self.taken.contains(&free) {
                return free;
            }
        }
    }
}

/// The paths by which the input file names its neighbours.
pub(crate) fn paths(document: &Document) -> impl Iterator<Item = &str> {
    let of_buffers = document.buffers.iter().filter_map(|buffer| match buffer {
        Buffer::Neighbour { path, .. } => Some(path.as_str()),
        _ => None,
    });
    let of_images = document.images.iter().filter_map(|image| match image {
        ImageFile::Neighbour { path, .. } => Some(path.as_str()),
        _ => None,
    });
    of_buffers.chain(of_images)
}

/// Returns true if a reader that follows `path` step by step arrives at the file `name`. A path through a folder and
/// back (`b/../a.bin`) needs that folder, which may not exist beside OUT.
pub(crate) fn leads_to(path: &str, name: &str) -> bool {
    let steps = path.split('/').filter(|step| !matches!(*step, "" | "."));
    steps.eq(name.split('/'))
}

/// The `uri` of each element of a section that has one.
pub(crate) fn uris(json: &Json, section: &str) -> Vec<Option<At>> {
    let list = json.member(json.root(), section);
    let elements = list.into_iter().flat_map(|list| json.elements(list));
    elements.map(|element| json.member(element, "uri")).collect()
}

/// The path in its shortest form that a `uri` member names, if it is inside the folder.
fn path_at(json: &Json, at: At) -> Option<String> {
    match uri::address(&json.string(at)?) {
        Ok(Address::Neighbour(path)) => uri::inside(&path),
        _ => None,
    }
}

/// The sections whose elements name neighbours.
const SECTIONS: [&str; 2] = ["buffers", "images"];

/// The files inside its own folder that a glTF names, in their shortest form; `None` if it is not a glTF. `file` is a
/// `.gltf`, a GLB, or a GLB's JSON alone.
pub fn neighbours_named(file: &[u8]) -> Option<Vec<String>> {
    let json = Json::parse(text_of(file)?.to_vec()).ok()?;
    let named = SECTIONS.iter().flat_map(|section| uris(&json, section)).flatten();
    Some(named.filter_map(|at| path_at(&json, at)).collect())
}

/// A glTF with other names for the neighbours that `names` pairs with them, and otherwise unchanged; `None` if it is
/// not a glTF or names none of them.
pub fn with_neighbours_renamed(file: &[u8], names: &[(&str, String)]) -> Option<Vec<u8>> {
    let json = Json::parse(text_of(file)?.to_vec()).ok()?;
    let mut edits = Edits::default();
    for at in SECTIONS.iter().flat_map(|section| uris(&json, section)).flatten() {
        let path = path_at(&json, at);
        if let Some((_, new)) = names.iter().find(|(old, _)| Some(*old) == path.as_deref()) {
            edits.replace(json.span(at), uri::json_uri(new));
        }
    }
    if edits.is_empty() {
        return None;
    }
    let text = edits.apply(json.text(), 0..json.text().len());
    if !container::is_glb(file) {
        let mark = &file[..file.len() - json.text().len()];
        return Some([mark, &text].concat());
    }
    let parts = container::split(file).ok()?;
    let bin = parts.bin.map(|range| &file[range]);
    let (further, trailing) = (&file[parts.further_chunks], &file[parts.trailing]);
    container::join(without_padding(&text), bin, further, trailing)
}

/// Returns true if two glTF are saves of one document: equal, to the letter, in everything that no save changes.
///
/// A save changes numbers in buffers and their descriptions (accessors, views, buffers), clones meshes, adds morph
/// targets, writes compressed ones out plainly and gives neighbours other names. It never changes the number of an
/// accessor's elements, nor scenes, materials, textures, skins, cameras, extras, or the names of nodes; it adds nodes
/// only after the others.
pub fn is_same_document(a: &[u8], b: &[u8]) -> bool {
    let parsed = |file: &[u8]| Json::parse(text_of(file)?.to_vec()).ok();
    let (Some(a), Some(b)) = (parsed(a), parsed(b)) else {
        return false;
    };
    const CHANGED: [&str; 9] = [
        "accessors",
        "animations",
        "bufferViews",
        "buffers",
        "extensionsRequired",
        "extensionsUsed",
        "images",
        "meshes",
        "nodes",
    ];
    let kept = |json: &Json| -> Vec<(Vec<u8>, Vec<u8>)> {
        let members = json.members(json.root());
        let kept = members.filter(|&(key, _)| json.string(key).is_none_or(|key| !CHANGED.contains(&&*key)));
        kept.map(|(key, value)| (json.raw(key).to_vec(), json.raw(value).to_vec()))
            .collect()
    };
    kept(&a) == kept(&b)
        && begin_alike(&said(&a, "nodes", &["name"]), &said(&b, "nodes", &["name"]))
        && said(&a, "images", &["name", "mimeType"]) == said(&b, "images", &["name", "mimeType"])
        && said(&a, "buffers", &["name"]) == said(&b, "buffers", &["name"])
        && begin_alike(
            &said(&a, "accessors", &["count", "type"]),
            &said(&b, "accessors", &["count", "type"]),
        )
}

/// Returns true if both lists begin with these elements.
fn begin_alike<T: PartialEq>(a: &[T], b: &[T]) -> bool {
    a.iter().zip(b).all(|(a, b)| a == b)
}

/// The values of `keys` in the elements of a section, as written.
fn said(json: &Json, section: &str, keys: &[&str]) -> Vec<Vec<Option<Vec<u8>>>> {
    let list = json.member(json.root(), section);
    let elements = list.into_iter().flat_map(|list| json.elements(list));
    let by_keys = |element| {
        keys.iter()
            .map(move |key| Some(json.raw(json.member(element, key)?).to_vec()))
    };
    elements.map(|element| by_keys(element).collect()).collect()
}

/// The JSON of a glTF, without a byte-order mark.
fn text_of(file: &[u8]) -> Option<&[u8]> {
    let text = if container::is_glb(file) {
        &file[container::split(file).ok()?.json]
    } else {
        file
    };
    Some(text.strip_prefix(b"\xef\xbb\xbf").unwrap_or(text))
}
