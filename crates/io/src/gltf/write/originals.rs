//! Materials of another glTF, with all of their members.

use serde_json::Value;

use super::buffer::Built;
use super::looks::{Looks, PLAIN};
use super::maps::{place, set_number};
use crate::appearance::original::{OriginalMaterial, OriginalTexture};
use crate::convert::NewMesh;

impl Looks {
    /// The JSON of a material as its file has it, with the numbers of the written textures.
    pub(super) fn original(&mut self, out: &mut Built, mesh: &NewMesh<'_>, original: &OriginalMaterial) -> Value {
        let mut value = original.value.clone();
        self.fill_in(out, mesh, original, &mut value);
        value
    }

    /// Numbers the texture references in an object, and notes its extensions.
    fn fill_in(&mut self, out: &mut Built, mesh: &NewMesh<'_>, original: &OriginalMaterial, value: &mut Value) {
        let Some(members) = value.as_object_mut() else { return };
        members.retain(|name, member| {
            if OriginalMaterial::is_texture(name, member) {
                return self.refer(out, mesh, original, member).is_some();
            }
            if name != "extras" {
                self.fill_in(out, mesh, original, member);
            }
            true
        });
        self.note_extensions(original, value);
    }

    /// Notes the extensions of an object as used, and as required if the file requires them.
    fn note_extensions(&mut self, original: &OriginalMaterial, value: &Value) {
        let extensions = value.get("extensions").and_then(Value::as_object);
        for name in extensions.into_iter().flat_map(serde_json::Map::keys) {
            self.extensions.insert(name.clone());
            if original.required.contains(name) {
                self.required.insert(name.clone());
            }
        }
    }

    /// Fills in a reference to a texture; `None` if the mesh lacks its texture coordinates or its image.
    fn refer(
        &mut self,
        out: &mut Built,
        mesh: &NewMesh<'_>,
        original: &OriginalMaterial,
        reference: &mut Value,
    ) -> Option<()> {
        let number = reference.get("index").and_then(Value::as_u64)?;
        let texture = original.textures.get(number as usize)?;
        let set = set_number(mesh, texture.set)?;
        let written = self.original_texture(out, mesh, original, texture)?;
        reference["index"] = written.into();
        if set > 0 {
            reference["texCoord"] = set.into();
        }
        if let Some(rows) = texture.transform {
            place(out, reference, rows)?;
        }
        self.note_extensions(original, reference);
        Some(())
    }

    /// The written texture; `None` if none of its images can be written.
    fn original_texture(
        &mut self,
        out: &mut Built,
        mesh: &NewMesh<'_>,
        original: &OriginalMaterial,
        texture: &OriginalTexture,
    ) -> Option<usize> {
        let mut value = texture.value.clone();
        let mut has_image = false;
        for (extension, image) in &texture.images {
            let types: &[&str] = match extension.as_deref() {
                None => &PLAIN,
                Some("EXT_texture_webp") => &["image/webp"],
                Some(_) => &["image/ktx2"],
            };
            let Some(written) = self.image(out, mesh, *image, types) else {
                continue;
            };
            has_image = true;
            match extension {
                None => value["source"] = written.into(),
                Some(extension) => value["extensions"][extension]["source"] = written.into(),
            }
        }
        // An extension without an image names nothing.
        if let Some(extensions) = value.get_mut("extensions").and_then(Value::as_object_mut) {
            extensions.retain(|_, extension| extension.get("source").is_some());
            if extensions.is_empty() {
                value.as_object_mut()?.remove("extensions");
            }
        }
        if !has_image {
            return None;
        }
        self.note_extensions(original, &value);
        Some(self.texture_as_written(value, texture.sampler.as_ref()))
    }
}
