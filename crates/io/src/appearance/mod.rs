//! The appearance of a scene: attributes of the drawn vertices, materials and images.

pub(crate) mod colour;
mod obj_names;
pub(crate) mod original;
mod uv_set;

use std::ops::Range;

use crate::Bytes;
pub use obj_names::ObjNames;
pub use original::OriginalMaterial;
pub use uv_set::UvSet;

/// The data that a renderer or another file format needs besides positions and triangles; made on request, never
/// edited.
///
/// Each attribute is `None` if no drawn vertex has it, and otherwise has one entry per drawn vertex.
#[derive(Clone, Debug, Default)]
pub struct Appearance {
    /// World-space normals of the rest shape; zero for a vertex without one. f32: display and files only.
    pub normals: Option<Vec<[f32; 3]>>,
    /// Texture coordinates of the base colour image, v down (glTF's way), the material's transform applied.
    pub uvs: Option<Vec<[f32; 2]>>,
    /// Texture coordinates, as stored, of the second set that a material uses, if any does.
    pub second_uvs: Option<Vec<[f32; 2]>>,
    /// Linear-light vertex colours, 0 to 65535; white for a vertex without one. 16 bits distinguish all 256 sRGB greys.
    pub colours: Option<Vec<[u16; 4]>>,
    /// Ranges of drawn vertices, in order, whose triangles are shown flat: they have no normals, and the file says so.
    pub flat: Vec<Range<u32>>,
    /// Runs of `Drawn::triangles` that share node and material, in order, covering all of them.
    pub groups: Vec<Group>,
    /// Materials; every group's index is in range.
    pub materials: Vec<Material>,
    /// Images; every material's index is in range.
    pub images: Vec<Image>,
    /// The names that a new OBJ file gets again; `None` for files of other formats, and if nobody asked for them.
    pub obj: Option<ObjNames>,
}

impl Appearance {
    /// The vertex colours as sRGB with a linear alpha, 0 to 255.
    pub fn srgb_colours(&self) -> Option<Vec<[u8; 4]>> {
        let srgb = colour::SrgbBytes::new();
        let colours = self.colours.as_ref()?.iter();
        Some(colours.map(|&colour| srgb.of_linear(colour)).collect())
    }

    /// One plain material for all triangles, for a file without materials.
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
    /// The node's, object's or group's name; empty if the file gives none.
    pub node_name: String,
}

/// The part of a material that is drawn.
#[derive(Clone, PartialEq, Debug)]
pub struct Material {
    /// The file's name for it; empty if the file gives none.
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
    /// The factors of the map's x and y.
    pub normal_scale: f32,
    /// Its red is the share of ambient light that arrives; not encoded.
    pub occlusion_map: Option<Map>,
    /// The share of the map's darkening that is used, 0 to 1.
    pub occlusion_strength: f32,
    /// Light of its own, linear; above 1 with KHR_materials_emissive_strength.
    pub emissive: [f32; 3],
    /// Multiplies it; sRGB.
    pub emissive_map: Option<Map>,
    /// The material's lighting.
    pub lighting: Lighting,
    /// True if back faces are drawn.
    pub double_sided: bool,
    /// The meaning of the base colour's alpha.
    pub alpha: AlphaMode,
    /// The continuation of texture coordinates beyond 0 to 1 along u and v.
    pub wrap: [Wrap; 2],
    /// The material as its glTF has it, if a new glTF shall have all of it
    /// ([`Scene::appearance_with_originals`](crate::Scene::appearance_with_originals)).
    pub original: Option<OriginalMaterial>,
}

impl Material {
    /// A material for faces to which a scan format gives no other. Such formats know no culling, so both sides are
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
            original: None,
        }
    }
}

/// An image other than the base colour's, and its mapping onto the surface.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Map {
    /// Index into [`Appearance::images`].
    pub image: usize,
    /// The continuation of texture coordinates beyond 0 to 1 along u and v.
    pub wrap: [Wrap; 2],
    /// The set of texture coordinates.
    pub set: UvSet,
    /// The place of the look-up in the image: rows that multiply (u, v, 1).
    pub transform: [[f32; 3]; 2],
}

/// The lighting of a material.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub enum Lighting {
    /// Lit.
    #[default]
    Lit,
    /// The base colour is shown without lighting (KHR_materials_unlit), which suits photographed scans.
    Unlit,
}

/// The meaning of alpha.
#[derive(Clone, Copy, PartialEq, Debug)]
pub enum AlphaMode {
    /// None: the surface is opaque.
    Opaque,
    /// Drawn where alpha is at least this cut-off.
    Mask(f32),
    /// Blended.
    Blend,
}

/// The continuation of an image beyond its edges.
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
    /// The file's name for it, or its neighbour's; empty if there is neither.
    pub name: String,
    /// PNG, JPEG or another format of the file; empty if the neighbour is missing.
    pub encoded: Bytes,
    /// The place that it was read from.
    pub origin: Origin,
}

impl Image {
    /// The extension of a PNG or JPEG, which every reader of images knows; `None` for other kinds.
    pub(crate) fn common_extension(&self) -> Option<&'static str> {
        match self.encoded[..] {
            [0x89, b'P', b'N', b'G', ..] => Some("png"),
            [0xff, 0xd8, 0xff, ..] => Some("jpg"),
            _ => None,
        }
    }
}

/// The place that an image was read from.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Origin {
    /// The file itself, or its folder.
    Inside,
    /// A place outside the file's folder, to which a file from a stranger may point.
    Outside,
}
