//! A patched glTF as files: its container, and the neighbours that must go with it.

use std::borrow::Cow;
use std::collections::BTreeSet;

use crate::gltf::document::container;
use crate::gltf::document::json::{At, Edits, Json};
use crate::gltf::document::uri;
use crate::gltf::document::{Buffer, Document, ImageFile};
use crate::gltf::neighbours::{self, Gathered, leads_to};
use crate::gltf::save::patch::Patched;
use crate::save::{OutputFile, Placement, Role, Save, Saved, own_stem};
use crate::{Format, SaveError, quoted};

/// The files of a glTF saved in the format that it was read in.
pub(crate) fn in_its_kind(document: &Document, patched: Patched<'_>, save: &Save<'_>) -> Result<Saved, SaveError> {
    let mut edits = Edits::default();
    let is_unchanged = patched.is_unchanged();
    let own_names = own_names(document, save.name);
    let mut gathered = Gathered::of(document);
    let mut warnings = patched.warnings;
    // The patched text is parsed again only if it differs from the input.
    let json = match &patched.text {
        Cow::Borrowed(_) => None,
        Cow::Owned(text) => Some(reparsed(text)?),
    };
    let json = json.as_ref().unwrap_or(&document.json);
    let buffer_uris = neighbours::uris(json, "buffers");
    let image_uris = neighbours::uris(json, "images");
    for (buffer, bytes) in patched.buffers.iter().enumerate() {
        let is_changed = matches!(bytes, Cow::Owned(_));
        match &document.buffers[buffer] {
            Buffer::Bin(_) | Buffer::Absent | Buffer::Decoded(_) => {}
            Buffer::Data(_) => {
                if let Some(at) = buffer_uris[buffer].filter(|_| is_changed) {
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
                    Placement::OtherFolder => inside(path)?,
                    // Files with other names and in other folders may need neighbours with other names.
                    Placement::SameFile => {
                        let name = inside(path)?;
                        let is_own = is_own_name(&name, save.name);
                        if is_own { name } else { own_names[buffer].clone() }
                    }
                    Placement::SameFolder => own_names[buffer].clone(),
                };
                let name = gathered.add(name, Role::Buffer, bytes);
                if let Some(at) = buffer_uris[buffer].filter(|_| !leads_to(path, &name)) {
                    edits.replace(json.span(at), uri::json_uri(&name));
                }
            }
        }
    }
    match save.placement {
        Placement::OtherFolder => bring_images(document, json, &image_uris, &mut gathered, &mut edits, &mut warnings)?,
        Placement::SameFile => {
            let uris = [&buffer_uris[..], &image_uris[..]];
            separate_shared(document, &patched.buffers, json, uris, &mut gathered, &mut edits);
        }
        Placement::SameFolder => {}
    }
    let text = if edits.is_empty() {
        patched.text
    } else {
        Cow::Owned(edits.apply(json.text(), 0..json.text().len()))
    };
    let bytes = if is_unchanged && edits.is_empty() {
        document.file.to_vec()
    } else {
        let bytes = contained(document, &text, &patched.buffers);
        bytes.ok_or(SaveError::TooLarge { format: save.format })?
    };
    Ok(saved(save, bytes, gathered.files, warnings))
}

/// A `.gltf` and its buffer, of a GLB: the BIN chunk becomes a neighbour of OUT's own name.
pub(crate) fn unpacked(document: &Document, patched: Patched<'_>, save: &Save<'_>) -> Result<Saved, SaveError> {
    let json = reparsed(&patched.text)?;
    let mut edits = Edits::default();
    let own_names = own_names(document, save.name);
    let mut gathered = Gathered::of(document);
    let mut warnings = patched.warnings;
    let list = json.member(json.root(), "buffers");
    let buffers_at: Vec<_> = list.into_iter().flat_map(|list| json.elements(list)).collect();
    for (buffer, bytes) in patched.buffers.iter().enumerate() {
        // Decoded bytes are not a buffer of the file.
        let Some(&at) = buffers_at.get(buffer) else { break };
        let own = match &document.buffers[buffer] {
            Buffer::Data(_) if matches!(bytes, Cow::Borrowed(_)) => continue,
            Buffer::Absent | Buffer::Decoded(_) => continue,
            Buffer::Neighbour { path, .. } if save.placement == Placement::OtherFolder => {
                let name = gathered.add(inside(path)?, Role::Buffer, bytes);
                if !leads_to(path, &name) {
                    edits.set_member(&json, at, "uri", &uri::json_uri(&name));
                }
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
        gathered.add(own.clone(), Role::Buffer, &bytes[..length]);
    }
    if save.placement == Placement::OtherFolder {
        let image_uris = neighbours::uris(&json, "images");
        bring_images(document, &json, &image_uris, &mut gathered, &mut edits, &mut warnings)?;
    }
    let text = edits.apply(json.text(), 0..json.text().len());
    Ok(saved(
        save,
        container::without_padding(&text).to_vec(),
        gathered.files,
        warnings,
    ))
}

pub(crate) fn saved(save: &Save<'_>, bytes: Vec<u8>, neighbours: Vec<OutputFile>, warnings: Vec<String>) -> Saved {
    let mut saved = Saved::alone(save.name, bytes, warnings);
    saved.files.extend(neighbours);
    saved
}

/// A text after patching, parsed again.
pub(crate) fn reparsed(text: &[u8]) -> Result<Json, SaveError> {
    Json::parse(text.to_vec()).map_err(|what| SaveError::CannotHold {
        what,
        format: Format::Gltf,
        remedy: "this is a fault of the program: report it with the file".to_owned(),
    })
}

/// The text in the container of the input file, with its BIN chunk taken from `buffers`; `None` if that is too large
/// for a GLB.
fn contained(document: &Document, text: &[u8], buffers: &[Cow<'_, [u8]>]) -> Option<Vec<u8>> {
    let Some(instances) = &document.container else {
        return Some(with_mark(document, text));
    };
    let bin = document
        .buffers
        .iter()
        .position(|buffer| matches!(buffer, Buffer::Bin(_)));
    let bin = bin.map(|buffer| &buffers[buffer][..]);
    // A BIN chunk that no buffer uses does not change.
    let bin = bin.or_else(|| instances.bin.clone().map(|range| &document.file[range]));
    let further = &document.file[instances.further_chunks.clone()];
    let trailing = &document.file[instances.trailing.clone()];
    container::join(container::without_padding(text), bin, further, trailing)
}

fn with_mark(document: &Document, text: &[u8]) -> Vec<u8> {
    let mark: &[u8] = if document.has_mark { b"\xef\xbb\xbf" } else { b"" };
    [mark, text].concat()
}

fn inside(path: &str) -> Result<String, SaveError> {
    uri::inside(path).ok_or_else(|| SaveError::NeighbourOutside { uri: path.to_owned() })
}

/// Writes a separate file for each unchanged buffer and image that shared a file with a changed buffer. `uris` are the
/// places of the buffers' and the images' URIs in the text.
fn separate_shared(
    document: &Document,
    buffers: &[Cow<'_, [u8]>],
    json: &Json,
    uris: [&[Option<At>]; 2],
    gathered: &mut Gathered,
    edits: &mut Edits,
) {
    let buffers = document.buffers.iter().zip(buffers).zip(uris[0]);
    let buffers = buffers.filter_map(|((buffer, bytes), at)| match (buffer, bytes) {
        (Buffer::Neighbour { path, .. }, Cow::Borrowed(bytes)) => Some((Role::Buffer, path, *bytes, at)),
        _ => None,
    });
    let images = document.images.iter().zip(uris[1]);
    let images = images.filter_map(|(image, at)| match image {
        ImageFile::Neighbour { path, bytes } => Some((Role::Image, path, bytes.as_deref()?, at)),
        _ => None,
    });
    for (role, path, bytes, at) in buffers.chain(images) {
        let Some(name) = uri::inside(path).filter(|name| gathered.differs(name, bytes)) else {
            continue;
        };
        let name = gathered.add(name, role, bytes);
        if let Some(at) = at {
            edits.replace(json.span(*at), uri::json_uri(&name));
        }
    }
}

/// The images beside the file, to be written beside OUT.
fn bring_images(
    document: &Document,
    json: &Json,
    uris: &[Option<At>],
    gathered: &mut Gathered,
    edits: &mut Edits,
    warnings: &mut Vec<String>,
) -> Result<(), SaveError> {
    for (image, at) in document.images.iter().zip(uris) {
        let ImageFile::Neighbour { path, bytes } = image else {
            continue;
        };
        let name = inside(path)?;
        let Some(bytes) = bytes else {
            let path = quoted(path);
            warnings.push(format!("The image {path} is missing and could not be copied."));
            continue;
        };
        let name = gathered.add(name, Role::Image, bytes);
        if let Some(at) = at.filter(|_| !leads_to(path, &name)) {
            edits.replace(json.span(at), uri::json_uri(&name));
        }
    }
    Ok(())
}

/// Returns true if a buffer has OUT's name, apart from a number after the stem and the extension.
fn is_own_name(name: &str, out: &str) -> bool {
    let behind = name.strip_prefix(&own_stem(out));
    let number = behind
        .and_then(|behind| behind.rsplit_once('.'))
        .map(|(number, _)| number);
    number.is_some_and(|number| {
        let digits = number.trim_start_matches(['_', '-']);
        digits.bytes().all(|byte| byte.is_ascii_digit())
    })
}

/// A name for each buffer that is OUT's own: its stem, numbered from the second one on, and different from all
/// neighbours of the input file.
fn own_names(document: &Document, out: &str) -> Vec<String> {
    let stem = own_stem(out);
    let mut taken: BTreeSet<String> = neighbours::paths(document).filter_map(uri::inside).collect();
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
