//! The colours and textures of a part, which triangles name by the number of their group and an index in it.

use std::collections::HashMap;

/// A base material.
#[derive(Debug)]
pub(super) struct Base {
    pub name: String,
    /// Red, green, blue and alpha in sRGB.
    pub colour: [u8; 4],
}

/// The groups of a part by their numbers.
#[derive(Debug, Default)]
pub(super) struct Resources {
    pub bases: HashMap<u32, Vec<Base>>,
    pub colours: HashMap<u32, Vec<[u8; 4]>>,
    /// The paths of images in the archive.
    pub textures: HashMap<u32, String>,
    /// A texture's number, and coordinates with v up.
    pub coordinates: HashMap<u32, (u32, Vec<[f32; 2]>)>,
}

/// A colour as `#RRGGBB` or `#RRGGBBAA`; white for anything else.
pub(super) fn colour(text: &str) -> [u8; 4] {
    let digits = text.trim().strip_prefix('#').unwrap_or_default();
    let channel = |place: usize| {
        digits
            .get(2 * place..2 * place + 2)
            .map(|pair| u8::from_str_radix(pair, 16))
    };
    let [red, green, blue, alpha] = [0, 1, 2, 3].map(channel);
    match (red, green, blue) {
        (Some(Ok(red)), Some(Ok(green)), Some(Ok(blue))) => {
            [red, green, blue, alpha.and_then(Result::ok).unwrap_or(u8::MAX)]
        }
        _ => [u8::MAX; 4],
    }
}

/// The text of a colour.
pub(super) fn text_of([red, green, blue, alpha]: [u8; 4]) -> String {
    match alpha {
        u8::MAX => format!("#{red:02X}{green:02X}{blue:02X}"),
        _ => format!("#{red:02X}{green:02X}{blue:02X}{alpha:02X}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn colours_have_three_channels_or_four() {
        for (text, wanted) in [
            ("#FF8000", [255, 128, 0, 255]),
            ("#ff800040", [255, 128, 0, 64]),
            ("red", [255; 4]),
            ("#12", [255; 4]),
            ("#\u{e9}\u{e9}\u{e9}", [255; 4]),
        ] {
            assert_eq!(colour(text), wanted, "{text}");
        }
        assert_eq!(colour(&text_of([1, 2, 3, 4])), [1, 2, 3, 4]);
    }
}
