//! A `.gltf` packed into a GLB: its buffers and images become one BIN chunk.

use super::container;
use super::deliver::{reparsed, saved, without_padding};
use super::document::{Buffer, Document, ImageFile};
use super::json::{At, Edits, Json};
use super::patch::Patched;
use crate::SaveError;
use crate::image::mime_type;
use crate::save::{Save, Saved};

/// The GLB of a `.gltf`. Images whose bytes are missing or of no kind that glTF knows keep their address.
pub(super) fn packed(document: &Document, patched: Patched<'_>, save: &Save<'_>) -> Result<Saved, SaveError> {
    let json = reparsed(&patched.text)?;
    let mut warnings = patched.warnings;
    let mut edits = Edits::default();
    let mut bin: Vec<u8> = Vec::new();
    let mut homes = Vec::new();
    let mut placeholders = Vec::new();
    for (buffer, bytes) in document.buffers.iter().zip(&patched.buffers) {
        homes.push(match buffer {
            Buffer::Decoded(_) => break,
            // What stands in for compressed bytes stays a buffer without any.
            Buffer::Absent => {
                placeholders.push(homes.len());
                Home::Placeholder(placeholders.len())
            }
            _ => Home::Packed(append(&mut bin, bytes)),
        });
    }
    move_views(&json, &homes, &mut edits);
    let mut views = Vec::new();
    let view_count = elements(&json, "bufferViews").len();
    for (number, at) in elements(&json, "images").into_iter().enumerate() {
        let told = json.member(at, "mimeType").and_then(|at| json.string(at));
        let bytes = match &document.images[number] {
            ImageFile::Data(bytes) | ImageFile::Neighbour { bytes: Some(bytes), .. } => bytes,
            ImageFile::Neighbour { path, bytes: None } => {
                warnings.push(format!("The image {path} was missing and could not be packed."));
                continue;
            }
            ImageFile::View(_) | ImageFile::Absent => continue,
        };
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
        let start = append(&mut bin, bytes);
        let view = view_count + views.len();
        views.push(format!(
            "{{\"buffer\":0,\"byteOffset\":{start},\"byteLength\":{}}}",
            bytes.len()
        ));
        let mime = if told.is_none() {
            format!(",\"mimeType\":\"{mime}\"")
        } else {
            String::new()
        };
        edits.replace(json.span(key), "\"bufferView\"");
        edits.replace(json.span(value), format!("{view}{mime}"));
    }
    append_section(&json, "bufferViews", &views, &mut edits);
    set_buffers(&json, bin.len(), &placeholders, &mut edits);
    let text = edits.apply(json.text(), 0..json.text().len());
    let bin = (!bin.is_empty() || !document.buffers.is_empty()).then_some(&bin[..]);
    let bytes = container::join(without_padding(&text), bin, &[], &[]);
    let bytes = bytes.ok_or(SaveError::TooLarge { format: save.format })?;
    Ok(saved(save, bytes, Vec::new(), warnings))
}

/// Puts bytes at the next multiple of four and says where they begin.
fn append(bin: &mut Vec<u8>, bytes: &[u8]) -> usize {
    let start = bin.len().next_multiple_of(4);
    bin.resize(start, 0);
    bin.extend_from_slice(bytes);
    start
}

/// Where a buffer goes.
#[derive(Clone, Copy)]
enum Home {
    /// Into the one buffer, from this byte on.
    Packed(usize),
    /// It stays a buffer of its own, of this number.
    Placeholder(usize),
}

/// Lets every buffer view, and what it says of compressed bytes, point where its buffer went.
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

/// Leaves one buffer without an address, the first one's other members kept, and behind it the placeholders.
fn set_buffers(json: &Json, length: usize, placeholders: &[usize], edits: &mut Edits) {
    let Some(list) = json.member(json.root(), "buffers") else {
        if length > 0 {
            edits.set_member(json, json.root(), "buffers", &format!("[{{\"byteLength\":{length}}}]"));
        }
        return;
    };
    let old: Vec<At> = json.elements(list).collect();
    let text = |at: At| String::from_utf8_lossy(json.raw(at)).into_owned();
    let first = (0..old.len()).find(|number| !placeholders.contains(number));
    let kept = first.into_iter().flat_map(|first| json.members(old[first]));
    let kept = kept.filter(|&(key, _)| !matches!(json.string(key).as_deref(), Some("uri" | "byteLength")));
    let mut members: Vec<String> = vec![format!("\"byteLength\":{length}")];
    members.extend(kept.map(|(key, value)| format!("{}:{}", text(key), text(value))));
    let mut buffers = Vec::new();
    // The placeholders' numbers begin at 1, so the packed buffer stands there even if it is empty.
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
