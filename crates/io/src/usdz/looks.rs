//! Materials: the constants of `UsdPreviewSurface`, and the image of its base colour.

use std::collections::HashMap;

use super::layer::{Layer, Prim};
use super::values::{numbers, word};
use crate::appearance::{AlphaMode, Appearance, Image, Material, Origin, Wrap};
use crate::archive::Archive;
use crate::quote::quoted;

/// The materials and images that were found so far.
pub(super) struct Looks<'a> {
    text: &'a [u8],
    layer: &'a Layer,
    archive: Archive<'a>,
    /// The layer's folder in the archive, with its `/`.
    folder: String,
    materials: HashMap<String, usize>,
    images: HashMap<String, usize>,
    /// The appearance with these materials and images; the first material is the plain one.
    pub look: Appearance,
    pub notes: Vec<String>,
}

impl<'a> Looks<'a> {
    /// None yet.
    pub fn new(text: &'a [u8], layer: &'a Layer, archive: Archive<'a>, name: &str) -> Self {
        Self {
            text,
            layer,
            archive,
            folder: name
                .rsplit_once('/')
                .map_or(String::new(), |(folder, _)| format!("{folder}/")),
            materials: HashMap::new(),
            images: HashMap::new(),
            look: Appearance {
                materials: vec![Material::plain("")],
                ..Appearance::default()
            },
            notes: Vec::new(),
        }
    }

    /// The number of the material to which a prim is bound, by itself or by a prim above it.
    ///
    /// # Errors
    /// A value that can't be read.
    pub fn material_of(&mut self, prim: usize) -> Result<usize, String> {
        let mut at = Some(prim);
        while let Some(prim) = at {
            let prim = &self.layer.prims[prim];
            if let Some(path) = word(self.text, prim, "material:binding")? {
                return self.material(&path);
            }
            at = prim.parent;
        }
        Ok(0)
    }

    fn material(&mut self, path: &str) -> Result<usize, String> {
        if let Some(&known) = self.materials.get(path) {
            return Ok(known);
        }
        let found = match self.layer.prim(path) {
            Some(prim) => Some(self.read(&self.layer.prims[prim])?),
            None => None,
        };
        let number = found.map_or(0, |material| {
            self.look.materials.push(material);
            self.look.materials.len() - 1
        });
        self.materials.insert(path.to_owned(), number);
        Ok(number)
    }

    fn read(&mut self, prim: &Prim) -> Result<Material, String> {
        let mut material = Material::plain(&prim.name);
        let Some(shader) = self.connected(prim, "outputs:surface")? else {
            return Ok(material);
        };
        let text = self.text;
        let constant = |name: &str| -> Result<Vec<f64>, String> {
            let property = shader.properties.get(name);
            property.map_or(Ok(Vec::new()), |property| numbers(text, &property.value))
        };
        if let Some(&[red, green, blue]) = constant("inputs:diffuseColor")?.first_chunk() {
            material.base_colour = [red as f32, green as f32, blue as f32, 1.0];
        }
        if let Some(&opacity) = constant("inputs:opacity")?.first() {
            material.base_colour[3] = opacity as f32;
        }
        if material.base_colour[3] < 1.0 {
            material.alpha = AlphaMode::Blend;
        }
        if let Some(&metallic) = constant("inputs:metallic")?.first() {
            material.metallic = metallic as f32;
        }
        // The specification's default is 0.5.
        material.roughness = constant("inputs:roughness")?
            .first()
            .map_or(0.5, |&roughness| roughness as f32);
        if let Some(texture) = self.connected(shader, "inputs:diffuseColor")?
            && let Some(file) = word(text, texture, "inputs:file")?
        {
            for (wrap, name) in material.wrap.iter_mut().zip(["inputs:wrapS", "inputs:wrapT"]) {
                *wrap = match word(text, texture, name)?.as_deref() {
                    Some("mirror") => Wrap::MirroredRepeat,
                    Some("clamp" | "black") => Wrap::ClampToEdge,
                    _ => Wrap::Repeat,
                };
            }
            if let Some(scale) = texture.properties.get("inputs:scale")
                && let Some(&[red, green, blue]) = numbers(text, &scale.value)?.first_chunk()
            {
                material.base_colour = [red as f32, green as f32, blue as f32, material.base_colour[3]];
            }
            material.base_colour_image = Some(self.image(&file));
        }
        Ok(material)
    }

    /// The prim to whose output an input is connected.
    fn connected(&self, prim: &Prim, name: &str) -> Result<Option<&'a Prim>, String> {
        let path = word(self.text, prim, &format!("{name}.connect"))?;
        let found = path.and_then(|path| self.layer.prim(&path));
        Ok(found.map(|prim| &self.layer.prims[prim]))
    }

    /// The number of an image of the archive.
    fn image(&mut self, file: &str) -> usize {
        if let Some(&known) = self.images.get(file) {
            return known;
        }
        let path = format!("{}{}", self.folder, file.trim_start_matches("./"));
        let encoded = match self.archive.part(&path) {
            Ok(part) => part.bytes.into(),
            Err(_) => {
                let note = format!(
                    "The image {} is missing, so its surface is drawn without it.",
                    quoted(file)
                );
                self.notes.push(note);
                Vec::new().into()
            }
        };
        let images = &mut self.look.images;
        images.push(Image {
            name: file.rsplit('/').next().unwrap_or(file).to_owned(),
            encoded,
            origin: Origin::Inside,
        });
        self.images.insert(file.to_owned(), images.len() - 1);
        images.len() - 1
    }
}
