//! Reading textures back into memory.

use std::sync::mpsc;

use crate::device::guard::guarded;
use crate::{Frame, Image, RenderError, Renderer, Samples, Target};

/// Pixels on their way from the device; rows are padded to wgpu's copy alignment.
#[derive(Debug)]
pub(crate) struct Readback {
    buffer: wgpu::Buffer,
    size_px: [u32; 2],
    padded_row: u32,
    mapped: mpsc::Receiver<Result<(), wgpu::BufferAsyncError>>,
}

/// Bytes per pixel of both the colour and the id format.
const PIXEL_BYTES: u32 = 4;

impl Readback {
    /// Encodes a copy of part of a texture and submits `encoder`; the part must lie inside the texture.
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
            // The receiver is gone when the request was dropped, which is fine.
            let _ = sender.send(result);
        });
        Self {
            buffer,
            size_px,
            padded_row,
            mapped,
        }
    }

    /// The pixels if they have arrived; does not wait.
    pub(crate) fn poll(&self, renderer: &Renderer) -> Option<Result<Vec<u8>, RenderError>> {
        // An error means that the device is lost, which the channel reports below.
        let _ = renderer.device().poll(wgpu::PollType::Poll);
        match self.mapped.try_recv() {
            Ok(result) => Some(self.bytes(result)),
            Err(mpsc::TryRecvError::Empty) => None,
            Err(mpsc::TryRecvError::Disconnected) => Some(Err(LOST)),
        }
    }

    /// Waits for the pixels.
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
    /// Reads a target back and waits for it; `None` while the target is empty.
    ///
    /// # Errors
    /// Out of memory, or the device does not respond.
    pub fn read(&self, target: &Target) -> Result<Option<Image>, RenderError> {
        let Some(attachments) = target.attachments() else {
            return Ok(None);
        };
        self.read_texture(&attachments.colour).map(Some)
    }

    /// Reads back a texture of this device with four bytes per pixel and usage `COPY_SRC`, and waits for it.
    ///
    /// # Errors
    /// Out of memory, or the device does not respond or rejects the texture.
    pub fn read_texture(&self, texture: &wgpu::Texture) -> Result<Image, RenderError> {
        let (width, height) = (texture.width(), texture.height());
        let readback = guarded(self.device(), "while reading a picture back", || {
            let encoder = self.device().create_command_encoder(&Default::default());
            Ok(Readback::submit(self, encoder, texture, [0, 0], [width, height]))
        })?;
        let rgba = readback.wait(self)?;
        Ok(Image { width, height, rgba })
    }

    /// Draws a frame into memory and waits for it. Pictures larger than 2048 pixels a side are drawn in tiles, so
    /// neither the device's texture limit nor its memory limits their size.
    ///
    /// # Errors
    /// [`RenderError::EmptyPicture`], [`RenderError::OutOfMemory`] and as [`Renderer::draw`].
    pub fn draw_to_image(
        &mut self,
        size_px: [u32; 2],
        samples: Samples,
        frame: &Frame<'_>,
    ) -> Result<Image, RenderError> {
        self.draw_tiled(size_px, samples, frame, TILE_PX)
    }

    /// [`Renderer::draw_to_image`] with another tile size, to test that tiles join without a seam.
    ///
    /// # Errors
    /// As [`Renderer::draw_to_image`].
    pub fn draw_tiled(
        &mut self,
        size_px: [u32; 2],
        samples: Samples,
        frame: &Frame<'_>,
        tile_px: u32,
    ) -> Result<Image, RenderError> {
        let [width, height] = size_px;
        if width == 0 || height == 0 {
            return Err(RenderError::EmptyPicture { width, height });
        }
        let mut rgba = Vec::new();
        let row = PIXEL_BYTES as usize * width as usize;
        let bytes = row.saturating_mul(height as usize);
        let no_memory = |_| RenderError::PictureTooLarge { width, height };
        rgba.try_reserve_exact(bytes).map_err(no_memory)?;
        rgba.resize(bytes, 0);
        let side = tile_px.clamp(1, self.device().limits().max_texture_dimension_2d);
        let mut target = Target::new();
        for y in (0..height).step_by(side as usize) {
            for x in (0..width).step_by(side as usize) {
                let part_px = [side.min(width - x), side.min(height - y)];
                target.resize(self, part_px, samples)?;
                let view = frame.view.tile(size_px, [x, y], part_px);
                // The background gradient runs upwards from the picture's lower edge.
                let below = f64::from(height - y - part_px[1]) / f64::from(height);
                let span = [below as f32, (f64::from(part_px[1]) / f64::from(height)) as f32];
                self.draw_part(&target, &Frame { view: &view, ..*frame }, span)?;
                let Some(part) = self.read(&target)? else { continue };
                let part_row = PIXEL_BYTES as usize * part_px[0] as usize;
                for (line, pixels) in part.rgba.chunks_exact(part_row).enumerate() {
                    let at = (y as usize + line) * row + PIXEL_BYTES as usize * x as usize;
                    rgba[at..at + part_row].copy_from_slice(pixels);
                }
            }
        }
        Ok(Image { width, height, rgba })
    }
}

/// The largest side of a tile in pixels; four samples per pixel of it need 130 MB.
const TILE_PX: u32 = 2048;
