//! A file's materials and images, converted for the renderer.
//!
//! Decoding images takes longer than everything else in opening a file. So a file is shown at once with its materials
//! without textures, and with textures when another thread has decoded the images.

use std::collections::HashMap;

use pliant_io::{Appearance, Image, Rgba8, decode_image};
use pliant_render::{
    AlphaMode, Encoding, Lighting, Map, Material, Materials, RenderError, Renderer, TextureData, UvSet, Wrap,
};
use rayon::prelude::*;

/// A file's materials, and the encoded images that they use.
#[derive(Debug)]
pub struct EncodedMaterials {
    materials: Vec<Material>,
    /// The images to decode: index in the file, and encoding of the bytes.
    wanted: Vec<(usize, Encoding)>,
    images: Vec<Image>,
}

/// A file's materials with decoded images.
#[derive(Debug)]
pub struct DecodedMaterials {
    materials: Vec<Material>,
    textures: Vec<(Rgba8, Encoding)>,
    /// One sentence for each image that can't be shown.
    pub notes: Vec<String>,
}

impl EncodedMaterials {
    /// Converts a file's materials and takes its images.
    pub fn new(appearance: &mut Appearance) -> Self {
        let mut encoded = Self {
            materials: Vec::new(),
            wanted: Vec::new(),
            images: std::mem::take(&mut appearance.images),
        };
        let mut texture_of: HashMap<(usize, Encoding), usize> = HashMap::new();
        let mut texture = |image: usize, encoding: Encoding| {
            *texture_of.entry((image, encoding)).or_insert_with(|| {
                encoded.wanted.push((image, encoding));
                encoded.wanted.len() - 1
            })
        };
        for material in &appearance.materials {
            let mut map = |map: Option<pliant_io::Map>, encoding: Encoding| {
                map.map(|map| Map {
                    texture: texture(map.image, encoding),
                    wrap: map.wrap.map(wrap),
                    set: match map.set {
                        pliant_io::UvSet::Base => UvSet::First,
                        pliant_io::UvSet::Second => UvSet::Second,
                    },
                    transform: map.transform,
                })
            };
            let base = material.base_colour_image.map(|image| pliant_io::Map {
                image,
                wrap: material.wrap,
                set: pliant_io::UvSet::Base,
                transform: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]],
            });
            encoded.materials.push(Material {
                base_colour: material.base_colour,
                base_colour_map: map(base, Encoding::Srgb),
                metallic: material.metallic,
                roughness: material.roughness,
                metallic_roughness_map: map(material.metallic_roughness_map, Encoding::Linear),
                normal_map: map(material.normal_map, Encoding::Linear),
                normal_scale: material.normal_scale,
                occlusion_map: map(material.occlusion_map, Encoding::Linear),
                occlusion_strength: material.occlusion_strength,
                emissive: material.emissive,
                emissive_map: map(material.emissive_map, Encoding::Srgb),
                lighting: match material.lighting {
                    pliant_io::Lighting::Lit => Lighting::Lit,
                    pliant_io::Lighting::Unlit => Lighting::Unlit,
                },
                alpha: match material.alpha {
                    pliant_io::AlphaMode::Opaque => AlphaMode::Opaque,
                    pliant_io::AlphaMode::Mask(cutoff) => AlphaMode::Mask { cutoff },
                    pliant_io::AlphaMode::Blend => AlphaMode::Blend,
                },
                double_sided: material.double_sided,
            });
        }
        encoded
    }

    /// The materials without their images.
    pub fn without_images(&self) -> Vec<Material> {
        self.materials
            .iter()
            .map(|material| with_maps(material, |_| None))
            .collect()
    }

    /// Whether any material has an image.
    pub fn has_images(&self) -> bool {
        !self.wanted.is_empty()
    }

    /// Decodes the images in parallel. Images that can't be decoded are left out and reported in the notes.
    pub fn decode(&self) -> DecodedMaterials {
        let decoded: Vec<Result<Rgba8, String>> = self
            .wanted
            .par_iter()
            .map(|&(image, _)| {
                let Some(source) = self.images.get(image) else {
                    return Err("an image is missing".to_owned());
                };
                decode_image(&source.encoded)
                    .map_err(|error| format!("the image {} is not shown: {error}", source.name))
            })
            .collect();
        let (mut textures, mut notes, mut numbers) = (Vec::new(), Vec::new(), Vec::new());
        for (result, &(_, encoding)) in decoded.into_iter().zip(&self.wanted) {
            match result {
                Ok(pixels) => {
                    numbers.push(Some(textures.len()));
                    textures.push((pixels, encoding));
                }
                Err(sentence) => {
                    numbers.push(None);
                    if !notes.contains(&sentence) {
                        notes.push(sentence);
                    }
                }
            }
        }
        let with_number = |map: Map| {
            let texture = numbers.get(map.texture).copied().flatten()?;
            Some(Map { texture, ..map })
        };
        DecodedMaterials {
            materials: self
                .materials
                .iter()
                .map(|material| with_maps(material, with_number))
                .collect(),
            textures,
            notes,
        }
    }
}

impl DecodedMaterials {
    /// Uploads the materials and images, for [`Surface::set_materials`](pliant_render::Surface::set_materials).
    ///
    /// # Errors
    /// As [`Materials::new`].
    pub fn upload(&self, renderer: &Renderer) -> Result<Materials, RenderError> {
        let textures: Vec<TextureData<'_>> = self
            .textures
            .iter()
            .map(|(pixels, encoding)| TextureData {
                width: pixels.width,
                height: pixels.height,
                rgba: &pixels.pixels,
                encoding: *encoding,
            })
            .collect();
        Materials::new(renderer, &self.materials, &textures)
    }
}

/// The material with `map` applied to each of its maps; `None` removes a map.
fn with_maps(material: &Material, map: impl Fn(Map) -> Option<Map>) -> Material {
    Material {
        base_colour_map: material.base_colour_map.and_then(&map),
        metallic_roughness_map: material.metallic_roughness_map.and_then(&map),
        normal_map: material.normal_map.and_then(&map),
        occlusion_map: material.occlusion_map.and_then(&map),
        emissive_map: material.emissive_map.and_then(&map),
        ..*material
    }
}

fn wrap(mode: pliant_io::Wrap) -> Wrap {
    match mode {
        pliant_io::Wrap::Repeat => Wrap::Repeat,
        pliant_io::Wrap::MirroredRepeat => Wrap::Mirror,
        pliant_io::Wrap::ClampToEdge => Wrap::Clamp,
    }
}
