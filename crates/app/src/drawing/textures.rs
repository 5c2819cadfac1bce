//! A file's base-colour images, decoded.

use std::collections::HashMap;

use pliant_io::{Appearance, Rgba8, decode_image};
use pliant_render::{TextureData, Wrap};

/// Decoded images, each with the wrap of the materials that use it.
#[derive(Debug)]
pub struct Textures {
    images: Vec<(Rgba8, [Wrap; 2])>,
    of_material: Vec<Option<usize>>,
}

impl Textures {
    /// Decodes every image that a material's base colour names, once; an image that fails is told in a sentence.
    pub fn decode(appearance: &Appearance) -> (Self, Vec<String>) {
        let mut textures = Self {
            images: Vec::new(),
            of_material: Vec::new(),
        };
        let mut notes = Vec::new();
        let mut decoded: HashMap<(usize, [Wrap; 2]), Option<usize>> = HashMap::new();
        for material in &appearance.materials {
            let Some(image) = material.base_colour_image else {
                textures.of_material.push(None);
                continue;
            };
            let wrap = material.wrap.map(|mode| match mode {
                pliant_io::Wrap::Repeat => Wrap::Repeat,
                pliant_io::Wrap::MirroredRepeat => Wrap::Mirror,
                pliant_io::Wrap::ClampToEdge => Wrap::Clamp,
            });
            let texture = *decoded.entry((image, wrap)).or_insert_with(|| {
                let source = appearance.images.get(image)?;
                match decode_image(&source.encoded) {
                    Ok(pixels) => {
                        textures.images.push((pixels, wrap));
                        Some(textures.images.len() - 1)
                    }
                    Err(error) => {
                        notes.push(format!("the image {} is not shown: {error}", source.name));
                        None
                    }
                }
            });
            textures.of_material.push(texture);
        }
        (textures, notes)
    }

    /// The texture of a material.
    pub fn of_material(&self, material: usize) -> Option<usize> {
        self.of_material.get(material).copied().flatten()
    }

    /// What the renderer takes.
    pub fn data(&self) -> Vec<TextureData<'_>> {
        self.images
            .iter()
            .map(|(pixels, wrap)| TextureData {
                width: pixels.width,
                height: pixels.height,
                rgba: &pixels.pixels,
                wrap: *wrap,
            })
            .collect()
    }
}
