//! The renderer: what one device needs to draw, and the drawing itself.

use std::collections::HashMap;

use crate::bindings::bind_group;
use crate::buffers::{Streamed, filled, refill};
use crate::environment::environment;
use crate::guard::guarded;
use crate::headless::is_software;
use crate::overlay::OverlayBatch;
use crate::pipelines::{Alpha, Part, Pipeline, Pipelines};
use crate::surface::{Joining, Run};
use crate::surface_line::LineSet;
use crate::target::Attachments;
use crate::texture::TextureMaker;
use crate::timer::Timer;
use crate::uniforms::{FrameUniform, GridUniform};
use crate::{
    Background, Borders, Detail, Encoding, Faces, Frame, Matcap, Material, Outlines, RenderError, Samples, Shading,
    Surface, Target, TextureData, Wireframe, studio,
};

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
    grid_buffer: wgpu::Buffer,
    grid_group: wgpu::BindGroup,
    clays: HashMap<Matcap, wgpu::BindGroup>,
    environment: Option<wgpu::BindGroup>,
    overlay_triangles: Streamed,
    overlay_lines: Streamed,
    timer: Option<Timer>,
}

/// What a picture is drawn from, ready on the device.
struct Ready<'a> {
    frame: &'a Frame<'a>,
    overlays: OverlayBatch,
    /// Runs of every surface.
    runs: Vec<(&'a Surface, Vec<Run>)>,
}

/// Where a tile of a picture stands in it: the share of the background below it, and its own share.
pub(crate) const WHOLE: [f32; 2] = [0.0, 1.0];

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
            clays: HashMap::new(),
            environment: None,
            overlay_triangles: Streamed::new("overlay triangles"),
            overlay_lines: Streamed::new("overlay lines"),
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

    /// The device's name, for a person.
    pub fn device_name(&self) -> String {
        self.device.adapter_info().name
    }

    /// Whether the device is the processor itself, so that drawing is slow: take [`crate::Samples::One`] while
    /// something moves.
    pub fn is_software(&self) -> bool {
        is_software(&self.device)
    }

    /// How long the device worked on a drawing of late, in milliseconds by its own clock; `None` before the first
    /// answer and where it has no clock.
    pub fn device_ms(&self) -> Option<f64> {
        self.timer.as_ref()?.last_ms()
    }

    /// Waits until everything that was submitted is done.
    ///
    /// # Errors
    /// [`RenderError::Lost`] when the device does not answer.
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

    /// Draws a frame into a target and submits it, without waiting; an empty target draws nothing.
    ///
    /// # Errors
    /// Memory, or a device that refuses; the target then shows what it showed before or part of the frame.
    pub fn draw(&mut self, target: &Target, frame: &Frame<'_>) -> Result<(), RenderError> {
        self.draw_part(target, frame, WHOLE)
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
        let ready = self.prepare(frame, attachments.samples)?;
        let device = self.device.clone();
        guarded(&device, "while drawing", || {
            let mut encoder = self.device.create_command_encoder(&Default::default());
            let writes = self.timer.as_mut().and_then(|timer| timer.writes(&device));
            let is_timed = writes.is_some();
            let mut pass = begin_picture(&mut encoder, attachments, writes);
            self.record(&mut pass, &ready, attachments.samples);
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

    /// Makes and uploads whatever the frame needs.
    fn prepare<'a>(&mut self, frame: &'a Frame<'a>, samples: Samples) -> Result<Ready<'a>, RenderError> {
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
        let joining = if style.shading == Shading::Material {
            self.prepare_environment()?;
            Joining::OneMaterial
        } else {
            self.prepare_clay(matcap(style.shading))?;
            Joining::Any
        };
        let runs = frame.surfaces.iter().map(|&surface| match style.detail {
            Detail::Coarse if joining == Joining::Any && surface.has_coarse(frame.view) => {
                (surface, surface.coarse_runs())
            }
            Detail::Coarse | Detail::Full => (surface, surface.runs(frame.view, joining)),
        });
        let ready = Ready {
            frame,
            overlays,
            runs: runs.collect(),
        };
        let device = self.device.clone();
        for pipeline in ready.pipelines() {
            self.pipelines.prepare(&device, pipeline, samples)?;
        }
        Ok(ready)
    }

    fn prepare_environment(&mut self) -> Result<(), RenderError> {
        if self.environment.is_none() {
            self.environment = Some(environment(self)?);
        }
        Ok(())
    }

    fn prepare_clay(&mut self, matcap: Matcap) -> Result<(), RenderError> {
        if self.clays.contains_key(&matcap) {
            return Ok(());
        }
        let pixels = studio::texture(matcap);
        let texture = TextureData {
            width: 2 * studio::SIDE_PX,
            height: studio::SIDE_PX,
            rgba: &pixels,
            encoding: Encoding::Srgb,
        };
        let view = self.textures.texture(0, &texture)?;
        let usage = wgpu::BufferUsages::UNIFORM;
        let uniform = filled(
            &self.device,
            &self.queue,
            "clay uniform",
            usage,
            &[studio::uniform(matcap)],
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
                "clay",
                &self.pipelines.clay_layout,
                &resources,
            ))
        })?;
        self.clays.insert(matcap, group);
        Ok(())
    }

    /// Opaque triangles, then the background where nothing is, the ground, what is seen through, edges and marks.
    fn record(&self, pass: &mut wgpu::RenderPass<'_>, ready: &Ready<'_>, samples: Samples) {
        let style = ready.frame.style;
        let set = |pass: &mut wgpu::RenderPass<'_>, pipeline| match self.pipelines.get(pipeline, samples) {
            Some(pipeline) => pass.set_pipeline(pipeline),
            None => debug_assert!(false, "{pipeline:?} was not prepared"),
        };
        pass.set_bind_group(0, &self.frame_group, &[]);
        let is_material = style.shading == Shading::Material;
        let draw_runs = |pass: &mut wgpu::RenderPass<'_>, is_wanted: &dyn Fn(&Run) -> bool| {
            for (surface, runs) in &ready.runs {
                surface.bind(pass);
                let mut page = usize::MAX;
                for run in runs.iter().filter(|run| is_wanted(run)) {
                    if run.page != page {
                        page = run.page;
                        surface.bind_shape(pass, page, run.detail);
                        surface.bind_look(pass, page);
                    }
                    if is_material {
                        set(pass, Pipeline::Material(run.alpha, surface.look()));
                        pass.set_bind_group(2, surface.material(run.material), &[]);
                    }
                    pass.draw_indexed(3 * run.triangles.start..3 * run.triangles.end, 0, 0..1);
                }
            }
        };
        if is_material {
            pass.set_bind_group(3, self.environment.as_ref(), &[]);
            draw_runs(pass, &|run| run.alpha != Alpha::Blend);
        } else {
            set(pass, clay_pipeline(style.shading));
            pass.set_bind_group(2, self.clays.get(&matcap(style.shading)), &[]);
            draw_runs(pass, &|_| true);
        }
        if matches!(style.background, Background::Gradient { .. }) {
            set(pass, Pipeline::Background);
            pass.draw(0..3, 0..1);
        }
        if ready.frame.grid.is_some() {
            set(pass, Pipeline::Grid);
            pass.set_bind_group(1, &self.grid_group, &[]);
            pass.draw(0..4, 0..1);
        }
        if is_material {
            draw_runs(pass, &|run| run.alpha == Alpha::Blend);
        }
        for (surface, _) in &ready.runs {
            surface.bind(pass);
            if style.wireframe == Wireframe::On {
                set(pass, Pipeline::Wireframe);
                for page in surface.pages() {
                    let Some(edges) = page.edges() else { continue };
                    pass.set_vertex_buffer(0, page.positions.slice(..));
                    pass.set_index_buffer(edges.buffer.slice(..), wgpu::IndexFormat::Uint32);
                    pass.draw_indexed(0..edges.index_count, 0, 0..1);
                }
            }
            let draw_lines = |pass: &mut wgpu::RenderPass<'_>, lines: &LineSet, part| {
                set(pass, Pipeline::SurfaceLines(part));
                pass.set_bind_group(2, &lines.positions, &[]);
                pass.set_vertex_buffer(0, lines.lines.slice(..));
                pass.draw(0..4, 0..lines.count);
            };
            if style.outlines == Outlines::On {
                let outlines = surface.outlines().iter().flatten();
                outlines.for_each(|lines| draw_lines(pass, lines, Part::Visible));
            }
            if style.borders == Borders::On {
                for lines in surface.borders().iter().flatten() {
                    Part::BOTH.into_iter().for_each(|part| draw_lines(pass, lines, part));
                }
            }
        }
        for layer in &ready.overlays.layers {
            if let (Some(buffer), false) = (self.overlay_triangles.buffer(), layer.vertices.is_empty()) {
                pass.set_vertex_buffer(0, buffer.slice(..));
                for part in Part::BOTH {
                    set(pass, Pipeline::OverlayTriangles(part));
                    pass.draw(layer.vertices.clone(), 0..1);
                }
            }
            if let (Some(buffer), false) = (self.overlay_lines.buffer(), layer.lines.is_empty()) {
                pass.set_vertex_buffer(0, buffer.slice(..));
                for part in Part::BOTH {
                    set(pass, Pipeline::OverlayLines(part));
                    pass.draw(0..4, layer.lines.clone());
                }
            }
        }
    }

    pub(crate) fn write_frame(
        &self,
        frame: &Frame<'_>,
        size_px: [u32; 2],
        background_span: [f32; 2],
    ) -> Result<(), RenderError> {
        let uniform = frame_uniform(frame, size_px, background_span);
        refill(&self.device, &self.queue, &self.frame_buffer, &[uniform])
    }

    pub(crate) fn frame_group(&self) -> &wgpu::BindGroup {
        &self.frame_group
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

    /// A bind group for each of the given materials, and for the default one after them.
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

    /// A bind group of a material and its images (white ones in place of those that it lacks).
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

impl Ready<'_> {
    /// The pipelines that the drawing sets.
    fn pipelines(&self) -> Vec<Pipeline> {
        let style = self.frame.style;
        let mut pipelines = Vec::new();
        if style.shading == Shading::Material {
            for (surface, runs) in &self.runs {
                pipelines.extend(runs.iter().map(|run| Pipeline::Material(run.alpha, surface.look())));
            }
            pipelines.dedup();
        } else {
            pipelines.push(clay_pipeline(style.shading));
        }
        if matches!(style.background, Background::Gradient { .. }) {
            pipelines.push(Pipeline::Background);
        }
        if self.frame.grid.is_some() {
            pipelines.push(Pipeline::Grid);
        }
        if style.wireframe == Wireframe::On {
            pipelines.push(Pipeline::Wireframe);
        }
        for part in Part::BOTH {
            if style.borders == Borders::On || style.outlines == Outlines::On {
                pipelines.push(Pipeline::SurfaceLines(part));
            }
            if !self.overlays.vertices.is_empty() {
                pipelines.push(Pipeline::OverlayTriangles(part));
            }
            if !self.overlays.lines.is_empty() {
                pipelines.push(Pipeline::OverlayLines(part));
            }
        }
        pipelines
    }
}

/// The pipeline of every shading but the file's materials.
fn clay_pipeline(shading: Shading) -> Pipeline {
    match shading {
        Shading::Clay(_) | Shading::Material => Pipeline::Clay,
        Shading::Painted => Pipeline::Painted,
        Shading::Zebra => Pipeline::Zebra,
        Shading::Normals => Pipeline::Normals,
    }
}

/// The clay whose studio lights a shading.
fn matcap(shading: Shading) -> Matcap {
    match shading {
        Shading::Clay(matcap) => matcap,
        _ => Matcap::Plaster,
    }
}

fn uniform_group(device: &wgpu::Device, layout: &wgpu::BindGroupLayout, buffer: &wgpu::Buffer) -> wgpu::BindGroup {
    bind_group(device, "uniform", layout, &[buffer.as_entire_binding()])
}

fn frame_uniform(frame: &Frame<'_>, size_px: [u32; 2], background_span: [f32; 2]) -> FrameUniform {
    let view = frame.view;
    let colour = |[r, g, b]: [u8; 3]| [r, g, b, 255].map(|byte| f32::from(byte) / 255.0);
    let (top, bottom) = match frame.style.background {
        Background::Gradient { top, bottom } => (colour(top), colour(bottom)),
        Background::Transparent => ([0.0; 4], [0.0; 4]),
    };
    FrameUniform {
        clip_from_world: view.clip_from_world.to_cols_array_2d(),
        view_from_world: view.view_from_world.to_cols_array_2d(),
        background_top: top,
        background_bottom: bottom,
        size_px: size_px.map(|side| side as f32),
        background_span,
        region_share: frame.style.region_share.clamp(0.0, 1.0),
        scale_px: view.clip_from_world.row(1).truncate().length() * 0.5 * size_px[1] as f32,
        perspective: if view.is_perspective() { 1.0 } else { 0.0 },
        flatness: match frame.style.faces {
            Faces::Smooth => 0.0,
            Faces::Flat => 1.0,
        },
        pixels_per_point: frame.style.pixels_per_point,
        ..bytemuck::Zeroable::zeroed()
    }
}

fn begin_picture<'a>(
    encoder: &'a mut wgpu::CommandEncoder,
    attachments: &Attachments,
    timestamp_writes: Option<wgpu::RenderPassTimestampWrites<'_>>,
) -> wgpu::RenderPass<'a> {
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
        timestamp_writes,
        ..Default::default()
    })
}
