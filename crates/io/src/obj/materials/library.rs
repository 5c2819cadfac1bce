//! One material library: the statements that are drawn, and the names of those that are not.

use std::collections::BTreeSet;

use crate::appearance::colour::linear_of_srgb;
use crate::appearance::{AlphaMode, Material};
use crate::text::{excerpt, mark_len};

/// The largest number of unread statements that are named.
const MOST_UNREAD: usize = 12;

/// The materials of a library.
///
/// `tobj` gives up (or panics, at a `Kd` with fewer than three numbers) on a line that it doesn't expect, so it gets
/// only the lines that matter here and that it can read.
pub(super) fn parse(text: &[u8], unread: &mut BTreeSet<String>) -> Vec<tobj::Material> {
    let text = String::from_utf8_lossy(&text[mark_len(text)..]);
    let mut kept = String::new();
    let mut is_named = false;
    for line in text.split(['\n', '\r']) {
        let line = line.trim();
        let mut words = line.split_whitespace();
        let is_wanted = match words.next() {
            Some("newmtl") => {
                is_named = words.next().is_some();
                is_named
            }
            Some("Kd") => {
                words
                    .by_ref()
                    .take(3)
                    .filter(|word| word.parse::<f32>().is_ok())
                    .count()
                    == 3
            }
            Some("d") => words.next().is_some_and(|word| word.parse::<f32>().is_ok()),
            Some("Tr" | "map_Kd") => words.next().is_some(),
            Some(other) => {
                if (is_other_map(other) || shines(other, words)) && unread.len() < MOST_UNREAD {
                    unread.insert(excerpt(other.as_bytes()));
                }
                false
            }
            None => false,
        };
        if is_wanted && is_named {
            kept.push_str(line);
            kept.push('\n');
        }
    }
    tobj::load_mtl_buf(&mut kept.as_bytes())
        .map(|(materials, _)| materials)
        .unwrap_or_default()
}

/// The names after all keywords for images, whether or not a material has them, with their options.
pub(super) fn image_names(text: &[u8]) -> BTreeSet<String> {
    let text = String::from_utf8_lossy(&text[mark_len(text)..]);
    let statements = text
        .split(['\n', '\r'])
        .filter_map(|line| line.trim().split_once(char::is_whitespace));
    let names = statements.filter(|(keyword, _)| *keyword == "map_Kd" || is_other_map(keyword));
    names.map(|(_, name)| name.trim().to_owned()).collect()
}

/// Returns true if a keyword names an image that isn't drawn.
pub(super) fn is_other_map(keyword: &str) -> bool {
    keyword.starts_with("map_") || matches!(keyword, "bump" | "disp" | "decal" | "refl" | "norm")
}

/// Returns true if a statement says that a surface shines or glows, in a number above zero.
fn shines<'a>(keyword: &str, mut numbers: impl Iterator<Item = &'a str>) -> bool {
    matches!(keyword, "Ks" | "Ke" | "Pr" | "Pm" | "Ps" | "Pc")
        && numbers.any(|word| word.parse::<f32>().is_ok_and(|number| number > 0.0))
}

/// Gives a material the base colour and the opacity of a stored one.
pub(super) fn set_base_colour(material: &mut Material, stored: &tobj::Material) {
    if let Some(diffuse) = stored
        .diffuse
        .filter(|diffuse| diffuse.iter().all(|channel| channel.is_finite()))
    {
        for (channel, value) in material.base_colour.iter_mut().zip(diffuse) {
            *channel = linear_of_srgb(value);
        }
    }
    let transparency = stored
        .unknown_param
        .get("Tr")
        .and_then(|value| value.trim().parse::<f32>().ok());
    let alpha = stored.dissolve.or(transparency.map(|value| 1.0 - value)).unwrap_or(1.0);
    if (0.0..1.0).contains(&alpha) {
        material.base_colour[3] = alpha;
        material.alpha = AlphaMode::Blend;
    }
}
