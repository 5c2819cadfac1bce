//! A patched glTF as files: the container it came in, the neighbours that have to go with it.

use std::borrow::Cow;
use std::collections::BTreeSet;

use super::container;
use super::document::{Buffer, Document, ImageFile};
use super::json::{Edits, Json};
use super::patch::Patched;
use super::uri;
use crate::save::{OutputFile, Placement, Save, Saved};
use crate::{Format, SaveError};

/// The files of a glTF saved as the kind it was read as.
pub(super) fn in_its_kind(document: &Document, patched: Patched<'_>, save: &Save<'_>) -> Result<Saved, SaveError> {
    let mut edits = Edits::default();
    let is_unchanged = patched.is_unchanged();
    let own_names = own_names(document, save.name);
    let mut neighbours = Vec::new();
    let mut warnings = patched.warnings;
    // The patched text is parsed again only where a buffer's address in it has to change.
    let buffer_uri = |buffer: usize, json: &Json| {
        let list = json.member(json.root(), "buffers")?;
        json.member(json.elements(list).nth(buffer)?, "uri")
    };
    let json = match &patched.text {
        Cow::Borrowed(_) => None,
        Cow::Owned(text) => Some(reparsed(text)?),
    };
    let json = json.as_ref().unwrap_or(&document.json);
    for (buffer, bytes) in patched.buffers.iter().enumerate() {
        let is_changed = matches!(bytes, Cow::Owned(_));
        match &document.buffers[buffer] {
            Buffer::Bin(_) | Buffer::Absent | Buffer::Decoded(_) => {}
            Buffer::Data(_) => {
                if let Some(at) = buffer_uri(buffer, json).filter(|_| is_changed) {
                    let old = json.string(at).unwrap_or_default();
                    let mime = old
                        .get(5..)
                        .and_then(|rest| rest.split([';', ',']).next())
                        .unwrap_or_default();
                    edits.replace(json.span(at), uri::json_data_uri(mime, bytes));
                }
            }
            Buffer::Neighbour { path, .. } => {
                let name = match save.placement {
                    Placement::SameFile if !is_changed => continue,
                    Placement::SameFolder if is_unchanged => continue,
                    Placement::SameFile | Placement::OtherFolder => inside(path)?,
                    Placement::SameFolder => {
                        if let Some(at) = buffer_uri(buffer, json) {
                            edits.replace(json.span(at), uri::json_uri(&own_names[buffer]));
                        }
                        own_names[buffer].clone()
                    }
                };
                neighbours.push(OutputFile {
                    name,
                    bytes: bytes.to_vec(),
                });
            }
        }
    }
    if save.placement == Placement::OtherFolder {
        bring_images(document, &mut neighbours, &mut warnings)?;
    }
    let text = if edits.is_empty() {
        patched.text
    } else {
        Cow::Owned(edits.apply(json.text(), 0..json.text().len()))
    };
    let bytes = match &document.container {
        _ if is_unchanged && edits.is_empty() => document.file.to_vec(),
        Some(parts) => {
            let bin = document
                .buffers
                .iter()
                .position(|buffer| matches!(buffer, Buffer::Bin(_)));
            let bin = bin.map(|buffer| &patched.buffers[buffer][..]);
            // A BIN chunk that no buffer is stays as it is.
            let bin = bin.or_else(|| parts.bin.clone().map(|range| &document.file[range]));
            let further = &document.file[parts.further_chunks.clone()];
            let trailing = &document.file[parts.trailing.clone()];
            container::join(without_padding(&text), bin, further, trailing)
                .ok_or(SaveError::TooLarge { format: save.format })?
        }
        None => with_mark(document, &text),
    };
    Ok(saved(save, bytes, neighbours, warnings))
}

/// A `.gltf` and its buffer, of a GLB: the BIN chunk becomes a neighbour of OUT's own name.
pub(super) fn unpacked(document: &Document, patched: Patched<'_>, save: &Save<'_>) -> Result<Saved, SaveError> {
    let json = reparsed(&patched.text)?;
    let mut edits = Edits::default();
    let own_names = own_names(document, save.name);
    let mut neighbours = Vec::new();
    let mut warnings = patched.warnings;
    let list = json.member(json.root(), "buffers");
    let buffers_at: Vec<_> = list.into_iter().flat_map(|list| json.elements(list)).collect();
    for (buffer, bytes) in patched.buffers.iter().enumerate() {
        // What was decoded is no buffer of the file.
        let Some(&at) = buffers_at.get(buffer) else { break };
        let own = match &document.buffers[buffer] {
            Buffer::Data(_) if matches!(bytes, Cow::Borrowed(_)) => continue,
            Buffer::Absent | Buffer::Decoded(_) => continue,
            Buffer::Neighbour { path, .. } if save.placement == Placement::OtherFolder => {
                neighbours.push(OutputFile {
                    name: inside(path)?,
                    bytes: bytes.to_vec(),
                });
                continue;
            }
            Buffer::Bin(_) | Buffer::Data(_) | Buffer::Neighbour { .. } => &own_names[buffer],
        };
        edits.set_member(&json, at, "uri", &uri::json_uri(own));
        // A chunk is padded, a file need not be.
        let told = json
            .member(at, "byteLength")
            .and_then(|at| json.number(at))
            .map(|number| number as usize);
        let length = told
            .filter(|&told| told <= bytes.len() && bytes.len() - told < 4)
            .unwrap_or(bytes.len());
        neighbours.push(OutputFile {
            name: own.clone(),
            bytes: bytes[..length].to_vec(),
        });
    }
    if save.placement == Placement::OtherFolder {
        bring_images(document, &mut neighbours, &mut warnings)?;
    }
    let text = edits.apply(json.text(), 0..json.text().len());
    Ok(saved(save, without_padding(&text).to_vec(), neighbours, warnings))
}

pub(super) fn saved(save: &Save<'_>, bytes: Vec<u8>, neighbours: Vec<OutputFile>, warnings: Vec<String>) -> Saved {
    let mut files = vec![OutputFile {
        name: save.name.to_owned(),
        bytes,
    }];
    files.extend(neighbours);
    Saved { files, warnings }
}

/// A text that patches made, parsed again.
pub(super) fn reparsed(text: &[u8]) -> Result<Json, SaveError> {
    Json::parse(text.to_vec()).map_err(|what| SaveError::CannotHold {
        what,
        format: Format::Gltf,
        remedy: "this is a fault of the program, so report it with the file".to_owned(),
    })
}

/// A JSON chunk's content without the spaces that pad it.
pub(super) fn without_padding(text: &[u8]) -> &[u8] {
    let end = text.iter().rposition(|&byte| byte != b' ').map_or(0, |last| last + 1);
    &text[..end]
}

fn with_mark(document: &Document, text: &[u8]) -> Vec<u8> {
    let mark: &[u8] = if document.has_mark { b"\xef\xbb\xbf" } else { b"" };
    [mark, text].concat()
}

fn inside(path: &str) -> Result<String, SaveError> {
    uri::inside(path).ok_or_else(|| SaveError::NeighbourOutside { uri: path.to_owned() })
}

/// The images beside the file, to be written beside OUT.
fn bring_images(
    document: &Document,
    neighbours: &mut Vec<OutputFile>,
    warnings: &mut Vec<String>,
) -> Result<(), SaveError> {
    for image in &document.images {
        let ImageFile::Neighbour { path, bytes } = image else {
            continue;
        };
        let name = inside(path)?;
        match bytes {
            Some(_) if neighbours.iter().any(|neighbour| neighbour.name == name) => {}
            Some(bytes) => neighbours.push(OutputFile {
                name,
                bytes: bytes.to_vec(),
            }),
            None => warnings.push(format!("The image {path} was missing and could not be brought along.")),
        }
    }
    Ok(())
}

/// A name for each buffer that is OUT's own: its stem, numbered from the second one on, and none that a neighbour of
/// the file that was read already has.
fn own_names(document: &Document, out: &str) -> Vec<String> {
    let stem = out.rsplit_once('.').map_or(out, |(stem, _)| stem);
    let of_buffers = document.buffers.iter().filter_map(|buffer| match buffer {
        Buffer::Neighbour { path, .. } => uri::inside(path),
        _ => None,
    });
    let of_images = document.images.iter().filter_map(|image| match image {
        ImageFile::Neighbour { path, .. } => uri::inside(path),
        _ => None,
    });
    let mut taken: BTreeSet<String> = of_buffers.chain(of_images).collect();
    let mut names = Vec::new();
    let mut number = 1;
    for _ in &document.buffers {
        let name = loop {
            let name = if number == 1 {
                format!("{stem}.bin")
            } else {
                format!("{stem}_{number}.bin")
            };
            number += 1;
            if taken.insert(name.clone()) {
                break name;
            }
        };
        names.push(name);
    }
    names
}
