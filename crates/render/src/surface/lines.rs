//! Lines on the surface: their ends stand on edges of its triangles and follow it wherever it goes.

use crate::device::bindings::bind_group;
use crate::device::buffers::filled;
use crate::device::guard::guarded;
use crate::frame::uniforms::SurfaceLineInstance;
use crate::surface::pages::Page;
use crate::{RenderError, Renderer};

/// A straight piece within one triangle, or along an edge.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SurfaceLine {
    /// Where it starts and ends.
    pub ends: [EdgePoint; 2],
    /// Its colour, sRGB with straight alpha.
    pub colour: [u8; 4],
    /// Its width in points ([`crate::Style::pixels_per_point`]), more than zero.
    pub width_points: f32,
}

/// A point between two of a surface's vertices.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EdgePoint {
    /// The vertices' numbers.
    pub vertices: [u32; 2],
    /// How far it is from the first to the second, from 0 to 1.
    pub share: f32,
}

impl EdgePoint {
    /// The point of a vertex.
    pub(crate) fn at(vertex: u32) -> Self {
        Self {
            vertices: [vertex; 2],
            share: 0.0,
        }
    }
}

/// Lines on one page of a surface.
#[derive(Debug)]
pub(crate) struct LineSet {
    pub(crate) lines: wgpu::Buffer,
    pub(crate) count: u32,
    pub(crate) positions: wgpu::BindGroup,
}

impl LineSet {
    /// Those of `lines` whose vertices are all on the page; `None` if there are none. What the surface hides of them
    /// keeps `hidden_share` of its alpha.
    pub(crate) fn new(
        renderer: &Renderer,
        page: &Page,
        lines: impl Iterator<Item = SurfaceLine>,
        hidden_share: f32,
    ) -> Result<Option<Self>, RenderError> {
        let (device, queue) = (renderer.device(), renderer.queue());
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
            let layout = &renderer.pipelines.positions_layout;
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
