//! Images in: PNG, JPEG, WebP and KTX2 to pixels.

use std::io::Cursor;

use ::image::{ImageReader, Limits};

use crate::ImageError;
use crate::pixels::{LONGEST_SIDE_PX, Rgba8};

/// Decodes a PNG, JPEG, WebP or KTX2 (with Basis Universal in it), told by its first bytes. Images beyond 16384 pixels
/// a side are refused.
pub fn decode_image(encoded: &[u8]) -> Result<Rgba8, ImageError> {
    // A decoder may end its sentence with a line's end.
    let failed = |error: &dyn std::fmt::Display| ImageError {
        reason: error.to_string().split_whitespace().collect::<Vec<_>>().join(" "),
    };
    if mime_type(encoded) == Some("image/ktx2") {
        return crate::ktx2::decode(encoded);
    }
    let mut reader = ImageReader::new(Cursor::new(encoded))
        .with_guessed_format()
        .map_err(|error| failed(&error))?;
    let mut limits = Limits::default();
    limits.max_image_width = Some(LONGEST_SIDE_PX);
    limits.max_image_height = Some(LONGEST_SIDE_PX);
    limits.max_alloc = Some(u64::from(LONGEST_SIDE_PX) * u64::from(LONGEST_SIDE_PX) * 8);
    reader.limits(limits);
    let image = reader.decode().map_err(|error| failed(&error))?.into_rgba8();
    Ok(Rgba8 {
        width: image.width(),
        height: image.height(),
        pixels: image.into_raw(),
    })
}

/// The MIME type that an image's first bytes tell, for glTF; `None` for kinds that no glTF extension knows.
pub(crate) fn mime_type(encoded: &[u8]) -> Option<&'static str> {
    let is_webp = encoded.starts_with(b"RIFF") && encoded.get(8..12) == Some(b"WEBP");
    match encoded {
        [0x89, b'P', b'N', b'G', ..] => Some("image/png"),
        [0xff, 0xd8, 0xff, ..] => Some("image/jpeg"),
        [0xab, b'K', b'T', b'X', b' ', b'2', b'0', ..] => Some("image/ktx2"),
        _ if is_webp => Some("image/webp"),
        _ => None,
    }
}
