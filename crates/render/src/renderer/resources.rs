//! Buffers and bind groups that frames share, each made on first use.

use std::collections::HashMap;

use crate::device::bindings::bind_group;
use crate::device::buffers::{DynamicBuffer, refill};
use crate::device::guard::guarded;
use crate::materials::environment::environment;
use crate::materials::matcap;
use crate::texture::{Encoding, TextureData};
use crate::uniforms::{FrameUniform, GridUniform};
use crate::{Frame, Gpu, Matcap, RenderError};

/// The buffers and bind groups of frames.
#[derive(Debug)]
pub(crate) struct Resources {
    frame_buffer: wgpu::Buffer,
    pub(crate) frame_group: wgpu::BindGroup,
    pub(super) grid_buffer: wgpu::Buffer,
    pub(super) grid_group: wgpu::BindGroup,
    pub(super) matcaps: HashMap<Matcap, wgpu::BindGroup>,
    pub(super) environment: Option<wgpu::BindGroup>,
    pub(super) overlay_triangles: DynamicBuffer,
    pub(super) overlay_lines: DynamicBuffer,
}

impl Resources {
    pub(super) fn new(gpu: &Gpu) -> Result<Self, RenderError> {
        let empty: FrameUniform = bytemuck::Zeroable::zeroed();
        let frame_buffer = gpu.uniform("frame uniform", empty)?;
        let empty: GridUniform = bytemuck::Zeroable::zeroed();
        let grid_buffer = gpu.uniform("grid uniform", empty)?;
        Ok(Self {
            frame_group: gpu.uniform_group(&gpu.pipelines.frame_layout, &frame_buffer)?,
            frame_buffer,
            grid_group: gpu.uniform_group(&gpu.pipelines.surface_layout, &grid_buffer)?,
            grid_buffer,
            matcaps: HashMap::new(),
            environment: None,
            overlay_triangles: DynamicBuffer::new("overlay triangles"),
            overlay_lines: DynamicBuffer::new("overlay lines"),
        })
    }

    /// Draws the environment maps if they are not there yet.
    pub(super) fn prepare_environment(&mut self, gpu: &Gpu) -> Result<(), RenderError> {
        if self.environment.is_none() {
            self.environment = Some(environment(gpu)?);
        }
        Ok(())
    }

    /// Uploads a matcap's texture if it is not there yet.
    pub(super) fn prepare_matcap(&mut self, gpu: &Gpu, matcap: Matcap) -> Result<(), RenderError> {
        if self.matcaps.contains_key(&matcap) {
            return Ok(());
        }
        let pixels = matcap::texture(matcap);
        let texture = TextureData {
            width: 2 * matcap::SIDE_PX,
            height: matcap::SIDE_PX,
            rgba: &pixels,
            encoding: Encoding::Srgb,
        };
        let view = gpu.textures.texture(0, &texture)?;
        let uniform = gpu.uniform("matcap uniform", matcap::uniform(matcap))?;
        let group = guarded(&gpu.device, "while making bind groups", || {
            let sampler = gpu.textures.sampler([crate::Wrap::Clamp; 2]);
            let resources = [
                uniform.as_entire_binding(),
                wgpu::BindingResource::TextureView(&view),
                wgpu::BindingResource::Sampler(&sampler),
            ];
            Ok(bind_group(
                &gpu.device,
                "matcap",
                &gpu.pipelines.matcap_layout,
                &resources,
            ))
        })?;
        self.matcaps.insert(matcap, group);
        Ok(())
    }

    /// Uploads a frame's uniform.
    pub(crate) fn write_frame(
        &self,
        gpu: &Gpu,
        frame: &Frame<'_>,
        size_px: [u32; 2],
        background_span: [f32; 2],
    ) -> Result<(), RenderError> {
        let uniform = frame.uniform(size_px, background_span);
        refill(&gpu.device, &gpu.queue, &self.frame_buffer, &[uniform])
    }
}
