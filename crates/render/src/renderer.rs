//! The renderer: the resources of one device, created on first use, and drawing a frame.

use std::collections::HashMap;

use crate::device::bindings::bind_group;
use crate::device::buffers::{DynamicBuffer, filled, refill};
use crate::device::guard::guarded;
use crate::device::headless::is_software;
use crate::device::timer::Timer;
use crate::frame::overlay::OverlayBatch;
use crate::frame::recording::{PreparedFrame, begin_picture, matcap_of};
use crate::frame::uniforms::{FrameUniform, GridUniform};
use crate::materials::environment::environment;
use crate::materials::matcap;
use crate::materials::texture::TextureUploader;
use crate::pipelines::Pipelines;
use crate::surface::draw_calls::Batching;
use crate::surface::shadow::ShadowTools;
use crate::{
    Borders, Detail, Encoding, Frame, Matcap, Material, RenderError, Samples, Shading, Target, TextureData, Wireframe,
};

/// The pipelines and shared resources of one device. Create one per device and keep it.
#[derive(Debug)]
pub struct Renderer {
    device: wgpu::Device,
    queue: wgpu::Queue,
    pub(crate) pipelines: Pipelines,
    textures: TextureUploader,
    white: wgpu::TextureView,
    frame_buffer: wgpu::Buffer,
    pub(crate) frame_group: wgpu::BindGroup,
    grid_buffer: wgpu::Buffer,
    pub(crate) grid_group: wgpu::BindGroup,
    pub(crate) matcaps: HashMap<Matcap, wgpu::BindGroup>,
    pub(crate) environment: Option<wgpu::BindGroup>,
    pub(crate) shadow_tools: Option<ShadowTools>,
    pub(crate) overlay_triangles: DynamicBuffer,
    pub(crate) overlay_lines: DynamicBuffer,
    timer: Option<Timer>,
}

/// The background span of a whole picture. A tile's span is the fraction of the background below it and its own
/// fraction.
pub(crate) const WHOLE_BACKGROUND: [f32; 2] = [0.0, 1.0];

impl Renderer {
    /// A renderer on a device, ideally one opened with [`crate::device_descriptor`].
    ///
    /// # Errors
    /// [`RenderError::Refused`] or [`RenderError::OutOfMemory`] if the device rejects a shader or a buffer.
    pub fn new(device: &wgpu::Device, queue: &wgpu::Queue) -> Result<Self, RenderError> {
        let pipelines = guarded(device, "while starting to draw", || Ok(Pipelines::new(device)))?;
        let textures = guarded(device, "while starting to draw", || {
            Ok(TextureUploader::new(device, queue))
        })?;
        let white = TextureData {
            width: 1,
            height: 1,
            rgba: &[255; 4],
            encoding: Encoding::Linear,
        };
        let white = textures.texture(0, &white)?;
        let uniform = wgpu::BufferUsages::UNIFORM;
        let empty: FrameUniform = bytemuck::Zeroable::zeroed();
        let frame_buffer = filled(device, queue, "frame uniform", uniform, &[empty])?;
        let empty: GridUniform = bytemuck::Zeroable::zeroed();
        let grid_buffer = filled(device, queue, "grid uniform", uniform, &[empty])?;
        let (frame_group, grid_group) = guarded(device, "while starting to draw", || {
            Ok((
                uniform_group(device, &pipelines.frame_layout, &frame_buffer),
                uniform_group(device, &pipelines.surface_layout, &grid_buffer),
            ))
        })?;
        Ok(Self {
            device: device.clone(),
            queue: queue.clone(),
            pipelines,
            textures,
            white,
            frame_buffer,
            frame_group,
            grid_buffer,
            grid_group,
            matcaps: HashMap::new(),
            environment: None,
            shadow_tools: None,
            overlay_triangles: DynamicBuffer::new("overlay triangles"),
            overlay_lines: DynamicBuffer::new("overlay lines"),
            timer: Timer::new(device, queue),
        })
    }

    /// The device.
    pub fn device(&self) -> &wgpu::Device {
        &self.device
    }

    /// Its queue.
    pub fn queue(&self) -> &wgpu::Queue {
        &self.queue
    }

    /// The device's name, to be shown to the user.
    pub fn device_name(&self) -> String {
        self.device.adapter_info().name
    }

    /// Whether the device is a software renderer on the CPU. Drawing is slow there, so use [`crate::Samples::One`]
    /// during interaction.
    pub fn is_software(&self) -> bool {
        is_software(&self.device)
    }

    /// GPU time of a recent frame in milliseconds; `None` before the first measurement and on devices without timestamp
    /// queries.
    pub fn device_ms(&self) -> Option<f64> {
        self.timer.as_ref()?.last_ms()
    }

    /// Waits until all submitted work is done.
    ///
    /// # Errors
    /// [`RenderError::Lost`] if the device does not respond.
    pub fn finish(&mut self) -> Result<(), RenderError> {
        let lost = RenderError::Lost { doing: "drawing" };
        self.device
            .poll(wgpu::PollType::wait_indefinitely())
            .map_err(|_| lost)?;
        if let Some(timer) = &mut self.timer {
            timer.collect(&self.device, wgpu::PollType::Poll);
        }
        Ok(())
    }

    /// Draws a frame into a target without waiting. Does nothing if the target is empty.
    ///
    /// # Errors
    /// Out of memory, or the device rejects a command; the target then shows its old contents or part of the frame.
    pub fn draw(&mut self, target: &Target, frame: &Frame<'_>) -> Result<(), RenderError> {
        self.draw_part(target, frame, WHOLE_BACKGROUND)
    }

    pub(crate) fn draw_part(
        &mut self,
        target: &Target,
        frame: &Frame<'_>,
        background_span: [f32; 2],
    ) -> Result<(), RenderError> {
        let Some(attachments) = target.attachments() else {
            return Ok(());
        };
        self.write_frame(frame, attachments.size_px, background_span)?;
        let prepared = self.prepare(frame, attachments.samples)?;
        let device = self.device.clone();
        guarded(&device, "while drawing", || {
            let mut encoder = self.device.create_command_encoder(&Default::default());
            let writes = self.timer.as_mut().and_then(|timer| timer.writes(&device));
            let is_timed = writes.is_some();
            let mut pass = begin_picture(&mut encoder, attachments, writes);
            self.record(&mut pass, &prepared, attachments.samples);
            drop(pass);
            if let (true, Some(timer)) = (is_timed, &self.timer) {
                timer.resolve(&mut encoder);
            }
            self.queue.submit([encoder.finish()]);
            if let (true, Some(timer)) = (is_timed, &mut self.timer) {
                timer.submitted();
            }
            Ok(())
        })
    }

    /// Creates and uploads the resources of the frame.
    fn prepare<'a>(&mut self, frame: &'a Frame<'a>, samples: Samples) -> Result<PreparedFrame<'a>, RenderError> {
        let overlays = OverlayBatch::of(frame.overlays);
        self.overlay_triangles
            .fill(&self.device, &self.queue, &overlays.vertices)?;
        self.overlay_lines.fill(&self.device, &self.queue, &overlays.lines)?;
        if let Some(grid) = frame.grid {
            refill(&self.device, &self.queue, &self.grid_buffer, &[grid.uniform()])?;
        }
        let style = frame.style;
        if style.wireframe == Wireframe::On {
            frame
                .surfaces
                .iter()
                .try_for_each(|surface| surface.prepare_edges(self))?;
        }
        if style.borders == Borders::On {
            frame
                .surfaces
                .iter()
                .try_for_each(|surface| surface.prepare_borders(self))?;
        }
        let batching = if style.shading == Shading::Material {
            self.prepare_environment()?;
            Batching::PerMaterial
        } else {
            self.prepare_matcap(matcap_of(style.shading))?;
            Batching::Any
        };
        let draw_calls = frame.surfaces.iter().map(|&surface| match style.detail {
            Detail::Reduced if batching == Batching::Any && surface.has_reduced(frame.view) => {
                (surface, surface.reduced_draw_calls())
            }
            Detail::Reduced | Detail::Full => (surface, surface.draw_calls(frame.view, batching)),
        });
        let prepared = PreparedFrame {
            frame,
            overlays,
            draw_calls: draw_calls.collect(),
        };
        let device = self.device.clone();
        for pipeline in prepared.pipelines() {
            self.pipelines.prepare(&device, pipeline, samples)?;
        }
        Ok(prepared)
    }

    fn prepare_environment(&mut self) -> Result<(), RenderError> {
        if self.environment.is_none() {
            self.environment = Some(environment(self)?);
        }
        Ok(())
    }

    fn prepare_matcap(&mut self, matcap: Matcap) -> Result<(), RenderError> {
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
        let view = self.textures.texture(0, &texture)?;
        let usage = wgpu::BufferUsages::UNIFORM;
        let uniform = filled(
            &self.device,
            &self.queue,
            "matcap uniform",
            usage,
            &[matcap::uniform(matcap)],
        )?;
        let group = guarded(&self.device, "while making bind groups", || {
            let sampler = self.textures.sampler([crate::Wrap::Clamp; 2]);
            let resources = [
                uniform.as_entire_binding(),
                wgpu::BindingResource::TextureView(&view),
                wgpu::BindingResource::Sampler(&sampler),
            ];
            Ok(bind_group(
                &self.device,
                "matcap",
                &self.pipelines.matcap_layout,
                &resources,
            ))
        })?;
        self.matcaps.insert(matcap, group);
        Ok(())
    }

    pub(crate) fn write_frame(
        &self,
        frame: &Frame<'_>,
        size_px: [u32; 2],
        background_span: [f32; 2],
    ) -> Result<(), RenderError> {
        let uniform = FrameUniform::of(frame, size_px, background_span);
        refill(&self.device, &self.queue, &self.frame_buffer, &[uniform])
    }

    pub(crate) fn frame_group(&self) -> &wgpu::BindGroup {
        &self.frame_group
    }

    /// A bind group with one uniform buffer.
    pub(crate) fn uniform_group(
        &self,
        layout: &wgpu::BindGroupLayout,
        buffer: &wgpu::Buffer,
    ) -> Result<wgpu::BindGroup, RenderError> {
        guarded(&self.device, "while making bind groups", || {
            Ok(uniform_group(&self.device, layout, buffer))
        })
    }

    /// One bind group per material, then that of the default material.
    pub(crate) fn material_groups(
        &self,
        materials: &[Material],
        textures: &[TextureData<'_>],
    ) -> Result<Vec<wgpu::BindGroup>, RenderError> {
        let views = textures
            .iter()
            .enumerate()
            .map(|(number, texture)| self.textures.texture(number, texture))
            .collect::<Result<Vec<_>, _>>()?;
        let default = Material::default();
        let groups = materials.iter().chain([&default]);
        groups.map(|material| self.material_group(material, &views)).collect()
    }

    /// The bind group of a material; a white texture stands in for each missing map.
    fn material_group(&self, material: &Material, views: &[wgpu::TextureView]) -> Result<wgpu::BindGroup, RenderError> {
        let usage = wgpu::BufferUsages::UNIFORM;
        let uniform = filled(
            &self.device,
            &self.queue,
            "material uniform",
            usage,
            &[material.uniform()],
        )?;
        guarded(&self.device, "while making bind groups", || {
            let samplers = material
                .maps()
                .map(|map| self.textures.sampler(map.map_or_else(Default::default, |map| map.wrap)));
            let mut resources = vec![uniform.as_entire_binding()];
            for (map, sampler) in material.maps().iter().zip(&samplers) {
                let view = map.and_then(|map| views.get(map.texture)).unwrap_or(&self.white);
                resources.push(wgpu::BindingResource::TextureView(view));
                resources.push(wgpu::BindingResource::Sampler(sampler));
            }
            let layout = &self.pipelines.material_layout;
            Ok(bind_group(&self.device, "material", layout, &resources))
        })
    }
}

fn uniform_group(device: &wgpu::Device, layout: &wgpu::BindGroupLayout, buffer: &wgpu::Buffer) -> wgpu::BindGroup {
    bind_group(device, "uniform", layout, &[buffer.as_entire_binding()])
}
