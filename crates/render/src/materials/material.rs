//! What a file says about how its triangles look.

use std::ops::Range;

use crate::frame::uniforms::{MapUniform, MaterialUniform};

/// A material of glTF's metallic-roughness model. New members may come: fill with `..Material::default()`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Material {
    /// Red, green, blue, alpha; *linear*, 0 to 1 (a glTF `baseColorFactor`).
    pub base_colour: [f32; 4],
    /// Multiplies the base colour. Always looked up at the first set of texture coordinates, untransformed.
    pub base_colour_map: Option<Map>,
    /// 0 (dielectric) to 1 (metal).
    pub metallic: f32,
    /// 0 (mirror) to 1 (matt).
    pub roughness: f32,
    /// Green multiplies the roughness, blue the metallic share.
    pub metallic_roughness_map: Option<Map>,
    /// Normals in tangent space, x along u and y against v.
    pub normal_map: Option<Map>,
    /// What its x and y are multiplied by.
    pub normal_scale: f32,
    /// Red is the share of ambient light that arrives.
    pub occlusion_map: Option<Map>,
    /// How much of its darkening is used, 0 to 1.
    pub occlusion_strength: f32,
    /// Light of its own, linear.
    pub emissive: [f32; 3],
    /// Multiplies it.
    pub emissive_map: Option<Map>,
    /// Whether light plays a part.
    pub lighting: Lighting,
    /// What alpha means.
    pub alpha: AlphaMode,
    /// Whether the back is as good as the front. Backs are always drawn (an editor must show the inside of an open
    /// scan, and picking must agree with the picture), but those of single-sided materials are dimmed.
    pub double_sided: bool,
}

impl Default for Material {
    /// Opaque white, half matt, no metal, single-sided, without images.
    fn default() -> Self {
        Self {
            base_colour: [1.0; 4],
            base_colour_map: None,
            metallic: 0.0,
            roughness: 0.6,
            metallic_roughness_map: None,
            normal_map: None,
            normal_scale: 1.0,
            occlusion_map: None,
            occlusion_strength: 1.0,
            emissive: [0.0; 3],
            emissive_map: None,
            lighting: Lighting::Lit,
            alpha: AlphaMode::Opaque,
            double_sided: false,
        }
    }
}

/// An image of a material and how it is laid on the surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Map {
    /// Number of the texture in [`crate::SurfaceData::textures`].
    pub texture: usize,
    /// What lies beyond the image's borders, along u and v.
    pub wrap: [Wrap; 2],
    /// Which texture coordinates are taken.
    pub set: UvSet,
    /// Rows that multiply (u, v, 1).
    pub transform: [[f32; 3]; 2],
}

impl Map {
    /// A texture looked up at the first set of texture coordinates, repeated.
    pub fn of(texture: usize) -> Self {
        Self {
            texture,
            wrap: [Wrap::Repeat; 2],
            set: UvSet::First,
            transform: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]],
        }
    }
}

/// A set of texture coordinates.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum UvSet {
    /// [`crate::SurfaceData::uvs`].
    #[default]
    First,
    /// [`crate::SurfaceData::second_uvs`].
    Second,
}

/// What lies beyond an image's border.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Wrap {
    /// The image again.
    #[default]
    Repeat,
    /// The image mirrored, and again.
    Mirror,
    /// Its border pixels.
    Clamp,
}

/// Whether light plays a part in how a material looks.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Lighting {
    /// It does.
    #[default]
    Lit,
    /// The base colour is shown as it is.
    Unlit,
}

/// What a material's alpha means.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum AlphaMode {
    /// Nothing.
    #[default]
    Opaque,
    /// Drawn where alpha is at least the cutoff, 0 to 1.
    Mask {
        /// The least alpha that is drawn.
        cutoff: f32,
    },
    /// Mixed with what is behind; triangles are not sorted.
    Blend,
}

/// A run of triangles of one material.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct MaterialGroup {
    /// Triangle numbers.
    pub triangles: Range<u32>,
    /// Number of the material in [`crate::SurfaceData::materials`].
    pub material: usize,
}

/// What the light of the back of a single-sided material is multiplied by.
const BACK_SHARE: f32 = 0.45;

impl Material {
    /// The images in the order of the shader's bindings.
    pub(crate) fn maps(&self) -> [Option<Map>; 5] {
        [
            self.base_colour_map,
            self.metallic_roughness_map,
            self.normal_map,
            self.occlusion_map,
            self.emissive_map,
        ]
    }

    pub(crate) fn uniform(&self) -> MaterialUniform {
        let mut flags = 0;
        for (bit, map) in self.maps().iter().enumerate() {
            flags |= u32::from(map.is_some()) << bit;
        }
        flags |= u32::from(self.lighting == Lighting::Unlit) << 5;
        let (cutoff, is_solid) = match self.alpha {
            AlphaMode::Mask { cutoff } => (cutoff, true),
            AlphaMode::Opaque => (0.0, true),
            AlphaMode::Blend => (0.0, false),
        };
        let row = |map: Option<Map>| {
            let map = map.unwrap_or(Map::of(0));
            let second = if map.set == UvSet::Second { 1.0 } else { 0.0 };
            let [u, v] = map.transform;
            MapUniform {
                u: [u[0], u[1], u[2], second],
                v: [v[0], v[1], v[2], 0.0],
            }
        };
        MaterialUniform {
            base_colour: self.base_colour,
            emissive: [self.emissive[0], self.emissive[1], self.emissive[2], cutoff],
            metallic: self.metallic,
            roughness: self.roughness,
            normal_scale: self.normal_scale,
            occlusion_strength: self.occlusion_strength,
            back_share: if self.double_sided || !is_solid {
                1.0
            } else {
                BACK_SHARE
            },
            flags,
            padding: [0.0; 2],
            metallic_roughness: row(self.metallic_roughness_map),
            normal: row(self.normal_map),
            occlusion: row(self.occlusion_map),
            emission: row(self.emissive_map),
        }
    }
}
