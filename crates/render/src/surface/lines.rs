//! Lines on the surface. Their ends lie on edges of triangles, so the lines follow the surface when it moves.

use crate::device::bindings::bind_group;
use crate::device::buffers::filled;
use crate::device::guard::guarded;
use crate::surface::pages::Page;
use crate::uniforms::SurfaceLineInstance;
use crate::{Gpu, RenderError};

/// A line segment inside one triangle or along an edge.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SurfaceLine {
    /// Start and end.
    pub ends: [EdgePoint; 2],
    /// Colour, sRGB with straight alpha.
    pub colour: [u8; 4],
    /// Width in points ([`crate::Style::pixels_per_point`]), more than zero.
    pub width_points: f32,
}

/// A point on the edge between two vertices.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EdgePoint {
    /// Indices of the two vertices.
    pub vertices: [u32; 2],
    /// Position between the first (0) and the second (1).
    pub share: f32,
}

impl EdgePoint {
    /// The point at a vertex.
    pub fn at(vertex: u32) -> Self {
        Self {
            vertices: [vertex; 2],
            share: 0.0,
        }
    }
}

/// Lines on one page of a surface, on the device.
#[derive(Debug)]
pub(crate) struct LineSet {
    pub(crate) lines: wgpu::Buffer,
    pub(crate) count: u32,
    pub(crate) positions: wgpu::BindGroup,
}

impl LineSet {
    /// Uploads those of `lines` whose vertices are all on the page; `None` if there are none. `hidden_share` is the
    /// factor of alpha for parts behind a surface.
    pub(crate) fn new(
        gpu: &Gpu,
        page: &Page,
        lines: impl Iterator<Item = SurfaceLine>,
        hidden_share: f32,
    ) -> Result<Option<Self>, RenderError> {
        let (device, queue) = (&gpu.device, &gpu.queue);
        let instance = |line: SurfaceLine| {
            let [start, end] = line.ends;
            let on_page = |[a, b]: [u32; 2]| Some([page.vertex(a)?, page.vertex(b)?]);
            Some(SurfaceLineInstance {
                start: on_page(start.vertices)?,
                end: on_page(end.vertices)?,
                shares: [start.share, end.share],
                width_points: line.width_points,
                hidden_share,
                colour: line.colour,
            })
        };
        let instances: Vec<SurfaceLineInstance> = lines.filter_map(instance).collect();
        if instances.is_empty() {
            return Ok(None);
        }
        let positions = guarded(device, "while making bind groups", || {
            let layout = &gpu.pipelines.positions_layout;
            Ok(bind_group(
                device,
                "positions",
                layout,
                &[page.positions.as_entire_binding()],
            ))
        })?;
        Ok(Some(Self {
            lines: filled(device, queue, "lines", wgpu::BufferUsages::VERTEX, &instances)?,
            count: instances.len() as u32,
            positions,
        }))
    }
}
