//! The structs that shaders read, laid out as WGSL lays them out. A test compares each with its namesake there.

use bytemuck::{Pod, Zeroable};

/// `Frame` in `shaders/lib/frame.wgsl`.
#[repr(C)]
#[derive(Debug, Clone, Copy, Pod, Zeroable)]
pub(crate) struct FrameUniform {
    pub(crate) clip_from_world: [[f32; 4]; 4],
    pub(crate) view_from_world: [[f32; 4]; 4],
    pub(crate) eye: [f32; 4],
    pub(crate) background_top: [f32; 4],
    pub(crate) background_bottom: [f32; 4],
    pub(crate) size_px: [f32; 2],
    pub(crate) region_share: f32,
    pub(crate) scale_px: f32,
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

/// `Material` in `shaders/surface.wgsl`.
#[repr(C)]
#[derive(Debug, Clone, Copy, Pod, Zeroable)]
pub(crate) struct MaterialUniform {
    pub(crate) base_colour: [f32; 4],
    pub(crate) alpha_cutoff: f32,
    pub(crate) back_share: f32,
    pub(crate) padding: [f32; 2],
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
