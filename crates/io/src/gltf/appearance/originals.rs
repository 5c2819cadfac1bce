//! Reads a material as the file has it, so that a new glTF can have all of it.
//!
//! The numbers of textures and of sets of texture coordinates are the file's own, so each reference to a texture is
//! resolved. Extensions whose members may refer to other parts of the file are left out and named; those of materials
//! (`KHR_materials_ior`, `KHR_materials_transmission`, ...) refer to textures alone.

use std::collections::BTreeSet;

use serde_json::Value;

use super::maps::{self, IMAGE_EXTENSIONS, Reference};
use crate::appearance::original::{OriginalMaterial, OriginalTexture};
use crate::gltf::document::Document;
use crate::gltf::document::json::At;

const TRANSFORM: &str = "KHR_texture_transform";

/// A part of the names of extensions that only materials have.
const OF_MATERIALS: &str = "_materials_";

/// A material of the file as written, and the names of the parts that it lacks. `None` if its text can't be parsed.
pub(crate) fn original(document: &Document, material: usize) -> Option<(OriginalMaterial, BTreeSet<String>)> {
    let at = *document.materials_at.get(material)?;
    let mut value: Value = document.json.typed(at).ok()?;
    let mut reading = Reading {
        document,
        material,
        textures: Vec::new(),
        lost: BTreeSet::new(),
    };
    reading.resolve(&mut value, at);
    let json = &document.json;
    let required = json.member(json.root(), "extensionsRequired");
    let required = required.into_iter().flat_map(|list| json.elements(list));
    let original = OriginalMaterial {
        value,
        textures: reading.textures,
        required: required.filter_map(|at| json.string(at)).collect(),
    };
    Some((original, reading.lost))
}

struct Reading<'a> {
    document: &'a Document,
    material: usize,
    textures: Vec<OriginalTexture>,
    lost: BTreeSet<String>,
}

impl Reading<'_> {
    /// Resolves the texture references in an object, and removes the extensions that can't be carried over.
    fn resolve(&mut self, value: &mut Value, at: At) {
        let Some(members) = value.as_object_mut() else { return };
        let keep = |name: &String| name.contains(OF_MATERIALS);
        if let Some(extensions) = members.get_mut("extensions").and_then(Value::as_object_mut) {
            self.lost.extend(extensions.keys().filter(|name| !keep(name)).cloned());
            extensions.retain(|name, _| keep(name));
        }
        members.retain(|name, member| {
            let Some(member_at) = self.document.json.member(at, name) else {
                return false;
            };
            if OriginalMaterial::is_texture(name, member) {
                return self.resolve_reference(member, member_at).is_some();
            }
            if name != "extras" {
                self.resolve(member, member_at);
            }
            let is_empty = name == "extensions" && member.as_object().is_some_and(serde_json::Map::is_empty);
            !is_empty
        });
    }

    /// Resolves a reference to a texture; `None` if it can't be carried over.
    fn resolve_reference(&mut self, value: &mut Value, at: At) -> Option<()> {
        let reference = Reference::read(self.document, at)?;
        let sets = self.document.material_maps.get(self.material)?;
        let Some((set, matrix)) = maps::look_up(sets, reference) else {
            self.lost
                .insert("images with a third set of texture coordinates".into());
            return None;
        };
        let members = value.as_object_mut()?;
        let is_own = matrix == reference.transform.matrix();
        if let Some(extensions) = members.get_mut("extensions").and_then(Value::as_object_mut) {
            self.lost
                .extend(extensions.keys().filter(|name| *name != TRANSFORM).cloned());
            extensions.retain(|name, _| name == TRANSFORM && is_own);
            // This set replaces the reference's.
            if let Some(transform) = extensions.get_mut(TRANSFORM).and_then(Value::as_object_mut) {
                transform.remove("texCoord");
            }
            if extensions.is_empty() {
                members.remove("extensions");
            }
        }
        members.insert("index".into(), self.textures.len().into());
        members.remove("texCoord");
        let mut texture = self.texture(reference.texture)?;
        texture.set = set;
        texture.transform = (!is_own).then(|| maps::rows(matrix));
        self.textures.push(texture);
        Some(())
    }

    /// A texture of the file; `None` if it has no image.
    fn texture(&mut self, number: usize) -> Option<OriginalTexture> {
        let json = &self.document.json;
        let nth = |section: &str, number: usize| json.elements(json.member(json.root(), section)?).nth(number);
        let at = nth("textures", number)?;
        let mut value: Value = json.typed(at).ok()?;
        let members = value.as_object_mut()?;
        let count = self.document.images.len();
        let as_image = |value: &Value| {
            value
                .as_u64()
                .map(|image| image as usize)
                .filter(|image| *image < count)
        };
        let plain = members.remove("source").as_ref().and_then(as_image);
        let mut images: Vec<(Option<String>, usize)> = plain.map(|image| (None, image)).into_iter().collect();
        if let Some(extensions) = members.get_mut("extensions").and_then(Value::as_object_mut) {
            extensions.retain(|name, extension| {
                let known = IMAGE_EXTENSIONS.contains(&&**name);
                let image = extension.as_object_mut().and_then(|members| members.remove("source"));
                let image = image.as_ref().and_then(as_image).filter(|_| known);
                if image.is_none() {
                    self.lost.insert(name.clone());
                }
                images.extend(image.map(|image| (Some(name.clone()), image)));
                image.is_some()
            });
            if extensions.is_empty() {
                members.remove("extensions");
            }
        }
        let sampler = members.remove("sampler").and_then(|sampler| sampler.as_u64());
        let sampler = sampler.and_then(|sampler| json.typed(nth("samplers", sampler as usize)?).ok());
        (!images.is_empty()).then_some(OriginalTexture {
            value,
            sampler,
            images,
            set: crate::UvSet::Base,
            transform: None,
        })
    }
}
