//! Overlays above the surfaces: lines with a width in pixels and flat triangles, in world space.

use std::ops::Range;

use crate::uniforms::{OverlayLineInstance, OverlayVertex};

/// An overlay, drawn after the surfaces: triangles first, then lines, each in order. Parts behind a surface are drawn
/// fainter, so that a gizmo inside a body can still be grabbed.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Overlay {
    /// Flat, double-sided triangles.
    pub triangles: Vec<OverlayTriangle>,
    /// Antialiased lines.
    pub lines: Vec<OverlayLine>,
    /// Factor of alpha for parts behind a surface: 0 hides them, 1 draws them on top.
    pub hidden_share: f32,
}

/// A flat triangle; colours are sRGB with straight alpha.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OverlayTriangle {
    /// Corners in world space (relative to the centre).
    pub corners: [[f32; 3]; 3],
    /// Colour of each corner.
    pub colours: [[u8; 4]; 3],
}

/// A straight line; colours are sRGB with straight alpha.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OverlayLine {
    /// Both ends in world space (relative to the centre).
    pub ends: [[f32; 3]; 2],
    /// Colour of each end.
    pub colours: [[u8; 4]; 2],
    /// Width in pixels, more than zero.
    pub width_px: f32,
}

/// All overlays of a frame, ready to upload, with the range of each.
#[derive(Debug, Default)]
pub(crate) struct OverlayBatch {
    pub(crate) vertices: Vec<OverlayVertex>,
    pub(crate) lines: Vec<OverlayLineInstance>,
    pub(crate) layers: Vec<LayerRanges>,
}

/// An overlay's ranges in an [`OverlayBatch`].
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct LayerRanges {
    pub(crate) vertices: Range<u32>,
    pub(crate) lines: Range<u32>,
}

impl OverlayBatch {
    pub(crate) fn of(overlays: &[Overlay]) -> Self {
        let mut batch = Self::default();
        for overlay in overlays {
            let hidden_share = overlay.hidden_share;
            let (first_vertex, first_line) = (batch.vertices.len() as u32, batch.lines.len() as u32);
            for triangle in &overlay.triangles {
                for (&position, &colour) in triangle.corners.iter().zip(&triangle.colours) {
                    batch.vertices.push(OverlayVertex {
                        position,
                        colour,
                        hidden_share,
                    });
                }
            }
            batch.lines.extend(overlay.lines.iter().map(|line| OverlayLineInstance {
                start: line.ends[0],
                width_px: line.width_px,
                end: line.ends[1],
                hidden_share,
                start_colour: line.colours[0],
                end_colour: line.colours[1],
            }));
            batch.layers.push(LayerRanges {
                vertices: first_vertex..batch.vertices.len() as u32,
                lines: first_line..batch.lines.len() as u32,
            });
        }
        batch
    }
}
