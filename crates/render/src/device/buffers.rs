//! Buffers with contents, or a refusal that names size and limit.

use bytemuck::NoUninit;

use crate::RenderError;
use crate::device::guard::guarded;

/// A buffer with `contents`; never of size zero, since no device binds that.
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
    // Making and filling are two steps, so that a buffer for which there is no memory is never written to.
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

/// Replaces the start of a buffer by `contents`, which must fit.
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

/// A buffer that is filled anew for each drawing and grows when it must.
#[derive(Debug)]
pub(crate) struct DynamicBuffer {
    what: &'static str,
    buffer: Option<wgpu::Buffer>,
}

impl DynamicBuffer {
    /// An empty one.
    pub(crate) fn new(what: &'static str) -> Self {
        Self { what, buffer: None }
    }

    /// Its new contents; the buffer is there unless they are empty.
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
