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
    let mut starts = Vec::new();
    for (number, (buffer, bytes)) in document.buffers.iter().zip(&patched.buffers).enumerate() {
        if matches!(buffer, Buffer::Absent) {
            return Err(SaveError::CannotHold {
                what: format!("buffer {number}, which has no bytes,"),
                format: save.format,
                remedy: "save as .gltf".to_owned(),
            });
        }
        starts.push(append(&mut bin, bytes));
    }
    move_views(&json, &starts, &mut edits);
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
    set_buffer(&json, bin.len(), &mut edits);
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

/// Lets every buffer view point into the one buffer, whose parts begin at `starts`.
fn move_views(json: &Json, starts: &[usize], edits: &mut Edits) {
    for at in elements(json, "bufferViews") {
        let number = |key: &str| json.member(at, key).and_then(|at| json.number(at));
        let Some(start) = number("buffer").and_then(|buffer| starts.get(buffer as usize)) else {
            continue;
        };
        if let Some(buffer) = json.member(at, "buffer").filter(|&buffer| json.raw(buffer) != b"0") {
            edits.replace(json.span(buffer), "0");
        }
        if *start > 0 {
            let offset = number("byteOffset").unwrap_or(0.0) as usize + start;
            edits.set_member(json, at, "byteOffset", &offset.to_string());
        }
    }
}

/// Leaves one buffer without an address, the first one's other members kept.
fn set_buffer(json: &Json, length: usize, edits: &mut Edits) {
    let Some(list) = json.member(json.root(), "buffers") else {
        if length > 0 {
            edits.set_member(json, json.root(), "buffers", &format!("[{{\"byteLength\":{length}}}]"));
        }
        return;
    };
    let kept = json
        .elements(list)
        .next()
        .into_iter()
        .flat_map(|first| json.members(first));
    let kept = kept.filter(|&(key, _)| !matches!(json.string(key).as_deref(), Some("uri" | "byteLength")));
    let text = |at: At| String::from_utf8_lossy(json.raw(at)).into_owned();
    let mut members: Vec<String> = vec![format!("\"byteLength\":{length}")];
    members.extend(kept.map(|(key, value)| format!("{}:{}", text(key), text(value))));
    let buffers = if length > 0 {
        format!("[{{{}}}]", members.join(","))
    } else {
        "[]".to_owned()
    };
    edits.replace(json.span(list), buffers);
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
