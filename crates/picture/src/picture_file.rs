//! Pictures as PNG files.

use std::io::Cursor;

use egui::ecolor::{gamma_from_linear, linear_from_gamma};
use pliant_render::Image;

use pliant_engine::EngineError;

/// The picture with straight colours. The renderer's are premultiplied by alpha, in linear light.
pub fn straight(mut picture: Image) -> Image {
    picture.rgba.chunks_exact_mut(4).for_each(straighten);
    picture
}

/// A picture of the renderer as PNG bytes, whose colours are straight.
///
/// # Errors
/// The encoder's.
pub fn png(picture: Image) -> Result<Vec<u8>, EngineError> {
    let picture = straight(picture);
    let refuse = |reason: String| EngineError::System(format!("the picture can't be written as PNG: {reason}"));
    let Image { width, height, rgba } = picture;
    let image = image::RgbaImage::from_raw(width, height, rgba).ok_or_else(|| refuse("it is incomplete".to_owned()))?;
    let mut png = Cursor::new(Vec::new());
    image
        .write_to(&mut png, image::ImageFormat::Png)
        .map_err(|error| refuse(error.to_string()))?;
    Ok(png.into_inner())
}

/// Divides a pixel's colour by its alpha, in linear light.
fn straighten(pixel: &mut [u8]) {
    let alpha = f32::from(pixel[3]) / 255.0;
    if alpha == 0.0 || pixel[3] == 255 {
        return;
    }
    for channel in &mut pixel[..3] {
        let light = linear_from_gamma(f32::from(*channel) / 255.0);
        let encoded = gamma_from_linear((light / alpha).min(1.0));
        *channel = (255.0 * encoded).round() as u8;
    }
}

#[cfg(test)]
mod tests {
    use super::straighten;

    #[test]
    fn a_half_covered_pixel_has_the_whole_colour_and_half_the_alpha() {
        // Half the light of 200 is 147 in sRGB.
        let mut pixel = [147, 147, 0, 128];
        straighten(&mut pixel);
        assert!(
            pixel[0].abs_diff(200) <= 2 && pixel[2] == 0 && pixel[3] == 128,
            "{pixel:?}"
        );
        let mut whole = [12, 34, 56, 255];
        straighten(&mut whole);
        assert_eq!(whole, [12, 34, 56, 255]);
    }
}
