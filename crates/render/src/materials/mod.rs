//! Materials: their definition, textures, image-based light, and matcaps.

pub(crate) mod environment;
pub(crate) mod fullscreen;
pub(crate) mod matcap;
pub(crate) mod material;
pub(crate) mod texture;

use crate::surface::data::textures_exist;
use crate::{Material, RenderError, Renderer, TextureData};

/// Materials and their textures on the device. They are made separately from the surface, perhaps on another thread,
/// because decoding and uploading textures takes longer than everything else. Clones share the textures.
#[derive(Clone, Debug)]
pub struct Materials {
    /// One bind group per material, then that of the default material.
    pub(crate) groups: Vec<wgpu::BindGroup>,
}

impl Materials {
    /// Uploads textures and the materials that use them.
    ///
    /// # Errors
    /// Indices out of range, textures of the wrong size, or out of memory.
    pub fn new(renderer: &Renderer, materials: &[Material], textures: &[TextureData<'_>]) -> Result<Self, RenderError> {
        textures_exist(materials, textures.len())?;
        let groups = renderer.material_groups(materials, textures)?;
        Ok(Self { groups })
    }
}
