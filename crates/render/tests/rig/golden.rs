//! Comparison with golden pictures, with one tolerance for all.

use std::path::Path;

use pliant_render::{Image, Renderer};

/// The largest difference of a byte, and how many pixels may differ more: another version of the same driver may round
/// differently along silhouettes.
const BYTE_TOLERANCE: u8 = 6;
const STRAY_SHARE: f64 = 0.01;

/// Compares a picture with the golden `folder/name.png`; panics if they differ.
pub fn compare(renderer: &Renderer, folder: &Path, name: &str, image: &Image) {
    let path = folder.join(name).with_extension("png");
    let Image { width, height, rgba } = image;
    let ours = image::RgbaImage::from_raw(*width, *height, rgba.clone()).unwrap();
    if std::env::var_os("PLIANT_KEEP_PICTURES").is_some() {
        ours.save(path).unwrap();
        return;
    }
    if !renderer.device_name().contains("llvmpipe") {
        #[expect(clippy::print_stderr, reason = "a skipped test says so")]
        {
            eprintln!(
                "skipped: the picture {name} was made by llvmpipe, not {}",
                renderer.device_name()
            );
        }
        return;
    }
    let theirs = image::open(&path)
        .unwrap_or_else(|error| panic!("{name}: {error}"))
        .into_rgba8();
    assert_eq!(ours.dimensions(), theirs.dimensions(), "{name}");
    let strays = ours.pixels().zip(theirs.pixels()).filter(|(a, b)| {
        let apart = a.0.iter().zip(b.0).map(|(&a, b)| a.abs_diff(b));
        apart.max().unwrap() > BYTE_TOLERANCE
    });
    let strays = strays.count();
    if strays as f64 > STRAY_SHARE * f64::from(width * height) {
        let new = path.with_extension("new.png");
        ours.save(&new).unwrap();
        panic!("{name}: {strays} pixels differ; look at {}", new.display());
    }
}
