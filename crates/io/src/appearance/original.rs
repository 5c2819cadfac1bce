//! A glTF's material as written, with the members that are not drawn.

use std::collections::BTreeSet;

use serde_json::Value;

use super::uv_set::UvSet;

/// A glTF's material as written: its extensions, its extras, and the textures that it names.
#[derive(Clone, PartialEq, Debug)]
pub struct OriginalMaterial {
    /// The material's JSON. The `index` of a texture reference is a place in `textures`.
    pub(crate) value: Value,
    /// The textures, one for each reference.
    pub(crate) textures: Vec<OriginalTexture>,
    /// The extensions that the file requires.
    pub(crate) required: BTreeSet<String>,
}

/// A texture that a material names.
#[derive(Clone, PartialEq, Debug)]
pub(crate) struct OriginalTexture {
    /// The texture's JSON, without its image and sampler.
    pub value: Value,
    /// The sampler's JSON.
    pub sampler: Option<Value>,
    /// Indices into [`Appearance::images`](crate::Appearance::images), each with the extension that names it; the plain
    /// image has none.
    pub images: Vec<(Option<String>, usize)>,
    /// The set of texture coordinates.
    pub set: UvSet,
    /// The place of the look-up in the image: rows that multiply (u, v, 1). `None` if the reference's own transform is
    /// right for the drawn vertices' coordinates.
    pub transform: Option<[[f32; 3]; 2]>,
}

impl OriginalMaterial {
    /// The indices of its images, to be changed when images are renumbered.
    pub fn images_mut(&mut self) -> impl Iterator<Item = &mut usize> {
        let textures = self.textures.iter_mut();
        textures.flat_map(|texture| texture.images.iter_mut().map(|(_, image)| image))
    }

    /// True if an object's member with this name and value refers to a texture.
    pub(crate) fn is_texture(name: &str, value: &Value) -> bool {
        name.ends_with("Texture") && value.get("index").is_some_and(Value::is_u64)
    }
}
