//! The environment light of materials: two cube maps, drawn when a material is first shown.

use pliant_shaders::Shader;

use crate::device::bindings::bind_group;
use crate::device::buffers::filled;
use crate::device::guard::guarded;
use crate::pipelines::fullscreen;
use crate::uniforms::EnvironmentUniform;
use crate::{Gpu, RenderError};

const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba16Float;
/// The prefiltered environment map: 64 pixels a side at roughness 0, down to 4 at roughness 1, as `material.wgsl`
/// samples it.
const PREFILTERED_PX: u32 = 64;
const PREFILTERED_LEVELS: u32 = 5;
const PREFILTERED_SAMPLES: u32 = 96;
/// Irradiance changes slowly, so its map is small.
const IRRADIANCE_PX: u32 = 8;
const IRRADIANCE_SAMPLES: u32 = 512;

/// Right, down and forward of each face, in the order of a cube map's layers.
const FACES: [[[f32; 3]; 3]; 6] = [
    [[0.0, 0.0, -1.0], [0.0, -1.0, 0.0], [1.0, 0.0, 0.0]],
    [[0.0, 0.0, 1.0], [0.0, -1.0, 0.0], [-1.0, 0.0, 0.0]],
    [[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, 1.0, 0.0]],
    [[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, -1.0, 0.0]],
    [[1.0, 0.0, 0.0], [0.0, -1.0, 0.0], [0.0, 0.0, 1.0]],
    [[-1.0, 0.0, 0.0], [0.0, -1.0, 0.0], [0.0, 0.0, -1.0]],
];

/// The bind group of the two cube maps.
pub(crate) fn environment(gpu: &Gpu) -> Result<wgpu::BindGroup, RenderError> {
    let device = &gpu.device;
    guarded(device, "while drawing the environment maps", || {
        let prefiltered = cube(device, "prefiltered environment", PREFILTERED_PX, PREFILTERED_LEVELS);
        let irradiance = cube(device, "irradiance map", IRRADIANCE_PX, 1);
        let [prefilter, irradiate] = pipelines(device);
        fill(gpu, &prefilter, &prefiltered, PREFILTERED_SAMPLES)?;
        fill(gpu, &irradiate, &irradiance, IRRADIANCE_SAMPLES)?;
        let view = |texture: &wgpu::Texture| {
            texture.create_view(&wgpu::TextureViewDescriptor {
                dimension: Some(wgpu::TextureViewDimension::Cube),
                ..Default::default()
            })
        };
        let sampler = device.create_sampler(&wgpu::SamplerDescriptor {
            label: Some("environment"),
            mag_filter: wgpu::FilterMode::Linear,
            min_filter: wgpu::FilterMode::Linear,
            mipmap_filter: wgpu::MipmapFilterMode::Linear,
            ..Default::default()
        });
        let resources = [
            wgpu::BindingResource::TextureView(&view(&prefiltered)),
            wgpu::BindingResource::TextureView(&view(&irradiance)),
            wgpu::BindingResource::Sampler(&sampler),
        ];
        let layout = &gpu.pipelines.environment_layout;
        Ok(bind_group(device, "environment", layout, &resources))
    })
}

/// The pipelines that draw a face of the prefiltered map and one of the irradiance map.
pub(crate) fn pipelines(device: &wgpu::Device) -> [wgpu::RenderPipeline; 2] {
    let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: Some(Shader::Environment.file_name()),
        source: wgpu::ShaderSource::Wgsl(Shader::Environment.composed().into()),
    });
    ["fs_prefiltered", "fs_irradiance"]
        .map(|entry| fullscreen::pipeline(device, &module, ["vs_environment", entry], FORMAT))
}

fn cube(device: &wgpu::Device, label: &str, side_px: u32, levels: u32) -> wgpu::Texture {
    device.create_texture(&wgpu::TextureDescriptor {
        label: Some(label),
        size: wgpu::Extent3d {
            width: side_px,
            height: side_px,
            depth_or_array_layers: 6,
        },
        mip_level_count: levels,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: FORMAT,
        usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::RENDER_ATTACHMENT,
        view_formats: &[],
    })
}

/// Draws every face of every mip level; roughness rises evenly from 0 to 1 with the level.
fn fill(gpu: &Gpu, pipeline: &wgpu::RenderPipeline, texture: &wgpu::Texture, samples: u32) -> Result<(), RenderError> {
    let (device, queue) = (&gpu.device, &gpu.queue);
    let layout = pipeline.get_bind_group_layout(0);
    let levels = texture.mip_level_count();
    let mut encoder = device.create_command_encoder(&Default::default());
    for level in 0..levels {
        for (face, axes) in FACES.iter().enumerate() {
            let [right, down, forward] = axes.map(|[x, y, z]| [x, y, z, 0.0]);
            let uniform = EnvironmentUniform {
                right,
                down,
                forward,
                roughness: level as f32 / (levels - 1).max(1) as f32,
                samples,
                padding: [0.0; 2],
            };
            let buffer = filled(
                device,
                queue,
                "environment uniform",
                wgpu::BufferUsages::UNIFORM,
                &[uniform],
            )?;
            let group = bind_group(device, "environment uniform", &layout, &[buffer.as_entire_binding()]);
            let view = texture.create_view(&wgpu::TextureViewDescriptor {
                dimension: Some(wgpu::TextureViewDimension::D2),
                base_mip_level: level,
                mip_level_count: Some(1),
                base_array_layer: face as u32,
                array_layer_count: Some(1),
                ..Default::default()
            });
            fullscreen::draw(&mut encoder, pipeline, &group, &view);
        }
    }
    queue.submit([encoder.finish()]);
    Ok(())
}
