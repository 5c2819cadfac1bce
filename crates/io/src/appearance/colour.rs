//! Colours between the sRGB that scan formats store and the linear light that is drawn.

/// The linear light of an sRGB channel, both from 0 to 1. f32: colours are only ever drawn and saved in 8 bits.
pub(crate) fn linear_of_srgb(channel: f32) -> f32 {
    let channel = channel.clamp(0.0, 1.0);
    if channel <= 0.040_45 {
        channel / 12.92
    } else {
        ((channel + 0.055) / 1.055).powf(2.4)
    }
}

/// The sRGB channel of some linear light, both from 0 to 1.
pub(crate) fn srgb_of_linear(light: f32) -> f32 {
    let light = light.clamp(0.0, 1.0);
    if light <= 0.003_130_8 {
        light * 12.92
    } else {
        1.055 * light.powf(1.0 / 2.4) - 0.055
    }
}

/// A channel from 0 to 1 in 8 bits; what isn't a number is 0.
pub(crate) fn byte(channel: f32) -> u8 {
    (channel * 255.0).round() as u8
}

/// sRGB bytes of linear bytes, as a table.
pub(crate) fn srgb_bytes_of_linear() -> [u8; 256] {
    std::array::from_fn(|value| byte(srgb_of_linear(value as f32 / 255.0)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_two_curves_undo_each_other() {
        for value in 0..=255 {
            let channel = value as f32 / 255.0;
            assert!((srgb_of_linear(linear_of_srgb(channel)) - channel).abs() < 1e-5);
        }
        let srgb = srgb_bytes_of_linear();
        assert_eq!((srgb[0], srgb[255]), (0, 255));
        assert!(srgb.windows(2).all(|pair| pair[0] <= pair[1]));
        assert_eq!(byte(f32::NAN), 0);
    }
}
