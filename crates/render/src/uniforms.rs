//! Uniform and vertex structs in WGSL's memory layout. A test compares each with its namesake in the shaders.

use bytemuck::{Pod, Zeroable};

/// `Frame` in `shaders/lib/frame.wgsl`.
#[repr(C)]
#[derive(Debug, Clone, Copy, Pod, Zeroable)]
pub(crate) struct FrameUniform {
    pub(crate) clip_from_world: [[f32; 4]; 4],
    pub(crate) view_from_world: [[f32; 4]; 4],
    pub(crate) background_top: [f32; 4],
    pub(crate) background_bottom: [f32; 4],
    pub(crate) size_px: [f32; 2],
    pub(crate) background_span: [f32; 2],
    pub(crate) region_share: f32,
    pub(crate) scale_px: f32,
    pub(crate) perspective: f32,
    pub(crate) flatness: f32,
    pub(crate) pixels_per_point: f32,
    pub(crate) padding: f32,
    pub(crate) padding_to_16: [f32; 2],
}

/// `Surface` in `shaders/lib/surface_vertex.wgsl`.
#[repr(C)]
#[derive(Debug, Clone, Copy, Pod, Zeroable)]
pub(crate) struct SurfaceUniform {
    pub(crate) id_base: u32,
    pub(crate) colours_are_linear: u32,
    pub(crate) mean_edge: f32,
    pub(crate) padding: u32,
}

/// `Matcap` in `shaders/surface.wgsl`.
#[repr(C)]
#[derive(Debug, Clone, Copy, Pod, Zeroable)]
pub(crate) struct MatcapUniform {
    pub(crate) colour: [f32; 4],
    pub(crate) inside: [f32; 4],
    pub(crate) on_regions: [f32; 4],
}

/// `Map` in `shaders/material.wgsl`.
#[repr(C)]
#[derive(Debug, Clone, Copy, Pod, Zeroable)]
pub(crate) struct MapUniform {
    pub(crate) u: [f32; 4],
    pub(crate) v: [f32; 4],
}

/// `Material` in `shaders/material.wgsl`.
#[repr(C)]
#[derive(Debug, Clone, Copy, Pod, Zeroable)]
pub(crate) struct MaterialUniform {
    pub(crate) base_colour: [f32; 4],
    pub(crate) emissive: [f32; 4],
    pub(crate) metallic: f32,
    pub(crate) roughness: f32,
    pub(crate) normal_scale: f32,
    pub(crate) occlusion_strength: f32,
    pub(crate) back_share: f32,
    pub(crate) flags: u32,
    pub(crate) padding: [f32; 2],
    pub(crate) metallic_roughness: MapUniform,
    pub(crate) normal: MapUniform,
    pub(crate) occlusion: MapUniform,
    pub(crate) emission: MapUniform,
}

/// `Face` in `shaders/environment.wgsl`.
#[repr(C)]
#[derive(Debug, Clone, Copy, Pod, Zeroable)]
pub(crate) struct EnvironmentUniform {
    pub(crate) right: [f32; 4],
    pub(crate) down: [f32; 4],
    pub(crate) forward: [f32; 4],
    pub(crate) roughness: f32,
    pub(crate) samples: u32,
    pub(crate) padding: [f32; 2],
}

/// `Grid` in `shaders/grid.wgsl`.
#[repr(C)]
#[derive(Debug, Clone, Copy, Pod, Zeroable)]
pub(crate) struct GridUniform {
    pub(crate) middle: [f32; 3],
    pub(crate) step: f32,
    pub(crate) along_u: [f32; 3],
    pub(crate) reach: f32,
    pub(crate) along_v: [f32; 3],
    pub(crate) fine_share: f32,
    pub(crate) axes: [f32; 2],
    pub(crate) padding: [f32; 2],
    pub(crate) colour: [f32; 4],
    pub(crate) u_axis_colour: [f32; 4],
    pub(crate) v_axis_colour: [f32; 4],
}

/// `Shadow` in `shaders/shadow.wgsl`.
#[repr(C)]
#[derive(Debug, Clone, Copy, Pod, Zeroable)]
pub(crate) struct ShadowUniform {
    pub(crate) middle: [f32; 3],
    pub(crate) half_side: f32,
    pub(crate) along_u: [f32; 3],
    pub(crate) padding: f32,
    pub(crate) along_v: [f32; 3],
    pub(crate) padding_to_16: f32,
}

/// `MaterialVertex` in `shaders/material.wgsl`.
#[repr(C)]
#[derive(Debug, Clone, Copy, Pod, Zeroable)]
pub(crate) struct MaterialVertex {
    pub(crate) uvs: [f32; 4],
    pub(crate) colour: [u8; 4],
}

/// `SurfaceLine` in `shaders/surface_line.wgsl`.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub(crate) struct SurfaceLineInstance {
    pub(crate) start: [u32; 2],
    pub(crate) end: [u32; 2],
    pub(crate) shares: [f32; 2],
    pub(crate) width_points: f32,
    pub(crate) hidden_share: f32,
    pub(crate) colour: [u8; 4],
}

/// `OverlayVertex` in `shaders/overlay_triangle.wgsl`.
#[repr(C)]
#[derive(Debug, Clone, Copy, Pod, Zeroable)]
pub(crate) struct OverlayVertex {
    pub(crate) position: [f32; 3],
    pub(crate) colour: [u8; 4],
    pub(crate) hidden_share: f32,
}

/// `OverlayLine` in `shaders/overlay_line.wgsl`.
#[repr(C)]
#[derive(Debug, Clone, Copy, Pod, Zeroable)]
pub(crate) struct OverlayLineInstance {
    pub(crate) start: [f32; 3],
    pub(crate) width_px: f32,
    pub(crate) end: [f32; 3],
    pub(crate) hidden_share: f32,
    pub(crate) start_colour: [u8; 4],
    pub(crate) end_colour: [u8; 4],
}
