//! The vertex buffers that shaders read. A test compares them with the shaders' vertex structs.

use super::MaterialAttributes;
use crate::uniforms::{MaterialVertex, OverlayLineInstance, OverlayVertex, SurfaceLineInstance};

const POSITION: [wgpu::VertexAttribute; 1] = wgpu::vertex_attr_array![0 => Float32x3];
const NORMAL: [wgpu::VertexAttribute; 1] = wgpu::vertex_attr_array![1 => Float32x3];
const REGION: [wgpu::VertexAttribute; 1] = wgpu::vertex_attr_array![2 => Unorm8x4];
const MATERIAL: [wgpu::VertexAttribute; 2] = wgpu::vertex_attr_array![3 => Float32x4, 4 => Unorm8x4];

/// The vertex buffers of a surface's shape: positions, normals, region colours.
pub(crate) const SHAPE_BUFFERS: [Option<wgpu::VertexBufferLayout<'static>>; 3] = [
    Some(per_vertex(12, &POSITION)),
    Some(per_vertex(12, &NORMAL)),
    Some(per_vertex(4, &REGION)),
];

/// [`SHAPE_BUFFERS`] and the attributes that only materials read; with stride 0, all vertices read the one shared
/// entry.
pub(crate) const fn material_buffers(attributes: MaterialAttributes) -> [Option<wgpu::VertexBufferLayout<'static>>; 4] {
    let stride = match attributes {
        MaterialAttributes::PerVertex => size_of::<MaterialVertex>() as u64,
        MaterialAttributes::Shared => 0,
    };
    [
        Some(per_vertex(12, &POSITION)),
        Some(per_vertex(12, &NORMAL)),
        Some(per_vertex(4, &REGION)),
        Some(per_vertex(stride, &MATERIAL)),
    ]
}

/// The instance buffer of lines on the surface.
pub(crate) const SURFACE_LINE_BUFFER: wgpu::VertexBufferLayout<'static> = {
    const ATTRIBUTES: [wgpu::VertexAttribute; 6] = wgpu::vertex_attr_array![
        0 => Uint32x2, 1 => Uint32x2, 2 => Float32x2, 3 => Float32, 4 => Float32, 5 => Unorm8x4
    ];
    wgpu::VertexBufferLayout {
        array_stride: size_of::<SurfaceLineInstance>() as u64,
        step_mode: wgpu::VertexStepMode::Instance,
        attributes: &ATTRIBUTES,
    }
};

/// The vertex buffer of overlay triangles.
pub(crate) const OVERLAY_TRIANGLE_BUFFER: wgpu::VertexBufferLayout<'static> = {
    const ATTRIBUTES: [wgpu::VertexAttribute; 3] =
        wgpu::vertex_attr_array![0 => Float32x3, 1 => Unorm8x4, 2 => Float32];
    per_vertex(size_of::<OverlayVertex>() as u64, &ATTRIBUTES)
};

/// The instance buffer of overlay lines.
pub(crate) const OVERLAY_LINE_BUFFER: wgpu::VertexBufferLayout<'static> = {
    const ATTRIBUTES: [wgpu::VertexAttribute; 6] = wgpu::vertex_attr_array![
        0 => Float32x3, 1 => Float32, 2 => Float32x3, 3 => Float32, 4 => Unorm8x4, 5 => Unorm8x4
    ];
    wgpu::VertexBufferLayout {
        array_stride: size_of::<OverlayLineInstance>() as u64,
        step_mode: wgpu::VertexStepMode::Instance,
        attributes: &ATTRIBUTES,
    }
};

const fn per_vertex(
    array_stride: u64,
    attributes: &'static [wgpu::VertexAttribute],
) -> wgpu::VertexBufferLayout<'static> {
    wgpu::VertexBufferLayout {
        array_stride,
        step_mode: wgpu::VertexStepMode::Vertex,
        attributes,
    }
}
