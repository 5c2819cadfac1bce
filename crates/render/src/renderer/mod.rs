//! The renderer: draws frames on one device.

pub(crate) mod frame;
mod pictures;
mod prepared;
mod recording;
mod resources;

use self::prepared::{PreparedFrame, matcap_of};
use self::recording::{Recorder, begin_picture};
pub(crate) use self::resources::Resources;
use crate::device::buffers::refill;
use crate::device::guard::guarded;
use crate::device::opening::is_software;
use crate::device::timer::Timer;
use crate::frame::overlay::OverlayBatch;
use crate::surface::draw_calls::Batching;
use crate::surface::shadow::ShadowTools;
use crate::{Borders, Detail, Frame, Gpu, Grid, RenderError, Samples, Shading, Surface, Target, Wireframe};

/// Draws frames on one device. Create one per device and keep it.
#[derive(Debug)]
pub struct Renderer {
    pub(crate) gpu: Gpu,
    pub(crate) resources: Resources,
    shadow_tools: Option<ShadowTools>,
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
        let gpu = Gpu::new(device, queue)?;
        Ok(Self {
            resources: Resources::new(&gpu)?,
            gpu,
            shadow_tools: None,
            timer: Timer::new(device, queue),
        })
    }

    /// The device with its pipelines, which surfaces and materials are made on.
    pub fn gpu(&self) -> &Gpu {
        &self.gpu
    }

    /// The device.
    pub fn device(&self) -> &wgpu::Device {
        &self.gpu.device
    }

    /// Its queue.
    pub fn queue(&self) -> &wgpu::Queue {
        &self.gpu.queue
    }

    /// The device's name, to be shown to the user.
    pub fn device_name(&self) -> String {
        self.gpu.device.adapter_info().name
    }

    /// Returns true if the device is a software renderer on the CPU. Drawing is slow there, so use
    /// [`crate::Samples::One`] during interaction.
    pub fn is_software(&self) -> bool {
        is_software(&self.gpu.device)
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
        self.gpu
            .device
            .poll(wgpu::PollType::wait_indefinitely())
            .map_err(|_| lost)?;
        if let Some(timer) = &mut self.timer {
            timer.collect(&self.gpu.device, wgpu::PollType::Poll);
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
        self.resources
            .write_frame(&self.gpu, frame, attachments.size_px, background_span)?;
        let prepared = self.prepare(frame, attachments.samples)?;
        let Gpu {
            device,
            queue,
            pipelines,
            ..
        } = &self.gpu;
        let recorder = Recorder {
            pipelines,
            resources: &self.resources,
        };
        guarded(device, "while drawing", || {
            let mut encoder = device.create_command_encoder(&Default::default());
            let writes = self.timer.as_mut().and_then(|timer| timer.writes(device));
            let is_timed = writes.is_some();
            let mut pass = begin_picture(&mut encoder, attachments, writes);
            recorder.record(&mut pass, &prepared, attachments.samples);
            drop(pass);
            if let (true, Some(timer)) = (is_timed, &self.timer) {
                timer.resolve(&mut encoder);
            }
            queue.submit([encoder.finish()]);
            if let (true, Some(timer)) = (is_timed, &mut self.timer) {
                timer.submitted();
            }
            Ok(())
        })
    }

    /// Creates and uploads the resources of the frame.
    fn prepare<'a>(&mut self, frame: &'a Frame<'a>, samples: Samples) -> Result<PreparedFrame<'a>, RenderError> {
        let overlays = OverlayBatch::of(frame.overlays);
        let (gpu, resources) = (&mut self.gpu, &mut self.resources);
        let (device, queue) = (&gpu.device, &gpu.queue);
        resources.overlay_triangles.fill(device, queue, &overlays.vertices)?;
        resources.overlay_lines.fill(device, queue, &overlays.lines)?;
        if let Some(grid) = frame.grid {
            refill(device, queue, &resources.grid_buffer, &[grid.uniform()])?;
        }
        let style = frame.style;
        if style.wireframe == Wireframe::On {
            frame
                .surfaces
                .iter()
                .try_for_each(|surface| surface.prepare_edges(gpu))?;
        }
        if style.borders == Borders::On {
            frame
                .surfaces
                .iter()
                .try_for_each(|surface| surface.prepare_borders(gpu))?;
        }
        let batching = if style.shading == Shading::Material {
            resources.prepare_environment(gpu)?;
            Batching::PerMaterial
        } else {
            resources.prepare_matcap(gpu, matcap_of(style.shading))?;
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
        for pipeline in prepared.pipelines() {
            gpu.pipelines.prepare(&gpu.device, pipeline, samples)?;
        }
        Ok(prepared)
    }

    /// Makes the shadow that [`crate::Shadows::On`] draws: that of the surface's present shape and of its shown
    /// triangles, on the plane of `ground`. It does not change when the surface moves, until it is made again.
    ///
    /// # Errors
    /// As [`Renderer::draw`].
    pub fn update_shadow(&mut self, surface: &mut Surface, ground: &Grid) -> Result<(), RenderError> {
        surface.update_shadow(&mut self.gpu, &mut self.shadow_tools, ground)
    }
}
