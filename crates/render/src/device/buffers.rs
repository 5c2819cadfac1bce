//! Filled GPU buffers; a buffer over the device's limit is an error that names both sizes.

use bytemuck::NoUninit;

use crate::RenderError;
use crate::device::guard::guarded;

/// A buffer filled with `contents`; at least 16 bytes, because empty buffers can't be bound.
pub(crate) fn filled<T: NoUninit>(
    device: &wgpu::Device,
    queue: &wgpu::Queue,
    what: &'static str,
    usage: wgpu::BufferUsages,
    contents: &[T],
) -> Result<wgpu::Buffer, RenderError> {
    let bytes: &[u8] = bytemuck::cast_slice(contents);
    let limit = device.limits().max_buffer_size;
    if bytes.len() as u64 > limit {
        return Err(RenderError::TooLarge {
            what,
            bytes: bytes.len() as u64,
            limit,
        });
    }
    // Create and fill in two steps, so that a buffer whose allocation failed is never written to.
    let buffer = guarded(device, "while making buffers", || {
        Ok(device.create_buffer(&wgpu::BufferDescriptor {
            label: Some(what),
            size: (bytes.len() as u64).next_multiple_of(4).max(16),
            usage: usage | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        }))
    })?;
    refill(device, queue, &buffer, contents)?;
    Ok(buffer)
}

/// Writes `contents`, which must fit, to the start of a buffer.
pub(crate) fn refill<T: NoUninit>(
    device: &wgpu::Device,
    queue: &wgpu::Queue,
    buffer: &wgpu::Buffer,
    contents: &[T],
) -> Result<(), RenderError> {
    if contents.is_empty() {
        return Ok(());
    }
    guarded(device, "while uploading", || {
        queue.write_buffer(buffer, 0, bytemuck::cast_slice(contents));
        Ok(())
    })
}

/// A vertex buffer that is refilled for each frame and grows when it must.
#[derive(Debug)]
pub(crate) struct DynamicBuffer {
    what: &'static str,
    buffer: Option<wgpu::Buffer>,
}

impl DynamicBuffer {
    pub(crate) fn new(what: &'static str) -> Self {
        Self { what, buffer: None }
    }

    /// Replaces the contents.
    pub(crate) fn fill<T: NoUninit>(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        contents: &[T],
    ) -> Result<(), RenderError> {
        let bytes = size_of_val(contents) as u64;
        match &self.buffer {
            Some(buffer) if buffer.size() >= bytes => refill(device, queue, buffer, contents),
            _ => {
                self.buffer = Some(filled(device, queue, self.what, wgpu::BufferUsages::VERTEX, contents)?);
                Ok(())
            }
        }
    }

    pub(crate) fn buffer(&self) -> Option<&wgpu::Buffer> {
        self.buffer.as_ref()
    }
}
