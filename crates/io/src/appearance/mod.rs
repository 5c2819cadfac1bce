//! How a scene looks: attributes of the drawn vertices, materials and images.

pub(crate) mod colour;

use std::ops::Range;

use crate::Bytes;

/// What a renderer or another file format needs besides positions and triangles; made on request, never edited.
///
/// Each attribute is `None` when no drawn vertex has it, and else has one entry per drawn vertex.
#[derive(Clone, Debug, Default)]
pub struct Appearance {
    /// World-space normals of the rest shape; zero where a vertex has none. f32: display and files only.
    pub normals: Option<Vec<[f32; 3]>>,
    /// Texture coordinates of the base colour image, v down (glTF's way), the material's transform applied.
    pub uvs: Option<Vec<[f32; 2]>>,
    /// Texture coordinates, as stored, of the second set that a material uses, if any does.
    pub second_uvs: Option<Vec<[f32; 2]>>,
    /// Linear-light vertex colours, 0 to 65535; white where a vertex has none. 16 bits tell all 256 sRGB greys apart.
    pub colours: Option<Vec<[u16; 4]>>,
    /// Ranges of drawn vertices, in order, whose triangles are shown flat: they have no normals, and the file says so.
    pub flat: Vec<Range<u32>>,
    /// Runs of `Drawn::triangles` that share node and material, in order, covering all of them.
    pub groups: Vec<Group>,
    /// Materials; every group's index is in range.
    pub materials: Vec<Material>,
    /// Images; every material's index is in range.
    pub images: Vec<Image>,
}

impl Appearance {
    /// The vertex colours as sRGB with a linear alpha, 0 to 255.
    pub fn srgb_colours(&self) -> Option<Vec<[u8; 4]>> {
        let srgb = colour::SrgbBytes::new();
        let colours = self.colours.as_ref()?.iter();
        Some(colours.map(|&colour| srgb.of_linear(colour)).collect())
    }

    /// One plain material for all triangles: what a file without materials looks like.
    pub(crate) fn plain(triangle_count: u32) -> Self {
        Self {
            groups: vec![Group {
                triangles: 0..triangle_count,
                material: 0,
                node_name: String::new(),
            }],
            materials: vec![Material::plain("")],
            ..Self::default()
        }
    }
}

/// The ranges of numbers for which `is_in` is true.
pub(crate) fn ranges(is_in: impl Iterator<Item = bool>) -> Vec<Range<u32>> {
    let mut ranges: Vec<Range<u32>> = Vec::new();
    for (number, _) in (0..).zip(is_in).filter(|(_, is_in)| *is_in) {
        match ranges.last_mut() {
            Some(last) if last.end == number => last.end += 1,
            _ => ranges.push(number..number + 1),
        }
    }
    ranges
}

/// A run of triangles that share node and material.
#[derive(Clone, PartialEq, Debug)]
pub struct Group {
    /// Range of `Drawn::triangles`.
    pub triangles: Range<u32>,
    /// Index into [`Appearance::materials`].
    pub material: usize,
    /// The node's, object's or group's name; empty where the file gives none.
    pub node_name: String,
}

/// The part of a material that is drawn.
#[derive(Clone, PartialEq, Debug)]
pub struct Material {
    /// The file's name for it; empty where it gives none.
    pub name: String,
    /// Linear-light base colour factor, 0 to 1.
    pub base_colour: [f32; 4],
    /// Index into [`Appearance::images`].
    pub base_colour_image: Option<usize>,
    /// 0 (dielectric) to 1 (metal).
    pub metallic: f32,
    /// 0 (mirror) to 1 (matt).
    pub roughness: f32,
    /// Its green multiplies the roughness, its blue the metallic share; not encoded.
    pub metallic_roughness_map: Option<Map>,
    /// Normals in tangent space, x along u and y against v; not encoded.
    pub normal_map: Option<Map>,
    /// What the map's x and y are multiplied by.
    pub normal_scale: f32,
    /// Its red is the share of ambient light that arrives; not encoded.
    pub occlusion_map: Option<Map>,
    /// How much of the map's darkening is used, 0 to 1.
    pub occlusion_strength: f32,
    /// Light of its own, linear; above 1 with KHR_materials_emissive_strength.
    pub emissive: [f32; 3],
    /// Multiplies it; sRGB.
    pub emissive_map: Option<Map>,
    /// Whether light plays a part.
    pub lighting: Lighting,
    /// Whether back faces are drawn.
    pub double_sided: bool,
    /// What the base colour's alpha means.
    pub alpha: AlphaMode,
    /// How texture coordinates beyond 0 to 1 are taken along u and v.
    pub wrap: [Wrap; 2],
}

impl Material {
    /// A material of faces for which a scan format names nothing else. Such formats know no culling, so both sides are
    /// drawn.
    pub(crate) fn plain(name: &str) -> Self {
        Self {
            name: name.to_owned(),
            double_sided: true,
            ..Self::default()
        }
    }
}

impl Default for Material {
    fn default() -> Self {
        Self {
            name: String::new(),
            base_colour: [1.0; 4],
            base_colour_image: None,
            metallic: 0.0,
            roughness: 1.0,
            metallic_roughness_map: None,
            normal_map: None,
            normal_scale: 1.0,
            occlusion_map: None,
            occlusion_strength: 1.0,
            emissive: [0.0; 3],
            emissive_map: None,
            lighting: Lighting::Lit,
            double_sided: false,
            alpha: AlphaMode::Opaque,
            wrap: [Wrap::Repeat; 2],
        }
    }
}

/// An image other than the base colour's, and how it is mapped onto the surface.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Map {
    /// Index into [`Appearance::images`].
    pub image: usize,
    /// How texture coordinates beyond 0 to 1 are taken along u and v.
    pub wrap: [Wrap; 2],
    /// Which texture coordinates are taken.
    pub set: UvSet,
    /// Where the image is looked up: rows that multiply (u, v, 1).
    pub transform: [[f32; 3]; 2],
}

/// Which texture coordinates an image takes.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum UvSet {
    /// [`Appearance::uvs`], those of the base colour.
    Base,
    /// [`Appearance::second_uvs`].
    Second,
}

/// Whether light plays a part in how a material looks.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub enum Lighting {
    /// It does.
    #[default]
    Lit,
    /// The base colour is shown as it is (KHR_materials_unlit), as photographed scans often want.
    Unlit,
}

/// What alpha means.
#[derive(Clone, Copy, PartialEq, Debug)]
pub enum AlphaMode {
    /// Nothing: the surface is opaque.
    Opaque,
    /// Drawn where alpha is at least this cut-off.
    Mask(f32),
    /// Blended.
    Blend,
}

/// How an image continues beyond its edges.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub enum Wrap {
    /// Its edge goes on.
    ClampToEdge,
    /// It is mirrored at each edge.
    MirroredRepeat,
    /// It repeats.
    Repeat,
}

/// An image as stored.
#[derive(Clone, Debug)]
pub struct Image {
    /// The file's name for it, or its neighbour's; empty where there is neither.
    pub name: String,
    /// PNG, JPEG or whatever else the file holds; empty where the neighbour is missing.
    pub encoded: Bytes,
    /// Where it was read from.
    pub origin: Origin,
}

/// Where an image was read from.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Origin {
    /// The file itself, or its folder.
    Inside,
    /// A place outside the file's folder, which a file from a stranger may point at.
    Outside,
}
