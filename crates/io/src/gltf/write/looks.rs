//! Materials, textures, samplers and images of a new glTF.

use std::collections::{BTreeMap, BTreeSet, HashMap};
use std::ops::Range;

use serde_json::{Value, json};

use super::buffer::Built;
use crate::appearance::{Origin, Wrap};
use crate::convert::NewMesh;
use crate::gltf::{FROM_OUTSIDE, NO_IMAGE};
use crate::images::decode::mime_type;
use crate::images::decodes;
use crate::quote::quoted;

/// The media types of images that every reader of glTF knows.
pub(super) const PLAIN: [&str; 2] = ["image/png", "image/jpeg"];

/// Materials, textures, samplers and images that are used.
#[derive(Default)]
pub(super) struct Looks {
    pub(super) materials: Vec<Value>,
    /// The written material of each of the appearance's.
    pub(super) material_of: BTreeMap<usize, usize>,
    textures: Vec<Value>,
    samplers: Vec<Value>,
    images: Vec<Value>,
    /// The written image of each of the appearance's; `None` if glTF can't hold it.
    image_of: BTreeMap<usize, Option<usize>>,
    /// The written texture of each image and wrapping.
    texture_of: HashMap<(usize, [Wrap; 2]), usize>,
    /// The extensions that the materials use.
    pub(super) extensions: BTreeSet<String>,
    /// Those of them that a reader must know.
    pub(super) required: BTreeSet<String>,
    /// The image that was made of bytes at each place.
    image_at: HashMap<(usize, Range<usize>), usize>,
}

impl Looks {
    /// The texture of a written image.
    pub(super) fn texture(&mut self, image: usize, wrap: [Wrap; 2]) -> usize {
        let mode = |wrap| match wrap {
            Wrap::ClampToEdge => 33071,
            Wrap::MirroredRepeat => 33648,
            Wrap::Repeat => 10497,
        };
        *self.texture_of.entry((image, wrap)).or_insert_with(|| {
            let sampler = json!({ "wrapS": mode(wrap[0]), "wrapT": mode(wrap[1]) });
            let sampler = index_of(&mut self.samplers, sampler);
            self.textures.push(json!({ "source": image, "sampler": sampler }));
            self.textures.len() - 1
        })
    }

    /// The texture of a glTF, with the numbers of the written images and sampler put in.
    pub(super) fn texture_as_written(&mut self, mut texture: Value, sampler: Option<&Value>) -> usize {
        if let Some(sampler) = sampler {
            texture["sampler"] = index_of(&mut self.samplers, sampler.clone()).into();
        }
        index_of(&mut self.textures, texture)
    }

    /// The written image; `None` if it can't be written. `types` are the media types that its place in the file may
    /// have.
    pub(super) fn image(&mut self, out: &mut Built, mesh: &NewMesh<'_>, image: usize, types: &[&str]) -> Option<usize> {
        if let Some(&known) = self.image_of.get(&image) {
            return known;
        }
        let found = mesh.appearance.images.get(image)?;
        let name = quoted(&found.name);
        if let Some(&same) = self.image_at.get(&found.encoded.place()) {
            self.image_of.insert(image, Some(same));
            return Some(same);
        }
        if found.origin == Origin::Outside && !decodes(&found.encoded) {
            // A file from a stranger may name any file there, and a private file would be copied as an image.
            out.warnings.push(format!("{name} {NO_IMAGE}"));
            self.image_of.insert(image, None);
            return None;
        }
        let mime = mime_type(&found.encoded).filter(|mime| types.contains(mime));
        let written = match mime {
            Some(mime) => {
                let view = out.bytes(found.encoded.iter().copied());
                let mut value = json!({ "bufferView": view, "mimeType": mime });
                if !found.name.is_empty() {
                    value["name"] = found.name.as_str().into();
                }
                self.images.push(value);
                self.image_at.insert(found.encoded.place(), self.images.len() - 1);
                if found.origin == Origin::Outside {
                    out.warnings.push(format!("{name} {FROM_OUTSIDE}"));
                }
                Some(self.images.len() - 1)
            }
            None if found.encoded.is_empty() => {
                out.warnings
                    .push(format!("The image {name} is missing and could not be embedded."));
                None
            }
            None => {
                out.warnings.push(format!(
                    "The image {name} is neither PNG nor JPEG, so glTF can't embed it."
                ));
                None
            }
        };
        self.image_of.insert(image, written);
        written
    }

    pub(super) fn add_to(self, root: &mut Value) {
        let sections = [
            ("materials", self.materials),
            ("textures", self.textures),
            ("samplers", self.samplers),
            ("images", self.images),
        ];
        for (key, section) in sections {
            if !section.is_empty() {
                root[key] = section.into();
            }
        }
        if !self.extensions.is_empty() {
            root["extensionsUsed"] = json!(self.extensions);
        }
        if !self.required.is_empty() {
            root["extensionsRequired"] = json!(self.required);
        }
    }
}

/// The number of a value in a section; a new value is appended.
pub(super) fn index_of(section: &mut Vec<Value>, value: Value) -> usize {
    let known = section.iter().position(|other| *other == value);
    known.unwrap_or_else(|| {
        section.push(value);
        section.len() - 1
    })
}
