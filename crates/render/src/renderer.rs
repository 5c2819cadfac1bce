//! The renderer: pipelines of one device, and the drawing itself.

use crate::buffers::{Streamed, filled, refill};
use crate::guard::guarded;
use crate::overlay::OverlayBatch;
use crate::pipelines::{PicturePipelines, Pipelines, Softened};
use crate::target::Attachments;
use crate::texture::TextureMaker;
use crate::uniforms::{FrameUniform, MaterialUniform};
use crate::{AlphaMode, Background, Frame, RenderError, Shading, Target, Wireframe, Wrap};

/// The pipelines of one device. Make one a device and keep it.
#[derive(Debug)]
pub struct Renderer {
    device: wgpu::Device,
    queue: wgpu::Queue,
    pub(crate) pipelines: Pipelines,
    textures: TextureMaker,
    white: wgpu::TextureView,
    frame_buffer: wgpu::Buffer,
    frame_group: wgpu::BindGroup,
    overlay_triangles: Streamed,
    overlay_lines: Streamed,
}

impl Renderer {
    /// A renderer on a device (best asked for with [`crate::device_descriptor`]).
    ///
    /// # Errors
    /// [`RenderError::Refused`] or [`RenderError::OutOfMemory`] when the device does not take our shaders or buffers.
    pub fn new(device: &wgpu::Device, queue: &wgpu::Queue) -> Result<Self, RenderError> {
        let pipelines = guarded(device, "while starting to draw", || Ok(Pipelines::new(device)))?;
        let textures = guarded(device, "while starting to draw", || {
            Ok(TextureMaker::new(device, queue))
        })?;
        let white = textures.texture(
            0,
            &crate::TextureData {
                width: 1,
                height: 1,
                rgba: &[255; 4],
                wrap: [Wrap::Repeat; 2],
            },
        )?;
        let empty: FrameUniform = bytemuck::Zeroable::zeroed();
        let frame_buffer = filled(device, queue, "frame uniform", wgpu::BufferUsages::UNIFORM, &[empty])?;
        let frame_group = guarded(device, "while starting to draw", || {
            Ok(uniform_group(device, &pipelines.frame_layout, &frame_buffer))
        })?;
        Ok(Self {
            device: device.clone(),
            queue: queue.clone(),
            pipelines,
            textures,
            white,
            frame_buffer,
            frame_group,
            overlay_triangles: Streamed::new("overlay triangles"),
            overlay_lines: Streamed::new("overlay lines"),
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

    /// The device's name, for a person.
    pub fn device_name(&self) -> String {
        self.device.adapter_info().name
    }

    /// Whether the device is the processor itself, so that drawing is slow: take [`crate::Samples::One`] while
    /// something moves.
    pub fn is_software(&self) -> bool {
        self.device.adapter_info().device_type == wgpu::DeviceType::Cpu
    }

    /// Draws a frame into a target and submits it, without waiting; an empty target draws nothing.
    ///
    /// # Errors
    /// Memory, or a device that refuses; the target then shows what it showed before or part of the frame.
    pub fn draw(&mut self, target: &Target, frame: &Frame<'_>) -> Result<(), RenderError> {
        let Some(attachments) = target.attachments() else {
            return Ok(());
        };
        self.write_frame(frame, attachments.size_px)?;
        let overlays = OverlayBatch::of(frame.overlays);
        self.overlay_triangles
            .fill(&self.device, &self.queue, &overlays.vertices)?;
        self.overlay_lines.fill(&self.device, &self.queue, &overlays.lines)?;
        if frame.style.wireframe == Wireframe::On {
            for surface in frame.surfaces {
                surface.prepare_edges(&self.device, &self.queue)?;
            }
        }
        let pipelines = self.pipelines.picture(&self.device, attachments.samples)?;
        guarded(&self.device, "while drawing", || {
            let mut encoder = self.device.create_command_encoder(&Default::default());
            let mut pass = begin_picture(&mut encoder, attachments);
            pass.set_bind_group(0, &self.frame_group, &[]);
            draw_surfaces(&mut pass, pipelines, frame);
            for layer in &overlays.layers {
                if let (Some(buffer), false) = (self.overlay_triangles.buffer(), layer.vertices.is_empty()) {
                    pass.set_vertex_buffer(0, buffer.slice(..));
                    draw_softened(&mut pass, &pipelines.overlay_triangles, layer.vertices.clone(), 0..1);
                }
                if let (Some(buffer), false) = (self.overlay_lines.buffer(), layer.lines.is_empty()) {
                    pass.set_vertex_buffer(0, buffer.slice(..));
                    draw_softened(&mut pass, &pipelines.overlay_lines, 0..4, layer.lines.clone());
                }
            }
            drop(pass);
            self.queue.submit([encoder.finish()]);
            Ok(())
        })
    }

    pub(crate) fn write_frame(&self, frame: &Frame<'_>, size_px: [u32; 2]) -> Result<(), RenderError> {
        refill(
            &self.device,
            &self.queue,
            &self.frame_buffer,
            &[frame_uniform(frame, size_px)],
        )
    }

    pub(crate) fn frame_group(&self) -> &wgpu::BindGroup {
        &self.frame_group
    }

    pub(crate) fn pipelines(&self) -> &Pipelines {
        &self.pipelines
    }

    pub(crate) fn textures(&self) -> &TextureMaker {
        &self.textures
    }

    /// A bind group of one uniform buffer.
    pub(crate) fn uniform_group(
        &self,
        layout: &wgpu::BindGroupLayout,
        buffer: &wgpu::Buffer,
    ) -> Result<wgpu::BindGroup, RenderError> {
        guarded(&self.device, "while making bind groups", || {
            Ok(uniform_group(&self.device, layout, buffer))
        })
    }

    /// A bind group of a material and its texture (white without one).
    pub(crate) fn material_group(
        &self,
        uniform: &MaterialUniform,
        texture: Option<(&wgpu::TextureView, [Wrap; 2])>,
    ) -> Result<wgpu::BindGroup, RenderError> {
        let usage = wgpu::BufferUsages::UNIFORM;
        let buffer = filled(&self.device, &self.queue, "material uniform", usage, &[*uniform])?;
        let (view, wrap) = texture.unwrap_or((&self.white, [Wrap::Repeat; 2]));
        guarded(&self.device, "while making bind groups", || {
            let sampler = self.textures.sampler(wrap);
            Ok(self.device.create_bind_group(&wgpu::BindGroupDescriptor {
                label: Some("material"),
                layout: &self.pipelines.material_layout,
                entries: &[
                    wgpu::BindGroupEntry {
                        binding: 0,
                        resource: buffer.as_entire_binding(),
                    },
                    wgpu::BindGroupEntry {
                        binding: 1,
                        resource: wgpu::BindingResource::TextureView(view),
                    },
                    wgpu::BindGroupEntry {
                        binding: 2,
                        resource: wgpu::BindingResource::Sampler(&sampler),
                    },
                ],
            }))
        })
    }
}

fn uniform_group(device: &wgpu::Device, layout: &wgpu::BindGroupLayout, buffer: &wgpu::Buffer) -> wgpu::BindGroup {
    device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: None,
        layout,
        entries: &[wgpu::BindGroupEntry {
            binding: 0,
            resource: buffer.as_entire_binding(),
        }],
    })
}

fn frame_uniform(frame: &Frame<'_>, size_px: [u32; 2]) -> FrameUniform {
    let view = frame.view;
    let colour = |[r, g, b]: [u8; 3]| [r, g, b, 255].map(|byte| f32::from(byte) / 255.0);
    let (top, bottom) = match frame.style.background {
        Background::Gradient { top, bottom } => (colour(top), colour(bottom)),
        Background::Transparent => ([0.0; 4], [0.0; 4]),
    };
    FrameUniform {
        clip_from_world: view.clip_from_world.to_cols_array_2d(),
        view_from_world: view.view_from_world.to_cols_array_2d(),
        eye: view.eye.to_array(),
        background_top: top,
        background_bottom: bottom,
        size_px: size_px.map(|side| side as f32),
        region_share: frame.style.region_share.clamp(0.0, 1.0),
        scale_px: view.clip_from_world.row(1).truncate().length() * 0.5 * size_px[1] as f32,
    }
}

fn begin_picture<'a>(encoder: &'a mut wgpu::CommandEncoder, attachments: &Attachments) -> wgpu::RenderPass<'a> {
    let single = &attachments.colour_view;
    let (view, resolve_target, store) = match &attachments.multisampled {
        Some(samples) => (samples, Some(single), wgpu::StoreOp::Discard),
        None => (single, None, wgpu::StoreOp::Store),
    };
    encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        label: Some("picture"),
        color_attachments: &[Some(wgpu::RenderPassColorAttachment {
            view,
            depth_slice: None,
            resolve_target,
            ops: wgpu::Operations {
                load: wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT),
                store,
            },
        })],
        depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
            view: &attachments.depth,
            // Reversed depth: 0 is infinitely far away.
            depth_ops: Some(wgpu::Operations {
                load: wgpu::LoadOp::Clear(0.0),
                store: wgpu::StoreOp::Discard,
            }),
            stencil_ops: None,
        }),
        ..Default::default()
    })
}

/// Opaque triangles, then the background where nothing is, then what is seen through, then edges.
fn draw_surfaces(pass: &mut wgpu::RenderPass<'_>, pipelines: &PicturePipelines, frame: &Frame<'_>) {
    let surfaces = || frame.surfaces.iter().filter(|surface| surface.index_count() > 0);
    let draws_materials = frame.style.shading == Shading::Material;
    for surface in surfaces() {
        surface.bind(pass);
        if draws_materials {
            draw_batches(pass, pipelines, surface, |alpha| alpha != AlphaMode::Blend);
        } else {
            pass.set_pipeline(&pipelines.clay);
            pass.draw_indexed(0..surface.index_count(), 0, 0..1);
        }
    }
    if matches!(frame.style.background, Background::Gradient { .. }) {
        pass.set_pipeline(&pipelines.background);
        pass.draw(0..3, 0..1);
    }
    if draws_materials {
        for surface in surfaces() {
            surface.bind(pass);
            draw_batches(pass, pipelines, surface, |alpha| alpha == AlphaMode::Blend);
        }
    }
    if frame.style.wireframe == Wireframe::On {
        for surface in surfaces() {
            let index_count = surface.bind_edges(pass);
            if index_count > 0 {
                pass.set_pipeline(&pipelines.wireframe);
                pass.draw_indexed(0..index_count, 0, 0..1);
            }
        }
    }
}

fn draw_batches(
    pass: &mut wgpu::RenderPass<'_>,
    pipelines: &PicturePipelines,
    surface: &crate::Surface,
    is_wanted: impl Fn(AlphaMode) -> bool,
) {
    for batch in surface.batches().iter().filter(|batch| is_wanted(batch.alpha)) {
        pass.set_pipeline(match batch.alpha {
            AlphaMode::Opaque => &pipelines.material_opaque,
            AlphaMode::Mask { .. } => &pipelines.material_mask,
            AlphaMode::Blend => &pipelines.material_blend,
        });
        pass.set_bind_group(2, surface.material(batch.material), &[]);
        pass.draw_indexed(3 * batch.triangles.start..3 * batch.triangles.end, 0, 0..1);
    }
}

fn draw_softened(
    pass: &mut wgpu::RenderPass<'_>,
    pipelines: &Softened,
    vertices: std::ops::Range<u32>,
    instances: std::ops::Range<u32>,
) {
    for pipeline in [&pipelines.hidden, &pipelines.visible] {
        pass.set_pipeline(pipeline);
        pass.draw(vertices.clone(), instances.clone());
    }
}
