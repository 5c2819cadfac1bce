//! Textures read back into memory.

use std::sync::mpsc;

use crate::guard::guarded;
use crate::{Frame, Image, RenderError, Renderer, Samples, Target};

/// Pixels on their way from the device: rows padded to what the device wants.
#[derive(Debug)]
pub(crate) struct Readback {
    buffer: wgpu::Buffer,
    size_px: [u32; 2],
    padded_row: u32,
    mapped: mpsc::Receiver<Result<(), wgpu::BufferAsyncError>>,
}

/// Both of our formats have four bytes a pixel.
const PIXEL_BYTES: u32 = 4;

impl Readback {
    /// Adds a copy of part of a texture to `encoder` and submits it; `origin` and `size_px` lie inside the texture.
    pub(crate) fn submit(
        renderer: &Renderer,
        mut encoder: wgpu::CommandEncoder,
        texture: &wgpu::Texture,
        origin: [u32; 2],
        size_px: [u32; 2],
    ) -> Self {
        let padded_row = (PIXEL_BYTES * size_px[0]).next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT);
        let buffer = renderer.device().create_buffer(&wgpu::BufferDescriptor {
            label: Some("readback"),
            size: u64::from(padded_row) * u64::from(size_px[1]),
            usage: wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        encoder.copy_texture_to_buffer(
            wgpu::TexelCopyTextureInfo {
                origin: wgpu::Origin3d {
                    x: origin[0],
                    y: origin[1],
                    z: 0,
                },
                ..texture.as_image_copy()
            },
            wgpu::TexelCopyBufferInfo {
                buffer: &buffer,
                layout: wgpu::TexelCopyBufferLayout {
                    offset: 0,
                    bytes_per_row: Some(padded_row),
                    rows_per_image: Some(size_px[1]),
                },
            },
            wgpu::Extent3d {
                width: size_px[0],
                height: size_px[1],
                depth_or_array_layers: 1,
            },
        );
        renderer.queue().submit([encoder.finish()]);
        let (sender, mapped) = mpsc::channel();
        buffer.slice(..).map_async(wgpu::MapMode::Read, move |result| {
            // Nobody listens any more when the request was dropped: that is fine.
            let _ = sender.send(result);
        });
        Self {
            buffer,
            size_px,
            padded_row,
            mapped,
        }
    }

    /// The pixels' bytes if they have arrived.
    pub(crate) fn poll(&self, renderer: &Renderer) -> Option<Result<Vec<u8>, RenderError>> {
        // An error means that the device is lost; then the channel says so below.
        let _ = renderer.device().poll(wgpu::PollType::Poll);
        match self.mapped.try_recv() {
            Ok(result) => Some(self.bytes(result)),
            Err(mpsc::TryRecvError::Empty) => None,
            Err(mpsc::TryRecvError::Disconnected) => Some(Err(LOST)),
        }
    }

    /// The pixels' bytes, waiting for them.
    pub(crate) fn wait(&self, renderer: &Renderer) -> Result<Vec<u8>, RenderError> {
        renderer
            .device()
            .poll(wgpu::PollType::wait_indefinitely())
            .map_err(|_| LOST)?;
        let result = self.mapped.try_recv().map_err(|_| LOST)?;
        self.bytes(result)
    }

    fn bytes(&self, mapped: Result<(), wgpu::BufferAsyncError>) -> Result<Vec<u8>, RenderError> {
        mapped.map_err(|_| LOST)?;
        let view = self.buffer.slice(..).get_mapped_range().map_err(|_| LOST)?;
        let row = (PIXEL_BYTES * self.size_px[0]) as usize;
        let mut bytes = Vec::with_capacity(row * self.size_px[1] as usize);
        for padded in view.chunks_exact(self.padded_row as usize) {
            bytes.extend_from_slice(&padded[..row]);
        }
        Ok(bytes)
    }
}

const LOST: RenderError = RenderError::Lost {
    doing: "reading a picture back",
};

impl Renderer {
    /// Reads a target back, waiting for it; `None` while it is empty.
    ///
    /// # Errors
    /// Memory, or a device that stopped answering.
    pub fn read(&self, target: &Target) -> Result<Option<Image>, RenderError> {
        let Some(attachments) = target.attachments() else {
            return Ok(None);
        };
        let size_px = attachments.size_px;
        let readback = guarded(self.device(), "while reading a picture back", || {
            let encoder = self.device().create_command_encoder(&Default::default());
            Ok(Readback::submit(self, encoder, &attachments.colour, [0, 0], size_px))
        })?;
        let [width, height] = size_px;
        Ok(Some(Image {
            width,
            height,
            rgba: readback.wait(self)?,
        }))
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
        let mut target = Target::new();
        target.resize(self, size_px, samples)?;
        self.draw(&target, frame)?;
        let [width, height] = size_px;
        self.read(&target)?.ok_or(RenderError::EmptyPicture { width, height })
    }
}
