//! A device with the pipelines and resources that everything drawn on it shares.

use crate::RenderError;
use crate::device::bindings::bind_group;
use crate::device::buffers::filled;
use crate::device::guard::guarded;
use crate::pipelines::Pipelines;
use crate::texture::{Encoding, TextureData, TextureUploader};

/// A device, its queue and its pipelines: all that making a [`crate::Surface`] or [`crate::Materials`] needs. A
/// [`crate::Renderer`] has one.
#[derive(Debug)]
pub struct Gpu {
    pub(crate) device: wgpu::Device,
    pub(crate) queue: wgpu::Queue,
    pub(crate) pipelines: Pipelines,
    pub(crate) textures: TextureUploader,
    /// The stand-in for a map that a material does not have.
    pub(crate) white: wgpu::TextureView,
}

impl Gpu {
    pub(crate) fn new(device: &wgpu::Device, queue: &wgpu::Queue) -> Result<Self, RenderError> {
        let (pipelines, textures) = guarded(device, "while starting to draw", || {
            Ok((Pipelines::new(device), TextureUploader::new(device, queue)))
        })?;
        let white = TextureData {
            width: 1,
            height: 1,
            rgba: &[255; 4],
            encoding: Encoding::Linear,
        };
        Ok(Self {
            white: textures.texture(0, &white)?,
            device: device.clone(),
            queue: queue.clone(),
            pipelines,
            textures,
        })
    }

    /// A uniform buffer that holds `contents`.
    pub(crate) fn uniform<T: bytemuck::NoUninit>(
        &self,
        label: &'static str,
        contents: T,
    ) -> Result<wgpu::Buffer, RenderError> {
        filled(
            &self.device,
            &self.queue,
            label,
            wgpu::BufferUsages::UNIFORM,
            &[contents],
        )
    }

    /// A bind group with one uniform buffer.
    pub(crate) fn uniform_group(
        &self,
        layout: &wgpu::BindGroupLayout,
        buffer: &wgpu::Buffer,
    ) -> Result<wgpu::BindGroup, RenderError> {
        guarded(&self.device, "while making bind groups", || {
            Ok(bind_group(
                &self.device,
                "uniform",
                layout,
                &[buffer.as_entire_binding()],
            ))
        })
    }
}
