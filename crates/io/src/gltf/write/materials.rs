//! The materials of a new glTF.

use serde_json::{Value, json};

use super::buffer::Built;
use super::looks::{Looks, PLAIN};
use super::maps;
use crate::appearance::{AlphaMode, Material};
use crate::convert::NewMesh;

impl Looks {
    pub(super) fn material(
        &mut self,
        out: &mut Built,
        mesh: &NewMesh<'_>,
        number: usize,
        material: &Material,
    ) -> usize {
        if let Some(&known) = self.material_of.get(&number) {
            return known;
        }
        let value = match &material.original {
            Some(original) => self.original(out, mesh, original),
            None => self.drawn_members(out, mesh, material),
        };
        self.materials.push(value);
        self.material_of.insert(number, self.materials.len() - 1);
        self.materials.len() - 1
    }

    /// The JSON of the members that are drawn.
    fn drawn_members(&mut self, out: &mut Built, mesh: &NewMesh<'_>, material: &Material) -> Value {
        let unit = |number: f32| {
            f64::from(if number.is_finite() {
                number.clamp(0.0, 1.0)
            } else {
                1.0
            })
        };
        let mut surface = json!({
            "baseColorFactor": material.base_colour.map(unit),
            "metallicFactor": unit(material.metallic),
            "roughnessFactor": unit(material.roughness),
        });
        // A texture without texture coordinates is an error in glTF.
        let image = material.base_colour_image.filter(|_| mesh.appearance.uvs.is_some());
        if let Some(image) = image.and_then(|image| self.image(out, mesh, image, &PLAIN)) {
            surface["baseColorTexture"] = json!({ "index": self.texture(image, material.wrap) });
        }
        let mut value = json!({ "pbrMetallicRoughness": surface });
        if !material.name.is_empty() {
            value["name"] = material.name.as_str().into();
        }
        if material.double_sided {
            value["doubleSided"] = true.into();
        }
        match material.alpha {
            AlphaMode::Opaque => {}
            AlphaMode::Blend => value["alphaMode"] = "BLEND".into(),
            AlphaMode::Mask(cutoff) => {
                value["alphaMode"] = "MASK".into();
                value["alphaCutoff"] = unit(cutoff).into();
            }
        }
        let extensions = maps::dress(self, out, mesh, material, &mut value);
        self.extensions.extend(extensions.into_iter().map(str::to_owned));
        value
    }
}
