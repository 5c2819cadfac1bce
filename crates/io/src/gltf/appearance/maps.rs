//! A material's images other than the base colour's, and the texture coordinates that they use.
//!
//! The drawn vertices carry the base colour's coordinates with their transform applied, and at most one further set as
//! stored. An image that uses the base colour's set is looked up there, with the inverse of the base colour's transform
//! followed by its own; one that uses any other set is looked up in the second. They are read from the text, because
//! the `gltf` crate has types for the extensions of only some texture references.

use ::gltf::json::texture::WrappingMode;
use ::gltf::json::validation::Checked;
use glam::Mat3;

use crate::appearance::{Lighting, Map, Material, UvSet, Wrap};
use crate::gltf::document::Document;
use crate::gltf::document::json::At;
pub(crate) use crate::gltf::uv_sets::{MaterialMaps, UvTransform};

/// The images beside the base colour's, by their paths in a material.
const OTHER_MAPS: [&[&str]; 4] = [
    &["pbrMetallicRoughness", "metallicRoughnessTexture"],
    &["normalTexture"],
    &["occlusionTexture"],
    &["emissiveTexture"],
];

/// The sets of texture coordinates of each material's images.
pub(crate) fn of_materials(document: &Document) -> Vec<MaterialMaps> {
    (0..document.materials_at.len())
        .map(|material| MaterialMaps::of(document, material))
        .collect()
}

impl MaterialMaps {
    /// The sets of a material of the file.
    pub fn of(document: &Document, material: usize) -> Self {
        let references = References::of(document, material);
        let (base_set, base_transform) = match (references.base, references.others.iter().flatten().next()) {
            (Some(base), _) => (base.set, base.transform),
            (None, Some(other)) => (other.set, UvTransform::IDENTITY),
            (None, None) => (0, UvTransform::IDENTITY),
        };
        let is_lost = base_transform.matrix().determinant().abs() < 1e-12;
        let second_set = references
            .others
            .iter()
            .flatten()
            .map(|reference| reference.set)
            .find(|&set| set != base_set || is_lost);
        Self {
            base_set,
            base_transform,
            second_set,
        }
    }
}

/// Sets in `out` the text's further members of a material: everything besides its base colour, factors and alpha.
pub(crate) fn dress(document: &Document, material: usize, out: &mut Material) {
    let Some(&at) = document.materials_at.get(material) else {
        return;
    };
    let json = &document.json;
    let number = |path: &[&str]| json.path(at, path).and_then(|at| json.number(at));
    let Some(sets) = document.material_maps.get(material) else {
        return;
    };
    let references = References::of(document, material);
    let [metallic_roughness, normal, occlusion, emissive] =
        references.others.map(|reference| map(document, sets, reference?));
    out.metallic_roughness_map = metallic_roughness;
    out.normal_map = normal;
    out.occlusion_map = occlusion;
    out.emissive_map = emissive;
    out.normal_scale = number(&["normalTexture", "scale"]).unwrap_or(1.0) as f32;
    out.occlusion_strength = number(&["occlusionTexture", "strength"]).unwrap_or(1.0).clamp(0.0, 1.0) as f32;
    let strength = number(&["extensions", "KHR_materials_emissive_strength", "emissiveStrength"])
        .unwrap_or(1.0)
        .max(0.0);
    let factor: Option<[f64; 3]> = json.member(at, "emissiveFactor").and_then(|at| json.typed(at).ok());
    out.emissive = factor.unwrap_or_default().map(|channel| (channel * strength) as f32);
    if json.path(at, &["extensions", "KHR_materials_unlit"]).is_some() {
        out.lighting = Lighting::Unlit;
    }
}

/// Extensions that name an image of a kind that plain glTF does not have.
pub(super) const IMAGE_EXTENSIONS: [&str; 2] = ["EXT_texture_webp", "KHR_texture_basisu"];

/// The image of a texture and its wrapping.
pub(crate) fn image_of(document: &Document, texture: usize) -> Option<(usize, [Wrap; 2])> {
    let texture = document.textures.get(texture)?;
    let others = texture.extensions.as_ref().map(|extensions| &extensions.others);
    // The plain image comes first: an extension's is optional.
    let image = Some(texture.source.value())
        .filter(|&image| image < document.images.len())
        .or_else(|| {
            IMAGE_EXTENSIONS
                .iter()
                .find_map(|name| others?.get(*name)?.get("source")?.as_u64())
                .map(|image| image as usize)
        })?;
    let sampler = texture
        .sampler
        .and_then(|sampler| document.samplers.get(sampler.value()));
    let wrap = sampler.map_or([Wrap::Repeat; 2], |sampler| {
        [wrap(sampler.wrap_s), wrap(sampler.wrap_t)]
    });
    (image < document.images.len()).then_some((image, wrap))
}

fn wrap(mode: Checked<WrappingMode>) -> Wrap {
    match mode {
        Checked::Valid(WrappingMode::ClampToEdge) => Wrap::ClampToEdge,
        Checked::Valid(WrappingMode::MirroredRepeat) => Wrap::MirroredRepeat,
        _ => Wrap::Repeat,
    }
}

/// A texture that a material names.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(super) struct Reference {
    /// The texture's number in the file, which may have no such texture.
    pub texture: usize,
    /// The file's set of texture coordinates.
    pub set: u32,
    pub transform: UvTransform,
}

/// All textures that a material names.
struct References {
    base: Option<Reference>,
    others: [Option<Reference>; 4],
}

impl References {
    fn of(document: &Document, material: usize) -> Self {
        let at = document.materials_at.get(material).copied();
        let reference = |path: &[&str]| Reference::read(document, document.json.path(at?, path)?);
        Self {
            base: reference(&["pbrMetallicRoughness", "baseColorTexture"]),
            others: OTHER_MAPS.map(reference),
        }
    }
}

impl Reference {
    /// Reads the reference at this place.
    pub fn read(document: &Document, info: At) -> Option<Self> {
        let json = &document.json;
        let number = |path: &[&str]| json.path(info, path).and_then(|at| json.number(at));
        let transform = json.path(info, &["extensions", "KHR_texture_transform"]);
        let pair = |key: &str, missing: [f32; 2]| {
            let stored = json.member(transform?, key).and_then(|at| json.typed(at).ok());
            Some(stored.unwrap_or(missing))
        };
        let set = number(&["extensions", "KHR_texture_transform", "texCoord"])
            .or(number(&["texCoord"]))
            .unwrap_or(0.0);
        Some(Self {
            texture: number(&["index"]).filter(|index| *index >= 0.0)? as usize,
            set: set.max(0.0) as u32,
            transform: UvTransform {
                offset: pair("offset", [0.0; 2]).unwrap_or([0.0; 2]),
                rotation: number(&["extensions", "KHR_texture_transform", "rotation"]).unwrap_or(0.0) as f32,
                scale: pair("scale", [1.0; 2]).unwrap_or([1.0; 2]),
            },
        })
    }
}

/// The place of an image's look-up by the drawn vertices' coordinates; `None` for a missing image or a third set.
fn map(document: &Document, sets: &MaterialMaps, reference: Reference) -> Option<Map> {
    let (image, wrap) = image_of(document, reference.texture)?;
    let (set, matrix) = look_up(sets, reference)?;
    Some(Map {
        image,
        wrap,
        set,
        transform: rows(matrix),
    })
}

/// The set of a reference's texture coordinates among the drawn vertices', and the matrix that takes (u, v, 1) to the
/// place in the image; `None` for a third set.
pub(super) fn look_up(sets: &MaterialMaps, reference: Reference) -> Option<(UvSet, Mat3)> {
    let own = reference.transform.matrix();
    let base = sets.base_transform.matrix();
    if reference.set == sets.base_set && base.determinant().abs() >= 1e-12 {
        // Equal transforms cancel to the last bit.
        let is_same = reference.transform == sets.base_transform;
        let is_plain = sets.base_transform == UvTransform::IDENTITY;
        let relative = match (is_same, is_plain) {
            (true, _) => Mat3::IDENTITY,
            (false, true) => own,
            (false, false) => own * base.inverse(),
        };
        Some((UvSet::Base, relative))
    } else {
        (sets.second_set == Some(reference.set)).then_some((UvSet::Second, own))
    }
}

/// The rows of a matrix that multiply (u, v, 1).
pub(super) fn rows(matrix: Mat3) -> [[f32; 3]; 2] {
    let rows = matrix.transpose();
    [rows.x_axis.to_array(), rows.y_axis.to_array()]
}
