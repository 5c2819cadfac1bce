//! KTX2 with Basis Universal in it, as glTF's `KHR_texture_basisu` allows: one image of ETC1S or UASTC blocks.
//!
//! The header is checked here before the reader sees it, because the reader allocates the sizes in the header.

use std::ops::Range;

use basisu::{DecodeFlags, SourceFormat, TargetFormat, Transcoder};

use crate::ImageError;
use crate::images::pixels::{LONGEST_SIDE_PX, Rgba8};

const KEYS_LENGTH_AT: Range<usize> = 60..64;
const LEVELS_AT: usize = 80;
const LEVEL_BYTES: usize = 24;

/// Bytes of a block of 4 by 4 pixels.
const BLOCK_BYTES: u64 = 16;

fn failed(reason: &str) -> ImageError {
    ImageError {
        reason: format!("KTX2: {reason}"),
    }
}

/// The size in pixels in a KTX2 file's header.
pub(crate) fn size(encoded: &[u8]) -> Result<[u32; 2], ImageError> {
    checked_size(encoded).map(|(size, _)| size).map_err(failed)
}

/// The level of a KTX2 file that is `halvings` times smaller than its first one, or else its smallest, and the number
/// of remaining halvings.
pub(crate) fn decode(encoded: &[u8], halvings: u32) -> Result<(Rgba8, u32), ImageError> {
    let ([width, height], levels) = checked_size(encoded).map_err(failed)?;
    let level = halvings.min(levels - 1);
    // The reader continues beyond keys whose length is not a multiple of 4. One image needs none of them.
    let mut encoded = encoded.to_vec();
    encoded[KEYS_LENGTH_AT].fill(0);
    let image = Transcoder::new(&encoded).map_err(|_| failed("it has no complete Basis Universal image"))?;
    if !matches!(image.source_format(), SourceFormat::Etc1s | SourceFormat::UastcLdr) {
        return Err(failed("it has neither ETC1S nor UASTC data"));
    }
    let pixels = image
        .transcode(level, TargetFormat::Rgba32, DecodeFlags::NONE)
        .map_err(|error| failed(&format!("{error:?}")))?;
    let [width, height] = [width, height].map(|side| (side >> level).max(1));
    if pixels.len() != 4 * width as usize * height as usize {
        return Err(failed("a level does not have the size in its header"));
    }
    Ok((Rgba8 { width, height, pixels }, halvings - level))
}

/// The image's size in pixels and its levels, if the file is one image and has all bytes of its levels.
fn checked_size(encoded: &[u8]) -> Result<([u32; 2], u32), &'static str> {
    let word = |at: usize| Some(u32::from_le_bytes(*encoded.get(at..)?.first_chunk()?));
    let long = |at: usize| Some(u64::from_le_bytes(*encoded.get(at..)?.first_chunk()?));
    let header = (|| Some([word(20)?, word(24)?, word(28)?, word(32)?, word(36)?, word(40)?]))();
    let Some([width, height, depth, layers, faces, levels]) = header else {
        return Err("its header is cut short");
    };
    if !(1..=LONGEST_SIDE_PX).contains(&width) || !(1..=LONGEST_SIDE_PX).contains(&height) {
        return Err("it has no pixels, or too many");
    }
    if depth > 0 || layers > 1 || faces != 1 || !(1..=16).contains(&levels) {
        return Err("it is more than one image");
    }
    // The descriptor, the keys and the codebooks: the start and length of each.
    let parts = (|| {
        let (at, keys) = (u64::from(word(48)?), u64::from(word(56)?));
        Some([
            (at, u64::from(word(52)?)),
            (keys, u64::from(word(60)?)),
            (long(64)?, long(72)?),
        ])
    })();
    let is_whole = |(start, length): &(u64, u64)| {
        let end = start.checked_add(*length);
        end.is_some_and(|end| end <= encoded.len() as u64)
    };
    if !parts.is_some_and(|parts| parts.iter().all(is_whole)) {
        return Err("its parts do not match its header");
    }
    for level in 0..levels {
        let at = LEVELS_AT + level as usize * LEVEL_BYTES;
        let (Some(offset), Some(length), Some(unpacked)) = (long(at), long(at + 8), long(at + 16)) else {
            return Err("its header is cut short");
        };
        let blocks = |side: u32| u64::from((side >> level).max(1).div_ceil(4));
        let is_there = offset
            .checked_add(length)
            .is_some_and(|end| end <= encoded.len() as u64);
        if !is_there || unpacked > blocks(width) * blocks(height) * BLOCK_BYTES {
            return Err("its levels do not match its header");
        }
    }
    Ok(([width, height], levels))
}
