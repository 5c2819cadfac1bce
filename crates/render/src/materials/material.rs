//! Materials as files define them.

use std::ops::Range;

use crate::texture::Wrap;
use crate::uniforms::{MapUniform, MaterialUniform};

/// A material of glTF's metallic-roughness model. Construct it with `..Material::default()`, as members may be added.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Material {
    /// Red, green, blue, alpha; *linear*, 0 to 1 (a glTF `baseColorFactor`).
    pub base_colour: [f32; 4],
    /// Multiplies the base colour. Always sampled at the first set of texture coordinates, without a transform.
    pub base_colour_map: Option<Map>,
    /// 0 (dielectric) to 1 (metal).
    pub metallic: f32,
    /// 0 (mirror) to 1 (matt).
    pub roughness: f32,
    /// Green multiplies the roughness, blue the metalness.
    pub metallic_roughness_map: Option<Map>,
    /// Tangent-space normals, x along u and y against v.
    pub normal_map: Option<Map>,
    /// Scale of the normal map's x and y.
    pub normal_scale: f32,
    /// Ambient occlusion, in red.
    pub occlusion_map: Option<Map>,
    /// Strength of the occlusion map, 0 to 1.
    pub occlusion_strength: f32,
    /// Emitted light, linear.
    pub emissive: [f32; 3],
    /// Multiplies the emitted light.
    pub emissive_map: Option<Map>,
    /// The material's lighting.
    pub lighting: Lighting,
    /// The use of alpha.
    pub alpha: AlphaMode,
    /// True if back faces are lit like front faces. Back faces are always drawn, because an editor must show the inside
    /// of an open scan and picking must agree with the picture, but single-sided materials dim them.
    pub double_sided: bool,
}

impl Default for Material {
    /// Opaque white, roughness 0.6, not metallic, single-sided, without textures.
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

/// A texture of a material, and how it is mapped to the surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Map {
    /// Index of the texture in [`crate::SurfaceData::textures`].
    pub texture: usize,
    /// Wrap modes along u and v.
    pub wrap: [Wrap; 2],
    /// The set of texture coordinates.
    pub set: UvSet,
    /// Texture transform: two rows that multiply (u, v, 1).
    pub transform: [[f32; 3]; 2],
}

impl Map {
    /// A repeated texture at the first set of texture coordinates.
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

/// The lighting of a material.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Lighting {
    /// Lit.
    #[default]
    Lit,
    /// The base colour is shown without lighting.
    Unlit,
}

/// The use of a material's alpha.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum AlphaMode {
    /// Alpha is ignored.
    #[default]
    Opaque,
    /// Drawn where alpha is at least the cutoff.
    Mask {
        /// The least alpha that is drawn, 0 to 1.
        cutoff: f32,
    },
    /// Blended with the picture behind; triangles are not sorted.
    Blend,
}

/// A range of triangles with one material.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct MaterialGroup {
    /// Triangle indices.
    pub triangles: Range<u32>,
    /// Index of the material in [`crate::SurfaceData::materials`].
    pub material: usize,
}

/// Factor of the light on back faces of single-sided materials.
const BACK_SHARE: f32 = 0.45;

impl Material {
    /// The maps in the order of the shader's bindings.
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
