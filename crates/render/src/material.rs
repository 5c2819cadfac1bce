//! What a file says about how its triangles look.

use std::ops::Range;

/// A material. New members may come: fill with `..Material::default()`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Material {
    /// Red, green, blue, alpha; *linear*, 0 to 1 (a glTF `baseColorFactor`).
    pub base_colour: [f32; 4],
    /// Number of the texture in [`crate::SurfaceData::textures`] that multiplies the base colour.
    pub base_colour_texture: Option<usize>,
    /// What alpha means.
    pub alpha: AlphaMode,
    /// Whether the back is as good as the front. Backs are always drawn (an editor must show the inside of an open
    /// scan, and picking must agree with the picture), but those of single-sided materials are dimmed.
    pub double_sided: bool,
}

impl Default for Material {
    /// Opaque white, single-sided, without texture.
    fn default() -> Self {
        Self {
            base_colour: [1.0; 4],
            base_colour_texture: None,
            alpha: AlphaMode::Opaque,
            double_sided: false,
        }
    }
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
