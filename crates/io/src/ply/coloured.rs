//! A PLY file with other colours of its vertices: over the old ones, or as three properties more.

use super::header::{Element, Kind};
use super::rewriting::{Out, record};
use super::scalar::{Encoding, Scalar, Walk};
use super::stored::{Stored, cannot_hold};
use crate::SaveError;
use crate::save::colours::unit;
use crate::text::Splice;

/// The bytes with a colour for each vertex, in sRGB. A vertex that nothing uses becomes white.
///
/// # Errors
/// A file without vertices, or one with colours that are lists.
pub(super) fn coloured(stored: &Stored, colours: &[Option<[u8; 4]>]) -> Result<Vec<u8>, SaveError> {
    let element = stored.vertex_element.map(|index| &stored.header.elements[index]);
    let element = element.ok_or_else(|| cannot_hold("colours without vertices".to_owned(), "save as .glb"))?;
    let colour_of = |vertex: usize| {
        let [red, green, blue, _] = colours.get(vertex).copied().flatten().unwrap_or([u8::MAX; 4]);
        [red, green, blue]
    };
    match stored.columns[6..9] {
        [Some(red), Some(green), Some(blue)] => recoloured(stored, element, [red, green, blue], colour_of),
        [None, None, None] => Ok(widened(stored, element, colour_of)),
        _ => {
            let what = "colours beside a red, a green or a blue alone".to_owned();
            Err(cannot_hold(what, "save as .glb"))
        }
    }
}

/// Writes over the old colours, in the range of their type.
fn recoloured(
    stored: &Stored,
    element: &Element,
    columns: [usize; 3],
    colour_of: impl Fn(usize) -> [u8; 3],
) -> Result<Vec<u8>, SaveError> {
    let mut out = Out::of(&stored.bytes, stored.header.encoding);
    let mut order = [0, 1, 2];
    order.sort_unstable_by_key(|&channel| columns[channel]);
    for vertex in 0..element.count as usize {
        let mut walk = Walk::new(&stored.bytes, stored.places.of(vertex), stored.header.encoding);
        let Some(numbers) = record(element, &mut walk) else {
            break;
        };
        let colour = colour_of(vertex);
        for channel in order {
            let (Kind::Scalar(scalar), Some(number)) = (
                element.properties[columns[channel]].kind,
                numbers[columns[channel]].first(),
            ) else {
                let what = "colours that are lists".to_owned();
                return Err(cannot_hold(what, "save as .glb"));
            };
            let value = f64::from(unit(colour[channel]));
            // As they are read: floating point counts to 1, most whole numbers to 255.
            let most = match scalar {
                Scalar::F32 | Scalar::F64 => 1.0,
                Scalar::U16 => 65_535.0,
                Scalar::I8 => {
                    let what = "colours in numbers that end at 127".to_owned();
                    return Err(cannot_hold(what, "save as .glb"));
                }
                _ => 255.0,
            };
            let whole = most > 1.0;
            out.set(number, scalar, if whole { (value * most).round() } else { value });
        }
    }
    Ok(out.finish())
}

/// Adds three properties behind the others.
fn widened(stored: &Stored, element: &Element, colour_of: impl Fn(usize) -> [u8; 3]) -> Vec<u8> {
    let header = &stored.header;
    let mut splice = Splice::new(&stored.bytes);
    let (at, line_end) = end_of_properties(&stored.bytes[..header.data_at]);
    splice.replace(at..at, |out| {
        for name in ["red", "green", "blue"] {
            out.extend_from_slice(format!("property uchar {name}").as_bytes());
            out.extend_from_slice(line_end);
        }
    });
    for vertex in 0..element.count as usize {
        let mut walk = Walk::new(&stored.bytes, stored.places.of(vertex), header.encoding);
        if record(element, &mut walk).is_none() {
            break;
        }
        splice.replace(walk.at()..walk.at(), |out| {
            for channel in colour_of(vertex) {
                match header.encoding {
                    Encoding::Ascii => out.extend_from_slice(format!(" {channel}").as_bytes()),
                    _ => out.push(channel),
                }
            }
        });
    }
    splice.finish()
}

/// The place behind the last property of the vertices in a header, and the header's line ending.
fn end_of_properties(header: &[u8]) -> (usize, &'static [u8]) {
    let has_returns = header.contains(&b'\r');
    let line_end: &[u8] = match (has_returns, header.contains(&b'\n')) {
        (true, true) => b"\r\n",
        (true, false) => b"\r",
        _ => b"\n",
    };
    let (mut at, mut end, mut is_of_vertices) = (0, 0, false);
    for line in header.split_inclusive(|byte| *byte == line_end[line_end.len() - 1]) {
        at += line.len();
        let mut words = line.split(u8::is_ascii_whitespace).filter(|word| !word.is_empty());
        match (words.next(), words.next()) {
            (Some(b"element"), name) => {
                is_of_vertices = name == Some(b"vertex");
                if is_of_vertices {
                    end = at;
                }
            }
            (Some(b"property"), _) if is_of_vertices => end = at,
            _ => {}
        }
    }
    (end, line_end)
}
