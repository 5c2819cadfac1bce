//! Reading textures back into memory.

use std::sync::mpsc;

use crate::RenderError;

/// Pixels on their way from the device; rows are padded to wgpu's copy alignment.
#[derive(Debug)]
pub(crate) struct Readback {
    buffer: wgpu::Buffer,
    size_px: [u32; 2],
    padded_row: u32,
    mapped: mpsc::Receiver<Result<(), wgpu::BufferAsyncError>>,
}

/// Bytes per pixel of both the colour and the id format.
pub(crate) const PIXEL_BYTES: u32 = 4;

impl Readback {
    /// Encodes a copy of part of a texture and submits `encoder`; the part must lie inside the texture.
    pub(crate) fn submit(
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        mut encoder: wgpu::CommandEncoder,
        texture: &wgpu::Texture,
        origin: [u32; 2],
        size_px: [u32; 2],
    ) -> Self {
        let padded_row = (PIXEL_BYTES * size_px[0]).next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT);
        let buffer = device.create_buffer(&wgpu::BufferDescriptor {
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
        queue.submit([encoder.finish()]);
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
    pub(crate) fn poll(&self, device: &wgpu::Device) -> Option<Result<Vec<u8>, RenderError>> {
        // An error means that the device is lost, which the channel reports below.
        let _ = device.poll(wgpu::PollType::Poll);
        match self.mapped.try_recv() {
            Ok(result) => Some(self.bytes(result)),
            Err(mpsc::TryRecvError::Empty) => None,
            Err(mpsc::TryRecvError::Disconnected) => Some(Err(LOST)),
        }
    }

    /// Waits for the pixels.
    pub(crate) fn wait(&self, device: &wgpu::Device) -> Result<Vec<u8>, RenderError> {
        device.poll(wgpu::PollType::wait_indefinitely()).map_err(|_| LOST)?;
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
