//! Marks above the surfaces: lines of a width in pixels and flat triangles, in the world's coordinates.

/// A layer of marks, drawn after the surfaces: triangles first, then lines, each in order. What a surface hides is
/// drawn too, fainter, so that a gizmo inside a body can be grasped.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Overlay {
    /// Flat triangles, seen from both sides.
    pub triangles: Vec<OverlayTriangle>,
    /// Lines with round-looking, antialiased borders.
    pub lines: Vec<OverlayLine>,
    /// Alpha of the parts that surfaces hide, as a share of the visible parts' alpha: 0 hides them, 1 draws on top.
    pub hidden_share: f32,
}

/// A flat triangle; colours are sRGB with straight alpha.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OverlayTriangle {
    /// Corners in the world (relative to the centre).
    pub corners: [[f32; 3]; 3],
    /// Colour of each corner.
    pub colours: [[u8; 4]; 3],
}

/// A straight line; colours are sRGB with straight alpha.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OverlayLine {
    /// Both ends in the world (relative to the centre).
    pub ends: [[f32; 3]; 2],
    /// Colour of each end.
    pub colours: [[u8; 4]; 2],
    /// Width in pixels of the picture, more than zero.
    pub width_px: f32,
}
