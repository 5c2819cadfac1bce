//! Images of every kind that is read, recognised by their first bytes; broken ones are refused in a sentence.
#![allow(clippy::unwrap_used, clippy::expect_used, reason = "a test fails by panicking")]

use std::io::Cursor;

use image::{ImageFormat, RgbaImage};
use pliant_mesh::Cancel;

use crate::ImageError;
use crate::images::pixels::Rgba8;

fn decoded(encoded: &[u8]) -> Result<Rgba8, ImageError> {
    super::decode(encoded, 0, &Cancel::new())
}

/// Red rises to the right, green downwards; the left half is opaque.
fn ramp(x: u32, y: u32) -> [u8; 4] {
    [(x * 16) as u8, (y * 16) as u8, 128, if x < 8 { 255 } else { 64 }]
}

/// Each kind with the expected pixels.
fn encoded() -> Vec<(&'static str, Vec<u8>, RgbaImage)> {
    let picture = RgbaImage::from_fn(16, 16, |x, y| image::Rgba(ramp(x, y)));
    let written = |format| {
        let mut out = Cursor::new(Vec::new());
        picture.write_to(&mut out, format).unwrap();
        out.into_inner()
    };
    // Basis Universal is lossy: its pixels are those of the reference transcoder.
    let reference = |png: &[u8]| image::load_from_memory(png).unwrap().into_rgba8();
    vec![
        ("PNG", written(ImageFormat::Png), picture.clone()),
        ("WebP", written(ImageFormat::WebP), picture.clone()),
        (
            "KTX2, ETC1S",
            include_bytes!("../../tests/corpus/ramp-etc1s.ktx2").to_vec(),
            reference(include_bytes!("../../tests/corpus/ramp-etc1s.png")),
        ),
        (
            "KTX2, UASTC",
            include_bytes!("../../tests/corpus/ramp-uastc.ktx2").to_vec(),
            reference(include_bytes!("../../tests/corpus/ramp-uastc.png")),
        ),
    ]
}

#[test]
fn every_kind_gives_its_pixels() {
    for (name, bytes, wanted) in encoded() {
        let decoded = decoded(&bytes).unwrap_or_else(|error| panic!("{name}: {error}"));
        assert_eq!((decoded.width, decoded.height), (16, 16), "{name}");
        assert!(decoded.pixels == *wanted.as_raw(), "{name}");
    }
}

#[test]
fn whatever_length_a_ktx2_tells_of_its_keys_it_is_read_and_no_further() {
    let sound = include_bytes!("../../tests/corpus/ramp-uastc.ktx2");
    let pixels = decoded(sound).unwrap().pixels;
    for length in 0..60_u32 {
        let mut file = sound.to_vec();
        file[60..64].copy_from_slice(&length.to_le_bytes());
        assert!(decoded(&file).unwrap().pixels == pixels, "{length}");
    }
}

#[test]
fn jpeg_gives_nearly_its_pixels() {
    let picture = image::RgbImage::from_fn(16, 16, |x, y| image::Rgb([40 + 4 * x as u8, 200 - 4 * y as u8, 90]));
    let mut out = Cursor::new(Vec::new());
    picture.write_to(&mut out, ImageFormat::Jpeg).unwrap();
    let decoded = decoded(&out.into_inner()).unwrap();
    assert_eq!((decoded.width, decoded.height), (16, 16));
    for (found, wanted) in decoded.pixels.chunks_exact(4).zip(picture.pixels()) {
        let off = (0..3).map(|k| found[k].abs_diff(wanted.0[k])).max().unwrap();
        assert!(off <= 24 && found[3] == 255, "{found:?} for {wanted:?}");
    }
}

#[test]
fn broken_images_are_refused_in_a_sentence_and_never_panic() {
    let mut random = 1_u64;
    let mut next = move |below: usize| {
        random = random
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (random >> 33) as usize % below
    };
    for (name, bytes, _) in encoded() {
        for length in (0..bytes.len()).step_by(7) {
            if let Err(error) = decoded(&bytes[..length]) {
                assert!(!error.to_string().contains('\n'), "{name}");
            }
        }
        for _ in 0..400 {
            let mut broken = bytes.clone();
            for _ in 0..=next(4) {
                let at = next(broken.len());
                broken[at] = next(256) as u8;
            }
            let _ = decoded(&broken);
        }
    }
}
