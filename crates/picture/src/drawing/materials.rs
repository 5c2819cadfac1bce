//! A file's materials and images, converted for the renderer.
//!
//! Decoding images takes longer than everything else in opening a file. So a file is shown at once with its materials
//! without textures, and with textures after another thread has decoded the images.

use std::collections::HashMap;

use pliant_io::{Appearance, DecodedImage, IMAGE_BYTES, Image, decode_images, quoted};
use pliant_mesh::{Cancel, Cancelled};
use pliant_render::{
    AlphaMode, Encoding, Lighting, Map, Material, Materials, RenderError, Renderer, TextureData, UvSet, Wrap,
};

/// A file's materials, and the encoded images that they use.
#[derive(Debug)]
pub struct EncodedMaterials {
    materials: Vec<Material>,
    /// The images to show: number of the file's image, and the encoding of its bytes.
    wanted: Vec<(usize, Encoding)>,
    images: Vec<Image>,
    /// The memory that all images together may take during decoding.
    budget: u64,
}

/// A file's materials with decoded images.
#[derive(Debug)]
pub struct DecodedMaterials {
    materials: Vec<Material>,
    images: Vec<DecodedImage>,
    /// The number of each texture's image, and the encoding of its bytes.
    textures: Vec<(usize, Encoding)>,
    /// The parts that can't be shown, a sentence each.
    pub notes: Vec<String>,
}

impl EncodedMaterials {
    /// Converts a file's materials and takes its images.
    pub fn new(appearance: &mut Appearance) -> Self {
        let mut encoded = Self {
            materials: Vec::new(),
            wanted: Vec::new(),
            images: std::mem::take(&mut appearance.images),
            budget: IMAGE_BYTES,
        };
        // Images of the same bytes are one.
        let mut image_at = HashMap::new();
        let images = encoded.images.iter().enumerate();
        let first_alike: Vec<usize> = images
            .map(|(number, image)| *image_at.entry(image.encoded.place()).or_insert(number))
            .collect();
        let mut texture_of: HashMap<(usize, Encoding), usize> = HashMap::new();
        let mut texture = |image: usize, encoding: Encoding| {
            let image = first_alike.get(image).copied().unwrap_or(image);
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

    /// Returns true if any material has an image.
    pub fn has_images(&self) -> bool {
        !self.wanted.is_empty()
    }

    /// The same with images that together take at most this many bytes during decoding.
    #[must_use]
    pub fn within(self, budget: u64) -> Self {
        Self { budget, ..self }
    }

    /// Decodes the images, in parallel as far as the budget allows. Returns a sentence for each image that is shown
    /// smaller than stored, or left out because it can't be decoded.
    ///
    /// # Errors
    /// [`Cancelled`] soon after `cancel` is raised.
    pub fn decode(&self, cancel: &Cancel) -> Result<DecodedMaterials, Cancelled> {
        let mut numbers: Vec<usize> = self.wanted.iter().map(|&(image, _)| image).collect();
        numbers.sort_unstable();
        numbers.dedup();
        let encoded: Vec<&[u8]> = (numbers.iter())
            .map(|&number| self.images.get(number).map_or(&[][..], |image| &*image.encoded))
            .collect();
        let decoded = decode_images(&encoded, self.budget, cancel)?;
        let (mut images, mut notes): (Vec<DecodedImage>, Vec<String>) = (Vec::new(), Vec::new());
        let mut place_of: HashMap<usize, usize> = HashMap::new();
        for (&number, result) in numbers.iter().zip(decoded) {
            let name = self
                .images
                .get(number)
                .map_or(String::new(), |image| quoted(&image.name));
            let sentence = match result {
                Ok(image) => {
                    let sentence = shrunk_note(&name, &image, self.budget);
                    place_of.insert(number, images.len());
                    images.push(image);
                    sentence
                }
                Err(error) => Some(format!("the image {name} is not shown: {error}")),
            };
            notes.extend(sentence.filter(|sentence| !notes.contains(sentence)));
            if notes.len() > MOST_NOTES {
                notes.truncate(MOST_NOTES);
            }
        }
        let (mut textures, mut texture_of) = (Vec::new(), Vec::new());
        for (image, encoding) in &self.wanted {
            texture_of.push(place_of.get(image).map(|&place| {
                textures.push((place, *encoding));
                textures.len() - 1
            }));
        }
        let with_number = |map: Map| {
            let texture = texture_of.get(map.texture).copied().flatten()?;
            Some(Map { texture, ..map })
        };
        Ok(DecodedMaterials {
            materials: self
                .materials
                .iter()
                .map(|material| with_maps(material, with_number))
                .collect(),
            images,
            textures,
            notes,
        })
    }
}

/// The largest number of sentences about images.
const MOST_NOTES: usize = 12;

/// A sentence about an image that is smaller than stored.
fn shrunk_note(name: &str, image: &DecodedImage, budget: u64) -> Option<String> {
    let [width, height] = image.stored_size;
    let shown = &image.pixels;
    (shown.width < width || shown.height < height).then(|| {
        format!(
            "the image {name} of {width} by {height} pixels is shown with {} by {}, so that all images together fit \
             {} MiB",
            shown.width,
            shown.height,
            budget >> 20
        )
    })
}

impl DecodedMaterials {
    /// Uploads the images for the file's surface.
    ///
    /// # Errors
    /// As [`Materials::new`].
    pub fn upload(&self, renderer: &Renderer) -> Result<Materials, RenderError> {
        let textures: Vec<TextureData<'_>> = self
            .textures
            .iter()
            .map(|&(image, encoding)| {
                let pixels = &self.images[image].pixels;
                TextureData {
                    width: pixels.width,
                    height: pixels.height,
                    rgba: &pixels.pixels,
                    encoding,
                }
            })
            .collect();
        Materials::new(renderer.gpu(), &self.materials, &textures)
    }
}

/// The albedo of a surface without a colour, linear: as bright as clay. White under light would hide the form.
const BARE_ALBEDO: [f32; 4] = [0.6, 0.6, 0.6, 1.0];

/// Gives triangles without a material and without colours a grey material: `triangles` is the number of drawn ones.
pub fn dim_bare(appearance: &mut Appearance, triangles: u32) {
    if appearance.colours.is_some() {
        return;
    }
    if appearance.materials.is_empty() {
        appearance.materials.push(pliant_io::Material::default());
        appearance.groups = vec![pliant_io::Group {
            triangles: 0..triangles,
            material: 0,
            node_name: String::new(),
        }];
    }
    for material in &mut appearance.materials {
        let (metallic, roughness, double_sided) = (material.metallic, material.roughness, material.double_sided);
        let is_bare = *material
            == pliant_io::Material {
                metallic,
                roughness,
                double_sided,
                ..pliant_io::Material::default()
            };
        if is_bare {
            material.base_colour = BARE_ALBEDO;
            material.metallic = 0.0;
        }
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
