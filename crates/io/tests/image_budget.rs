//! All images of a document are decoded within one budget: large ones are decoded smaller, and those that can't be are
//! refused before decoding.
//!
//! This is the only test in its program, because it counts the memory of all threads.
#![allow(clippy::unwrap_used, clippy::expect_used, reason = "a test fails by panicking")]

#[path = "../examples/counting/mod.rs"]
mod counting;

use std::io::Cursor;
use std::sync::atomic::Ordering;

use counting::{Counting, HELD, PEAK};
use image::{DynamicImage, ImageFormat, Rgba, RgbaImage};
use pliant_io::{DecodedImage, ImageError, decode_images};
use pliant_mesh::{Cancel, Cancelled};

#[global_allocator]
static ALLOCATOR: Counting = Counting;

const MIB: u64 = 1 << 20;

/// An image of a few hundred bytes or more, and a mean colour of 64, 128 and 192.
fn encoded(format: ImageFormat, side: u32) -> Vec<u8> {
    let pixel = |x: u32, y: u32| {
        let by = if (x + y).is_multiple_of(2) { 32 } else { 0 };
        Rgba([48 + by, 112 + by, 176 + by, 255])
    };
    let picture = DynamicImage::from(RgbaImage::from_fn(side, side, pixel));
    let picture = if format == ImageFormat::Jpeg {
        picture.into_rgb8().into()
    } else {
        picture
    };
    let mut out = Cursor::new(Vec::new());
    picture.write_to(&mut out, format).unwrap();
    out.into_inner()
}

/// The result, and the most bytes held on the way.
fn decoded(images: &[Vec<u8>], budget: u64) -> (Vec<Result<DecodedImage, ImageError>>, u64) {
    let images: Vec<&[u8]> = images.iter().map(Vec::as_slice).collect();
    let held = HELD.load(Ordering::Relaxed);
    PEAK.store(held, Ordering::Relaxed);
    let decoded = decode_images(&images, budget, &Cancel::new()).unwrap();
    (decoded, (PEAK.load(Ordering::Relaxed) - held) as u64)
}

#[test]
fn images_fit_into_their_budget_or_are_refused() {
    let kinds = [ImageFormat::Png, ImageFormat::Jpeg, ImageFormat::WebP];
    // The threads, and everything that is made once.
    decoded(&kinds.map(|kind| encoded(kind, 64)), 1 << 30);

    for kind in kinds {
        let images: Vec<Vec<u8>> = [1024, 1024, 512, 1024, 16, 1024].map(|side| encoded(kind, side)).into();
        let sizes = |images: &[Result<DecodedImage, ImageError>]| -> Vec<u32> {
            images
                .iter()
                .map(|image| image.as_ref().unwrap().pixels.width)
                .collect()
        };
        // Decoded side by side they take no more than each and its decoder do.
        let (whole, _) = decoded(&images, 1 << 30);
        assert_eq!(sizes(&whole), [1024, 1024, 512, 1024, 16, 1024], "{kind:?}");
        for budget in [18 * MIB, 16 * MIB, 14 * MIB] {
            let (smaller, peak) = decoded(&images, budget);
            assert!(peak <= budget + MIB, "{kind:?}: {peak} bytes were held of {budget}");
            let widths = sizes(&smaller);
            assert!(widths.contains(&512) && widths[4] == 16, "{kind:?}: {widths:?}");
            for image in smaller.iter().flatten() {
                assert!(image.stored_size[0] >= image.pixels.width);
                let count = image.pixels.pixels.len() as f64 / 4.0;
                for (channel, wanted) in [64.0, 128.0, 192.0, 255.0].into_iter().enumerate() {
                    let values = image.pixels.pixels.iter().skip(channel).step_by(4);
                    let mean = values.map(|&value| f64::from(value)).sum::<f64>() / count;
                    assert!((mean - wanted).abs() < 4.0, "{kind:?}: {mean} for {wanted}");
                }
            }
        }
        let (refused, peak) = decoded(&images[..1], 2 * MIB);
        assert!(peak < MIB, "{kind:?}: {peak} bytes were held for nothing");
        let sentence = refused[0].as_ref().unwrap_err().to_string();
        assert!(
            sentence.contains("1024 by 1024 pixels") && sentence.contains("2 MiB"),
            "{sentence}"
        );
    }

    let image = encoded(ImageFormat::Png, 64);
    let stopped = Cancel::new();
    stopped.cancel();
    assert_eq!(decode_images(&[&image], MIB, &stopped), Err(Cancelled));
    // A cancelled image stops in the middle: wherever its decoder reads, and at every row that is scaled.
    for kind in kinds {
        let image = encoded(kind, 512);
        let mut scaled = 0;
        for budget in [1 << 30, 5 * MIB / 2, 3 * MIB / 2] {
            let result = |looks| decode_images(&[&image], budget, &Cancel::after_looks(looks));
            let Ok(whole) = &result(usize::MAX).unwrap()[0] else {
                continue;
            };
            let rows = Some(whole.pixels.height as usize).filter(|&rows| rows < 512);
            scaled += usize::from(rows.is_some());
            for looks in [0, 1, 2, rows.unwrap_or(0) + 2] {
                assert_eq!(result(looks), Err(Cancelled), "{kind:?}: {looks} looks");
            }
        }
        assert!(scaled > 0, "{kind:?}");
    }
    // A KTX2 has smaller levels, or is scaled like others.
    let ktx2 = include_bytes!("corpus/ramp-uastc.ktx2").to_vec();
    let (small, _) = decoded(&[ktx2], 16 * 16 * 4);
    let small = small[0].as_ref().unwrap();
    assert_eq!((small.stored_size, small.pixels.width), ([16, 16], 8));
}
