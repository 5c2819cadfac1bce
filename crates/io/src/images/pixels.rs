//! A decoded image.

/// An image as 8-bit pixels, sRGB as encoded, rows from the top.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Rgba8 {
    /// Pixels in a row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// `width` × `height` times red, green, blue, alpha.
    pub pixels: Vec<u8>,
}

/// The longest side that is decoded.
pub(crate) const LONGEST_SIDE_PX: u32 = 16_384;
