//! Decodes PNG, JPEG, WebP and KTX2 to pixels, in full size or smaller.

use std::io::{self, BufRead, Cursor, Read, Seek, SeekFrom};

use ::image::{DynamicImage, ImageDecoder, ImageFormat, ImageReader, Limits};

use pliant_mesh::Cancel;

use crate::ImageError;
use crate::images::pixels::{LONGEST_SIDE_PX, Rgba8};
use crate::quote::quoted;

/// The contents of an image's header.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) struct Header {
    pub width: u32,
    pub height: u32,
    /// The bytes that decoding takes beside the encoded ones and the resulting pixels.
    pub decoding_bytes: u64,
}

impl Header {
    /// The size after `halvings`.
    pub fn size(&self, halvings: u32) -> [u32; 2] {
        [self.width, self.height].map(|side| (side >> halvings).max(1))
    }

    /// The bytes of the resulting pixels after `halvings`.
    pub fn pixel_bytes(&self, halvings: u32) -> u64 {
        let [width, height] = self.size(halvings);
        4 * u64::from(width) * u64::from(height)
    }
}

/// Reads an image's header, and no pixel.
pub(crate) fn header(encoded: &[u8]) -> Result<Header, ImageError> {
    if mime_type(encoded) == Some("image/ktx2") {
        let [width, height] = crate::images::ktx2::size(encoded)?;
        // The blocks, a byte a pixel, and their packed form.
        let decoding_bytes = 2 * u64::from(width) * u64::from(height);
        return Ok(Header {
            width,
            height,
            decoding_bytes,
        });
    }
    let never = Cancel::new();
    let (decoder, format) = decoder(encoded, &never)?;
    let (width, height) = decoder.dimensions();
    let pixels = u64::from(width) * u64::from(height);
    let beside = match format {
        // Every coefficient, in 16 bits and three channels, if they don't come block by block.
        Some(ImageFormat::Jpeg) if !comes_by_blocks(encoded) => 6 * pixels,
        Some(ImageFormat::WebP) => match encoded.get(12..16) {
            // A plane of the image's size and two of a quarter of that.
            Some(b"VP8 ") => 2 * pixels,
            Some(b"VP8L") => 4 * pixels,
            // A frame, and perhaps its alpha, or the canvas of an animation.
            _ => 8 * pixels,
        },
        _ => 0,
    };
    Ok(Header {
        width,
        height,
        decoding_bytes: decoder.total_bytes().saturating_add(beside),
    })
}

/// Decodes a PNG, JPEG, WebP or KTX2 (with Basis Universal in it), recognised by its first bytes, with each side halved
/// so many times. Images beyond 16384 pixels a side are refused. If `cancel` is raised, decoding ends with an error
/// when the decoder next asks for bytes, or at the next row that is halved.
pub(crate) fn decode(encoded: &[u8], halvings: u32, cancel: &Cancel) -> Result<Rgba8, ImageError> {
    if mime_type(encoded) == Some("image/ktx2") {
        let (image, left) = crate::images::ktx2::decode(encoded, halvings)?;
        return if left == 0 {
            Ok(image)
        } else {
            halved(image.into(), left, cancel)
        };
    }
    let (decoder, _) = decoder(encoded, cancel)?;
    let image = DynamicImage::from_decoder(decoder).map_err(|error| failed(&error))?;
    if halvings == 0 {
        return Ok(image.into());
    }
    halved(image, halvings, cancel)
}

/// Bytes that can't be read after a flag is raised. Decoders read a few kilobytes at a time, or everything.
struct Cancellable<'a> {
    bytes: Cursor<&'a [u8]>,
    cancel: &'a Cancel,
}

/// The bytes that a decoder gets at once.
const BLOCK: usize = 1 << 14;

impl Cancellable<'_> {
    fn check(&self) -> io::Result<()> {
        // The kind is not `Interrupted`, after which readers try again.
        self.cancel.check().map_err(io::Error::other)
    }
}

impl Read for Cancellable<'_> {
    fn read(&mut self, out: &mut [u8]) -> io::Result<usize> {
        self.check()?;
        self.bytes.read(out)
    }
}

impl BufRead for Cancellable<'_> {
    fn fill_buf(&mut self) -> io::Result<&[u8]> {
        self.check()?;
        let bytes = self.bytes.fill_buf()?;
        Ok(&bytes[..bytes.len().min(BLOCK)])
    }

    fn consume(&mut self, count: usize) {
        self.bytes.consume(count);
    }
}

impl Seek for Cancellable<'_> {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        self.bytes.seek(to)
    }
}

fn decoder<'a>(
    encoded: &'a [u8],
    cancel: &'a Cancel,
) -> Result<(impl ImageDecoder + 'a, Option<ImageFormat>), ImageError> {
    let bytes = Cursor::new(encoded);
    let mut reader = ImageReader::new(Cancellable { bytes, cancel })
        .with_guessed_format()
        .map_err(|error| failed(&error))?;
    let mut limits = Limits::default();
    limits.max_image_width = Some(LONGEST_SIDE_PX);
    limits.max_image_height = Some(LONGEST_SIDE_PX);
    limits.max_alloc = Some(u64::from(LONGEST_SIDE_PX) * u64::from(LONGEST_SIDE_PX) * 8);
    reader.limits(limits);
    let format = reader.format();
    Ok((reader.into_decoder().map_err(|error| failed(&error))?, format))
}

fn failed(error: &dyn std::fmt::Display) -> ImageError {
    // A decoder may end its sentence with a line break.
    let words = error.to_string().split_whitespace().collect::<Vec<_>>().join(" ");
    ImageError { reason: quoted(&words) }
}

/// Each pixel is the mean of those that it replaces. The loop takes a few rows at a time, so that no full copy is made.
fn halved(image: DynamicImage, halvings: u32, cancel: &Cancel) -> Result<Rgba8, ImageError> {
    let [width, height] = [image.width(), image.height()];
    let [new_width, new_height] = [width, height].map(|side| (side >> halvings).max(1));
    let bound = |at: u32, new: u32, old: u32| (u64::from(at) * u64::from(old) / u64::from(new)) as u32;
    let mut pixels = Vec::with_capacity(4 * new_width as usize * new_height as usize);
    for y in 0..new_height {
        cancel.check().map_err(|error| failed(&error))?;
        let (top, bottom) = (bound(y, new_height, height), bound(y + 1, new_height, height));
        let rows = image.crop_imm(0, top, width, bottom - top).into_rgba8();
        for x in 0..new_width {
            let (left, right) = (bound(x, new_width, width), bound(x + 1, new_width, width));
            let mut sum = [0_u64; 4];
            for row in rows.as_raw().chunks_exact(4 * width as usize) {
                for pixel in row[4 * left as usize..4 * right as usize].chunks_exact(4) {
                    sum.iter_mut()
                        .zip(pixel)
                        .for_each(|(sum, &channel)| *sum += u64::from(channel));
                }
            }
            let count = u64::from(right - left) * u64::from(bottom - top);
            pixels.extend(sum.map(|sum| ((sum + count / 2) / count) as u8));
        }
    }
    Ok(Rgba8 {
        width: new_width,
        height: new_height,
        pixels,
    })
}

impl From<DynamicImage> for Rgba8 {
    fn from(image: DynamicImage) -> Self {
        let image = image.into_rgba8();
        Self {
            width: image.width(),
            height: image.height(),
            pixels: image.into_raw(),
        }
    }
}

impl From<Rgba8> for DynamicImage {
    fn from(image: Rgba8) -> Self {
        // A complete image has as many bytes as its size requires.
        ::image::RgbaImage::from_raw(image.width, image.height, image.pixels)
            .unwrap_or_default()
            .into()
    }
}

/// Returns true if a JPEG's blocks come one after the other with all of their channels, so that a decoder keeps a row
/// of them: neither progressive nor channel by channel.
fn comes_by_blocks(encoded: &[u8]) -> bool {
    let mut at = 2;
    let mut channels = None;
    while let Some(&[0xff, marker, high, low]) = encoded.get(at..).and_then(|rest| rest.first_chunk()) {
        match marker {
            0xff => {
                at += 1;
                continue;
            }
            0xc0 | 0xc1 => channels = encoded.get(at + 9),
            0xda => return channels.is_some() && channels == encoded.get(at + 4),
            _ => {}
        }
        at += 2 + usize::from(u16::from_be_bytes([high, low]));
    }
    false
}

/// The MIME type for an image's first bytes, for glTF; `None` for formats that no glTF extension has.
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

#[cfg(test)]
#[path = "decode_tests.rs"]
mod tests;
