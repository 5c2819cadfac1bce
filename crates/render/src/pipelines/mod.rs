//! Bind group layouts, created once per device, and render pipelines, each created on first use.

mod bind_group_layouts;
mod description;
#[cfg(test)]
mod driver_tests;
pub(crate) mod fullscreen;
pub(crate) mod pipeline;
#[cfg(test)]
mod shader_tests;
pub(crate) mod vertex_layouts;

use std::collections::HashMap;

use pliant_shaders::Shader;

use self::bind_group_layouts::{layout, sampler_entry, storage_entry, texture_entry, uniform_entry};
use self::description::PipelineDescription;
pub(crate) use self::pipeline::{Alpha, ID_FORMAT, MaterialAttributes, OCCLUSION_FORMAT, Pipeline, Visibility};
use crate::device::guard::guarded;
use crate::{RenderError, Samples};

/// The bind group layouts, and the pipelines created so far.
#[derive(Debug)]
pub(crate) struct Pipelines {
    pub(crate) frame_layout: wgpu::BindGroupLayout,
    pub(crate) surface_layout: wgpu::BindGroupLayout,
    pub(crate) matcap_layout: wgpu::BindGroupLayout,
    pub(crate) material_layout: wgpu::BindGroupLayout,
    pub(crate) environment_layout: wgpu::BindGroupLayout,
    pub(crate) positions_layout: wgpu::BindGroupLayout,
    pub(crate) shadow_layout: wgpu::BindGroupLayout,
    modules: HashMap<Shader, wgpu::ShaderModule>,
    made: HashMap<(Pipeline, Samples), wgpu::RenderPipeline>,
}

impl Pipelines {
    /// Creates the layouts; pipelines follow on demand.
    pub(crate) fn new(device: &wgpu::Device) -> Self {
        let both = wgpu::ShaderStages::VERTEX_FRAGMENT;
        let fragment = wgpu::ShaderStages::FRAGMENT;
        let mut material = vec![uniform_entry(0, fragment)];
        for image in 0..5 {
            material.push(texture_entry(2 * image + 1, wgpu::TextureViewDimension::D2));
            material.push(sampler_entry(2 * image + 2));
        }
        let flat = wgpu::TextureViewDimension::D2;
        let cube = wgpu::TextureViewDimension::Cube;
        Self {
            frame_layout: layout(device, "frame", &[uniform_entry(0, both)]),
            surface_layout: layout(device, "surface", &[uniform_entry(0, both)]),
            matcap_layout: layout(
                device,
                "matcap",
                &[uniform_entry(0, fragment), texture_entry(1, flat), sampler_entry(2)],
            ),
            material_layout: layout(device, "material", &material),
            environment_layout: layout(
                device,
                "environment",
                &[texture_entry(0, cube), texture_entry(1, cube), sampler_entry(2)],
            ),
            positions_layout: layout(device, "positions", &[storage_entry(0)]),
            shadow_layout: layout(
                device,
                "shadow",
                &[uniform_entry(0, both), texture_entry(1, flat), sampler_entry(2)],
            ),
            modules: HashMap::new(),
            made: HashMap::new(),
        }
    }

    /// Creates a pipeline for `samples` if it does not exist yet.
    pub(crate) fn prepare(
        &mut self,
        device: &wgpu::Device,
        pipeline: Pipeline,
        samples: Samples,
    ) -> Result<(), RenderError> {
        if self.made.contains_key(&(pipeline, samples)) {
            return Ok(());
        }
        if pipeline == Pipeline::Id && !device.features().contains(wgpu::Features::PRIMITIVE_INDEX) {
            return Err(RenderError::NoTriangleNumbers);
        }
        let made = guarded(device, "while compiling shaders", || {
            Ok(self.make(device, pipeline, samples))
        })?;
        self.made.insert((pipeline, samples), made);
        Ok(())
    }

    /// A pipeline that was prepared before.
    pub(crate) fn get(&self, pipeline: Pipeline, samples: Samples) -> Option<&wgpu::RenderPipeline> {
        self.made.get(&(pipeline, samples))
    }

    fn make(&mut self, device: &wgpu::Device, pipeline: Pipeline, samples: Samples) -> wgpu::RenderPipeline {
        let description = PipelineDescription::of(pipeline);
        let module = self.modules.entry(description.shader).or_insert_with(|| {
            device.create_shader_module(wgpu::ShaderModuleDescriptor {
                label: Some(description.shader.file_name()),
                source: wgpu::ShaderSource::Wgsl(description.shader.composed().into()),
            })
        });
        let (frame, surface) = (&self.frame_layout, &self.surface_layout);
        let groups = match pipeline {
            Pipeline::Matcap | Pipeline::Painted | Pipeline::Zebra | Pipeline::Normals => {
                vec![frame, surface, &self.matcap_layout]
            }
            Pipeline::Material(..) => vec![frame, surface, &self.material_layout, &self.environment_layout],
            Pipeline::Wireframe | Pipeline::Id | Pipeline::Occlusion => vec![frame, surface],
            Pipeline::Shadow => vec![frame, &self.shadow_layout],
            Pipeline::SurfaceLines(_) => vec![frame, surface, &self.positions_layout],
            // The grid's uniform buffer takes the surface's bind group, whose layout is the same.
            Pipeline::Grid => vec![frame, surface],
            Pipeline::Background | Pipeline::OverlayTriangles(_) | Pipeline::OverlayLines(_) => vec![frame],
        };
        let groups: Vec<_> = groups.into_iter().map(Some).collect();
        let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: None,
            bind_group_layouts: &groups,
            immediate_size: 0,
        });
        description.pipeline(device, &layout, module, samples)
    }
}
