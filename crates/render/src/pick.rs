//! Which triangles lie under the pointer.

use crate::{RenderError, Renderer};

/// The hidden target that triangle numbers are drawn into. Made to measure by [`Renderer::pick`].
#[derive(Debug, Default)]
pub struct IdTarget {}

impl IdTarget {
    /// An empty one.
    pub fn new() -> Self {
        Self::default()
    }
}

/// A rectangle of pixels, from the upper left corner of the picture.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct PixelRect {
    /// Left border, in pixels.
    pub x: u32,
    /// Upper border, in pixels.
    pub y: u32,
    /// Width in pixels.
    pub width: u32,
    /// Height in pixels.
    pub height: u32,
}

impl PixelRect {
    /// One pixel.
    pub fn pixel(x: u32, y: u32) -> Self {
        Self {
            x,
            y,
            width: 1,
            height: 1,
        }
    }
}

/// The triangle seen in a pixel.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Picked {
    /// Number of the surface among those of the frame.
    pub surface: u32,
    /// Number of its triangle.
    pub triangle: u32,
}

/// What a pick found: one entry a pixel, rows from the top.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct PickedIds {
    /// The rectangle, cut to the picture.
    pub rect: PixelRect,
    /// `width · height` entries; `None` where no surface is seen.
    pub ids: Vec<Option<Picked>>,
}

/// A pick whose answer is on its way.
#[derive(Debug)]
pub struct PickRequest {}

impl PickRequest {
    /// The answer if it has arrived, without waiting.
    pub fn poll(&mut self, renderer: &Renderer) -> Option<Result<PickedIds, RenderError>> {
        let _ = renderer;
        None
    }

    /// The answer, waiting for it.
    ///
    /// # Errors
    /// [`RenderError::Lost`] when the device does not answer.
    pub fn wait(self, renderer: &Renderer) -> Result<PickedIds, RenderError> {
        let _ = renderer;
        Err(RenderError::NoTriangleNumbers)
    }
}
