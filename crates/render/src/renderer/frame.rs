//! Everything that one frame shows.

use bytemuck::Zeroable;

use crate::uniforms::FrameUniform;
use crate::{Background, Faces, Grid, Overlay, Style, Surface, View};

/// Everything that one frame shows. Cheap to build for every frame.
#[derive(Debug, Clone, Copy)]
pub struct Frame<'a> {
    /// The point of view.
    pub view: &'a View,
    /// The look of surfaces.
    pub style: &'a Style,
    /// The surfaces, in any order. Transparent materials are drawn last, in this order.
    pub surfaces: &'a [&'a Surface],
    /// The ground grid, if it is shown.
    pub grid: Option<&'a Grid>,
    /// Overlays above the surfaces (gizmos, the brush ring), later ones over earlier ones.
    pub overlays: &'a [Overlay],
}

impl Frame<'_> {
    /// The uniform of the frame at `size_px`; `background_span` is a tile's part of the background.
    pub(crate) fn uniform(&self, size_px: [u32; 2], background_span: [f32; 2]) -> FrameUniform {
        let view = self.view;
        let colour = |[r, g, b]: [u8; 3]| [r, g, b, 255].map(|byte| f32::from(byte) / 255.0);
        let (top, bottom) = match self.style.background {
            Background::Gradient { top, bottom } => (colour(top), colour(bottom)),
            Background::Transparent => ([0.0; 4], [0.0; 4]),
        };
        FrameUniform {
            clip_from_world: view.clip_from_world.to_cols_array_2d(),
            view_from_world: view.view_from_world.to_cols_array_2d(),
            background_top: top,
            background_bottom: bottom,
            size_px: size_px.map(|side| side as f32),
            background_span,
            region_share: self.style.region_share.clamp(0.0, 1.0),
            scale_px: view.clip_from_world.row(1).truncate().length() * 0.5 * size_px[1] as f32,
            perspective: if view.is_perspective() { 1.0 } else { 0.0 },
            flatness: match self.style.faces {
                Faces::Smooth => 0.0,
                Faces::Flat => 1.0,
            },
            pixels_per_point: self.style.pixels_per_point,
            ..Zeroable::zeroed()
        }
    }
}
