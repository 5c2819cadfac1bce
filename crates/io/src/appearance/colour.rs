//! Conversions between the sRGB of scan formats and the linear light that is drawn.

/// The linear light of an sRGB channel, both from 0 to 1. f32: colours are only ever drawn and saved in 16 bits or
/// less.
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

/// A channel from 0 to 1 in 8 bits; 0 for NaN.
pub(crate) fn byte(channel: f32) -> u8 {
    (channel * 255.0).round() as u8
}

/// A channel from 0 to 1 in 16 bits; 0 for NaN.
pub(crate) fn short(channel: f32) -> u16 {
    (channel * 65535.0).round() as u16
}

/// A colour in linear light, of sRGB channels and an alpha that are from 0 to 1.
pub(crate) fn linear_colour([r, g, b, alpha]: [f32; 4]) -> [u16; 4] {
    let [r, g, b] = [r, g, b].map(|channel| short(linear_of_srgb(channel)));
    [r, g, b, short(alpha)]
}

/// sRGB bytes of linear colours, as a table.
pub(crate) struct SrgbBytes(Vec<u8>);

impl SrgbBytes {
    pub fn new() -> Self {
        Self(
            (0..=u16::MAX)
                .map(|light| byte(srgb_of_linear(f32::from(light) / 65535.0)))
                .collect(),
        )
    }

    /// A linear colour as sRGB, with its alpha in 8 bits.
    pub fn of_linear(&self, [r, g, b, alpha]: [u16; 4]) -> [u8; 4] {
        let [r, g, b] = [r, g, b].map(|light| self.0[usize::from(light)]);
        [r, g, b, byte(f32::from(alpha) / 65535.0)]
    }
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
        let srgb = SrgbBytes::new();
        for value in 0..=255 {
            let colour = [value; 4];
            let linear = linear_colour(colour.map(|value| f32::from(value) / 255.0));
            assert_eq!(
                srgb.of_linear(linear),
                colour,
                "every sRGB byte survives 16 bits of light"
            );
        }
        assert_eq!(byte(f32::NAN), 0);
    }
}
