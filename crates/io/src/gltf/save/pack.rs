//! A `.gltf` packed into a GLB: its buffers and images become one BIN chunk.

use std::borrow::Cow;
use std::collections::{BTreeSet, HashMap};
use std::ops::Range;

use crate::gltf::document::container::{self, without_padding};
use crate::gltf::document::json::{At, Edits, Json};
use crate::gltf::document::{Buffer, Document, ImageFile};
use crate::gltf::save::deliver::{reparsed, saved};
use crate::gltf::save::patch::Patched;
use crate::gltf::{FROM_OUTSIDE, NO_IMAGE, uri};
use crate::images::decode::mime_type;
use crate::images::decodes;
use crate::quote::quoted;
use crate::save::{Save, Saved};
use crate::{Bytes, SaveError};

/// The GLB of a `.gltf`. Images whose bytes are missing or of a kind unknown to glTF keep their address.
pub(crate) fn packed(document: &Document, patched: Patched<'_>, save: &Save<'_>) -> Result<Saved, SaveError> {
    let json = reparsed(&patched.text)?;
    let mut warnings = patched.warnings;
    let mut edits = Edits::default();
    let mut chunk = Chunk::default();
    refuse_unused(document, save)?;
    let homes = pack_buffers(document, &patched.buffers, &mut chunk, &mut warnings);
    move_views(&json, &homes, &mut edits);
    let views = pack_images(document, &json, &mut chunk, &mut edits, &mut warnings);
    append_section(&json, "bufferViews", &views, &mut edits);
    let is_placeholder = |&buffer: &usize| matches!(homes[buffer], Home::Placeholder(_));
    let placeholders: Vec<usize> = (0..homes.len()).filter(is_placeholder).collect();
    set_buffers(&json, chunk.bytes.len(), &placeholders, &mut edits);
    let text = edits.apply(json.text(), 0..json.text().len());
    let bin = (!chunk.bytes.is_empty() || !document.buffers.is_empty()).then_some(&chunk.bytes[..]);
    let bytes = container::join(without_padding(&text), bin, &[], &[]);
    let bytes = bytes.ok_or(SaveError::TooLarge { format: save.format })?;
    Ok(saved(save, bytes, Vec::new(), warnings))
}

/// The BIN chunk that is being filled.
#[derive(Default)]
struct Chunk {
    bytes: Vec<u8>,
    /// The packed places of bytes that several buffers or images share.
    start_of: HashMap<(usize, Range<usize>), usize>,
}

impl Chunk {
    /// Appends bytes at the next multiple of four and returns their start.
    fn append(&mut self, bytes: &[u8]) -> usize {
        let start = self.bytes.len().next_multiple_of(4);
        self.bytes.resize(start, 0);
        self.bytes.extend_from_slice(bytes);
        start
    }

    /// Like [`Self::append`], but only once for shared bytes.
    fn append_shared(&mut self, bytes: &Bytes) -> usize {
        if let Some(&start) = self.start_of.get(&bytes.place()) {
            return start;
        }
        let start = self.append(bytes);
        self.start_of.insert(bytes.place(), start);
        start
    }
}

/// Packs the file's buffers. Returns the destination of each.
fn pack_buffers(
    document: &Document,
    buffers: &[Cow<'_, [u8]>],
    chunk: &mut Chunk,
    warnings: &mut Vec<String>,
) -> Vec<Home> {
    let mut homes = Vec::new();
    let mut placeholder_count = 0;
    for (buffer, bytes) in document.buffers.iter().zip(buffers) {
        homes.push(match buffer {
            Buffer::Decoded(_) => break,
            // The fallback buffer of compressed bytes stays a buffer without bytes.
            Buffer::Absent => {
                placeholder_count += 1;
                Home::Placeholder(placeholder_count)
            }
            Buffer::Neighbour { path, bytes: own } => {
                if uri::inside(path).is_none() {
                    warnings.push(format!("{} {FROM_OUTSIDE}", quoted(path)));
                }
                Home::Packed(match bytes {
                    Cow::Borrowed(_) => chunk.append_shared(own),
                    Cow::Owned(_) => chunk.append(bytes),
                })
            }
            _ => Home::Packed(chunk.append(bytes)),
        });
    }
    homes
}

/// Packs the images and makes each refer to a new buffer view. Returns the views, as JSON.
fn pack_images(
    document: &Document,
    json: &Json,
    chunk: &mut Chunk,
    edits: &mut Edits,
    warnings: &mut Vec<String>,
) -> Vec<String> {
    let mut views: Vec<String> = Vec::new();
    let view_count = elements(json, "bufferViews").len();
    let mut sound: HashMap<(usize, Range<usize>), bool> = HashMap::new();
    let mut view_of: HashMap<(usize, Range<usize>), usize> = HashMap::new();
    for (number, at) in elements(json, "images").into_iter().enumerate() {
        let told = json.member(at, "mimeType").and_then(|at| json.string(at));
        let bytes = match &document.images[number] {
            ImageFile::Data(bytes) | ImageFile::Neighbour { bytes: Some(bytes), .. } => bytes,
            ImageFile::Neighbour { path, bytes: None } => {
                let path = quoted(path);
                warnings.push(format!("The image {path} is missing and could not be packed."));
                continue;
            }
            ImageFile::View(_) | ImageFile::Absent => continue,
        };
        if let ImageFile::Neighbour { path, .. } = &document.images[number]
            && uri::inside(path).is_none()
        {
            // A file from a stranger may name any file there, and a private file would be copied as an image.
            if !*sound.entry(bytes.place()).or_insert_with(|| decodes(bytes)) {
                let path = quoted(path);
                warnings.push(format!("{path} {NO_IMAGE}"));
                continue;
            }
            warnings.push(format!("{} {FROM_OUTSIDE}", quoted(path)));
        }
        let Some(mime) = mime_type(bytes).map(str::to_owned).or(told.clone()) else {
            warnings.push(format!("Image {number} is of an unknown kind and was not packed."));
            continue;
        };
        let Some((key, value)) = json
            .members(at)
            .find(|&(key, _)| json.string(key).as_deref() == Some("uri"))
        else {
            continue;
        };
        let view = *view_of.entry(bytes.place()).or_insert_with(|| {
            let start = chunk.append_shared(bytes);
            let length = bytes.len();
            views.push(format!(
                "{{\"buffer\":0,\"byteOffset\":{start},\"byteLength\":{length}}}"
            ));
            view_count + views.len() - 1
        });
        let mime = if told.is_none() {
            format!(",\"mimeType\":\"{mime}\"")
        } else {
            String::new()
        };
        edits.replace(json.span(key), "\"bufferView\"");
        edits.replace(json.span(value), format!("{view}{mime}"));
    }
    views
}

/// Refuses a buffer outside the file's folder that no accessor reads: a file from a stranger may name any file there,
/// and a private file would be copied.
fn refuse_unused(document: &Document, save: &Save<'_>) -> Result<(), SaveError> {
    let is_outside = |buffer: &Buffer| matches!(buffer, Buffer::Neighbour { path, .. } if uri::inside(path).is_none());
    if !document.buffers.iter().any(is_outside) {
        return Ok(());
    }
    let json = &document.json;
    let views = document.accessors.iter().flat_map(|accessor| {
        let sparse = accessor.sparse.iter();
        let sparse = sparse.flat_map(|sparse| [sparse.indices.buffer_view, sparse.values.buffer_view]);
        accessor.buffer_view.into_iter().chain(sparse)
    });
    let images = document.images.iter().filter_map(|image| match image {
        ImageFile::View(view) => Some(*view),
        _ => None,
    });
    let views: BTreeSet<usize> = views.map(|view| view.value()).chain(images).collect();
    // This is the place in the text, because a view that was decoded from compressed bytes refers to another buffer by
    // now.
    let mut used: BTreeSet<usize> = BTreeSet::new();
    for &at in views.iter().filter_map(|&view| document.views_at.get(view)) {
        let extensions = json.member(at, "extensions");
        let of_extensions = extensions.into_iter().flat_map(|at| json.members(at));
        let places = std::iter::once(at).chain(of_extensions.map(|(_, extension)| extension));
        let numbers = places.filter_map(|at| json.number(json.member(at, "buffer")?));
        used.extend(numbers.map(|number| number as usize));
    }
    for (number, buffer) in document.buffers.iter().enumerate() {
        if let Buffer::Neighbour { path, .. } = buffer
            && is_outside(buffer)
            && !used.contains(&number)
        {
            return Err(SaveError::CannotHold {
                what: format!("{}, an unused buffer outside the file's own folder,", quoted(path)),
                format: save.format,
                remedy: "remove it from the file's buffers".to_owned(),
            });
        }
    }
    Ok(())
}

/// The destination of a buffer.
#[derive(Clone, Copy)]
enum Home {
    /// Into the one buffer, from this byte on.
    Packed(usize),
    /// It stays a separate buffer, with this number.
    Placeholder(usize),
}

/// Makes every buffer view and its compression extension refer to its buffer's new place.
fn move_views(json: &Json, homes: &[Home], edits: &mut Edits) {
    for view in elements(json, "bufferViews") {
        let extensions = json.member(view, "extensions");
        let of_extensions = extensions.into_iter().flat_map(|at| json.members(at));
        for at in std::iter::once(view).chain(of_extensions.map(|(_, extension)| extension)) {
            let number = |key: &str| json.member(at, key).and_then(|at| json.number(at));
            let Some(home) = number("buffer").and_then(|buffer| homes.get(buffer as usize)) else {
                continue;
            };
            let (new, start) = match *home {
                Home::Packed(start) => (0, start),
                Home::Placeholder(new) => (new, 0),
            };
            let new = new.to_string();
            if let Some(buffer) = json
                .member(at, "buffer")
                .filter(|&buffer| json.raw(buffer) != new.as_bytes())
            {
                edits.replace(json.span(buffer), new);
            }
            if start > 0 {
                let offset = number("byteOffset").unwrap_or(0.0) as usize + start;
                edits.set_member(json, at, "byteOffset", &offset.to_string());
            }
        }
    }
}

/// Leaves one buffer without an address, with the first one's other members, and after it the placeholders.
fn set_buffers(json: &Json, length: usize, placeholders: &[usize], edits: &mut Edits) {
    let Some(list) = json.member(json.root(), "buffers") else {
        if length > 0 {
            edits.set_member(json, json.root(), "buffers", &format!("[{{\"byteLength\":{length}}}]"));
        }
        return;
    };
    let old: Vec<At> = json.elements(list).collect();
    let text = |at: At| String::from_utf8_lossy(json.raw(at)).into_owned();
    let first = (0..old.len()).find(|number| placeholders.binary_search(number).is_err());
    let kept = first.into_iter().flat_map(|first| json.members(old[first]));
    let kept = kept.filter(|&(key, _)| !matches!(json.string(key).as_deref(), Some("uri" | "byteLength")));
    let mut members: Vec<String> = vec![format!("\"byteLength\":{length}")];
    members.extend(kept.map(|(key, value)| format!("{}:{}", text(key), text(value))));
    let mut buffers = Vec::new();
    // The placeholders' numbers begin at 1, so the packed buffer is kept even if it is empty.
    if length > 0 || !placeholders.is_empty() {
        buffers.push(format!("{{{}}}", members.join(",")));
    }
    buffers.extend(placeholders.iter().map(|&number| text(old[number])));
    edits.replace(json.span(list), format!("[{}]", buffers.join(",")));
}

fn append_section(json: &Json, key: &str, new: &[String], edits: &mut Edits) {
    match json.member(json.root(), key) {
        Some(list) => edits.append_elements(json, list, new),
        None if new.is_empty() => {}
        None => edits.set_member(json, json.root(), key, &format!("[{}]", new.join(","))),
    }
}

fn elements(json: &Json, key: &str) -> Vec<At> {
    json.member(json.root(), key)
        .map_or_else(Vec::new, |list| json.elements(list).collect())
}
