//! Images on surfaces: sRGB bytes in, a texture with mipmaps on the device.

/// An image of four sRGB bytes a pixel (alpha straight), rows from the top.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TextureData<'a> {
    /// Width in pixels, at least 1.
    pub width: u32,
    /// Height in pixels, at least 1.
    pub height: u32,
    /// `4 · width · height` bytes.
    pub rgba: &'a [u8],
    /// What lies beyond the borders, along u and v.
    pub wrap: [Wrap; 2],
}

/// What lies beyond an image's border.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Wrap {
    /// The image again.
    #[default]
    Repeat,
    /// The image mirrored, and again.
    Mirror,
    /// Its border pixels.
    Clamp,
}
