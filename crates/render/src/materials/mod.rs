//! Materials: their definition, image-based light, and matcaps.

pub(crate) mod environment;
pub(crate) mod matcap;
pub(crate) mod material;

use crate::device::bindings::bind_group;
use crate::device::guard::guarded;
use crate::{Gpu, Material, RenderError, TextureData};

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
    pub fn new(gpu: &Gpu, materials: &[Material], textures: &[TextureData<'_>]) -> Result<Self, RenderError> {
        textures_exist(materials, textures.len())?;
        let views = textures
            .iter()
            .enumerate()
            .map(|(number, texture)| gpu.textures.texture(number, texture))
            .collect::<Result<Vec<_>, _>>()?;
        let default = Material::default();
        let all = materials.iter().chain([&default]);
        let groups = all
            .map(|material| group(gpu, material, &views))
            .collect::<Result<_, _>>()?;
        Ok(Self { groups })
    }
}

/// The bind group of a material; a white texture stands in for each missing map.
fn group(gpu: &Gpu, material: &Material, views: &[wgpu::TextureView]) -> Result<wgpu::BindGroup, RenderError> {
    let uniform = gpu.uniform("material uniform", material.uniform())?;
    guarded(&gpu.device, "while making bind groups", || {
        let samplers = material
            .maps()
            .map(|map| gpu.textures.sampler(map.map_or_else(Default::default, |map| map.wrap)));
        let mut resources = vec![uniform.as_entire_binding()];
        for (map, sampler) in material.maps().iter().zip(&samplers) {
            let view = map.and_then(|map| views.get(map.texture)).unwrap_or(&gpu.white);
            resources.push(wgpu::BindingResource::TextureView(view));
            resources.push(wgpu::BindingResource::Sampler(sampler));
        }
        Ok(bind_group(
            &gpu.device,
            "material",
            &gpu.pipelines.material_layout,
            &resources,
        ))
    })
}

/// Rejects materials with a texture index out of range.
pub(crate) fn textures_exist(materials: &[Material], count: usize) -> Result<(), RenderError> {
    let mut maps = materials.iter().flat_map(|material| material.maps()).flatten();
    match maps.find(|map| map.texture >= count) {
        Some(map) => Err(RenderError::NoSuch {
            what: "texture",
            number: map.texture,
            count,
        }),
        None => Ok(()),
    }
}
