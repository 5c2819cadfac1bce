//! Pictures in memory: reading textures back, and drawing in tiles.

use crate::device::guard::guarded;
use crate::device::readback::{PIXEL_BYTES, Readback};
use crate::{Frame, Image, RenderError, Renderer, Samples, Target};

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
        let readback = guarded(&self.gpu.device, "while reading a picture back", || {
            let encoder = self.gpu.device.create_command_encoder(&Default::default());
            Ok(Readback::submit(
                &self.gpu.device,
                &self.gpu.queue,
                encoder,
                texture,
                [0, 0],
                [width, height],
            ))
        })?;
        let rgba = readback.wait(&self.gpu.device)?;
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
        let side = tile_px.clamp(1, self.gpu.device.limits().max_texture_dimension_2d);
        let mut target = Target::new();
        for y in (0..height).step_by(side as usize) {
            for x in (0..width).step_by(side as usize) {
                let part_px = [side.min(width - x), side.min(height - y)];
                target.resize(&self.gpu.device, part_px, samples)?;
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
