//! GPU time of a frame, measured by timestamp queries without waiting.

use std::sync::{Arc, OnceLock};

/// Timestamps at the beginning and end of a pass, read back asynchronously.
#[derive(Debug)]
pub(crate) struct Timer {
    queries: wgpu::QuerySet,
    resolved: wgpu::Buffer,
    readback: wgpu::Buffer,
    /// Set once the readback buffer is mapped: whether mapping succeeded.
    pending: Option<Arc<OnceLock<bool>>>,
    ms_per_tick: f64,
    last_ms: Option<f64>,
}

/// Size of two timestamps.
const BYTES: u64 = 16;

impl Timer {
    /// A timer, if the device supports timestamp queries.
    pub(crate) fn new(device: &wgpu::Device, queue: &wgpu::Queue) -> Option<Self> {
        if !device.features().contains(wgpu::Features::TIMESTAMP_QUERY) {
            return None;
        }
        let buffer = |usage| {
            device.create_buffer(&wgpu::BufferDescriptor {
                label: Some("time stamps"),
                size: BYTES,
                usage,
                mapped_at_creation: false,
            })
        };
        Some(Self {
            queries: device.create_query_set(&wgpu::QuerySetDescriptor {
                label: Some("time stamps"),
                ty: wgpu::QueryType::Timestamp,
                count: 2,
            }),
            resolved: buffer(wgpu::BufferUsages::QUERY_RESOLVE | wgpu::BufferUsages::COPY_SRC),
            readback: buffer(wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ),
            pending: None,
            ms_per_tick: f64::from(queue.get_timestamp_period()) * 1e-6,
            last_ms: None,
        })
    }

    /// The timestamp writes of a pass; `None` while the previous timestamps are still being read back.
    pub(crate) fn writes(&mut self, device: &wgpu::Device) -> Option<wgpu::RenderPassTimestampWrites<'_>> {
        self.collect(device, wgpu::PollType::Poll);
        self.pending.is_none().then_some(wgpu::RenderPassTimestampWrites {
            query_set: &self.queries,
            beginning_of_pass_write_index: Some(0),
            end_of_pass_write_index: Some(1),
        })
    }

    /// Encodes the readback after a pass that wrote timestamps.
    pub(crate) fn resolve(&self, encoder: &mut wgpu::CommandEncoder) {
        encoder.resolve_query_set(&self.queries, 0..2, &self.resolved, 0);
        encoder.copy_buffer_to_buffer(&self.resolved, 0, &self.readback, 0, BYTES);
    }

    /// Starts mapping, once the commands with the timestamps were submitted.
    pub(crate) fn submitted(&mut self) {
        let arrived = Arc::new(OnceLock::new());
        let arriving = Arc::clone(&arrived);
        self.readback.slice(..).map_async(wgpu::MapMode::Read, move |result| {
            // Only this callback sets it.
            let _ = arriving.set(result.is_ok());
        });
        self.pending = Some(arrived);
    }

    /// GPU time in milliseconds of the last frame whose timestamps have arrived.
    pub(crate) fn last_ms(&self) -> Option<f64> {
        self.last_ms
    }

    pub(crate) fn collect(&mut self, device: &wgpu::Device, poll: wgpu::PollType) {
        let Some(pending) = &self.pending else { return };
        // An error means that the device is lost, which drawing reports.
        let _ = device.poll(poll);
        let Some(&is_readable) = pending.get() else { return };
        self.pending = None;
        if !is_readable {
            return;
        }
        if let Ok(view) = self.readback.slice(..).get_mapped_range() {
            let stamps: &[u8] = &view;
            let tick = |at: usize| {
                let bytes = stamps.get(at..at + 8).and_then(|bytes| bytes.try_into().ok());
                bytes.map_or(0, u64::from_le_bytes)
            };
            self.last_ms = Some(tick(8).saturating_sub(tick(0)) as f64 * self.ms_per_tick);
        }
        self.readback.unmap();
    }
}
