//! The icon in every system's form, made of the pictures in `packaging/icons`.

use std::path::Path;

use crate::files;

/// The sides in pixels of the pictures.
pub const SIZES: [u32; 8] = [16, 24, 32, 48, 64, 128, 256, 512];

/// A picture as PNG.
fn picture(size: u32) -> Result<Vec<u8>, String> {
    files::read(&crate::root::root().join(format!("packaging/icons/{size}.png")))
}

/// Puts the pictures and the drawing into an icon theme, in the layout of the freedesktop specification.
///
/// # Errors
/// One sentence naming the picture.
pub fn put(theme: &Path) -> Result<(), String> {
    for size in SIZES {
        files::write(&theme.join(format!("{size}x{size}/apps/pliant.png")), picture(size)?)?;
    }
    let drawing = files::text("packaging/pliant.svg")?;
    files::write(&theme.join("scalable/apps/pliant.svg"), drawing)
}

/// The icon for Windows: a header, an entry of 16 bytes for each picture up to 256 pixels, then the PNGs.
///
/// # Errors
/// One sentence naming the picture.
pub fn ico() -> Result<Vec<u8>, String> {
    let sizes: Vec<u32> = SIZES.into_iter().filter(|&size| size <= 256).collect();
    let pictures = sizes.iter().map(|&size| picture(size)).collect::<Result<Vec<_>, _>>()?;
    let mut bytes = [0_u16, 1, sizes.len() as u16].map(u16::to_le_bytes).concat();
    let mut offset = 6 + 16 * sizes.len();
    for (&size, picture) in sizes.iter().zip(&pictures) {
        // A side of 256 is written as 0.
        bytes.extend([size as u8, size as u8, 0, 0, 1, 0, 32, 0]);
        bytes.extend((picture.len() as u32).to_le_bytes());
        bytes.extend((offset as u32).to_le_bytes());
        offset += picture.len();
    }
    bytes.extend(pictures.concat());
    Ok(bytes)
}

/// The icon for macOS: the name of each size, the length with its header, and the PNG.
///
/// # Errors
/// One sentence naming the picture.
pub fn icns() -> Result<Vec<u8>, String> {
    let mut body = Vec::new();
    for (kind, size) in [
        (b"icp4", 16),
        (b"icp5", 32),
        (b"icp6", 64),
        (b"ic07", 128),
        (b"ic08", 256),
        (b"ic09", 512),
    ] {
        let picture = picture(size)?;
        body.extend(kind);
        body.extend((picture.len() as u32 + 8).to_be_bytes());
        body.extend(picture);
    }
    let length = (body.len() as u32 + 8).to_be_bytes();
    Ok([b"icns".as_slice(), &length, &body].concat())
}

#[cfg(test)]
mod tests {
    use super::*;

    const PNG: &[u8] = b"\x89PNG\r\n\x1a\n";

    fn number(bytes: &[u8]) -> usize {
        bytes.iter().fold(0, |number, &byte| number << 8 | usize::from(byte))
    }

    #[test]
    fn every_picture_has_the_size_of_its_name() {
        for size in SIZES {
            let picture = picture(size).unwrap_or_default();
            assert!(picture.starts_with(PNG), "{size}");
            let sides = [&picture[16..20], &picture[20..24]].map(number);
            assert_eq!(sides, [size as usize; 2]);
        }
    }

    #[test]
    fn each_entry_of_an_ico_points_to_a_whole_png() {
        let ico = ico().unwrap_or_default();
        let count = usize::from(ico[4]);
        let mut end = 6 + 16 * count;
        for entry in ico[6..end].to_vec().chunks(16) {
            let at = |from: usize| number(&entry[from..from + 4].iter().rev().copied().collect::<Vec<_>>());
            assert_eq!(at(12), end);
            assert!(ico[end..].starts_with(PNG));
            end += at(8);
        }
        assert_eq!((count, end), (7, ico.len()));
    }

    #[test]
    fn the_parts_of_an_icns_fill_it() {
        let icns = icns().unwrap_or_default();
        assert_eq!(number(&icns[4..8]), icns.len());
        let mut at = 8;
        while at < icns.len() {
            assert!(icns[at + 8..].starts_with(PNG));
            at += number(&icns[at + 4..at + 8]);
        }
        assert_eq!(at, icns.len());
    }
}
