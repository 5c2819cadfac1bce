//! A PLY file with some parts turned inside out: the corners of their faces in reverse, and normals with other signs.

use std::ops::Range;

use super::Stored;
use super::header::{Element, Kind};
use super::records::corner_list;
use super::scalar::{Encoding, Scalar, Walk, encode};
use crate::SaveError;
use crate::save::turned::{push_negated, wound_back};
use crate::text::Splice;

/// A number of a record, and where it stands.
type Number = (f64, Range<usize>);

/// The new bytes; `turned` tells of each vertex whether its part is turned.
///
/// # Errors
/// Strips of triangles, whose winding alternates.
pub(super) fn turned(stored: &Stored, bytes: &[u8], turned: &[bool]) -> Result<Vec<u8>, SaveError> {
    let header = &stored.header;
    let mut out = Out::of(bytes, header.encoding);
    let mut walk = Walk::new(bytes, header.data_at, header.encoding);
    for (index, element) in header.elements.iter().enumerate() {
        // Such records take no bytes.
        if element.properties.is_empty() {
            continue;
        }
        match element.name.as_str() {
            "tristrips" if element.count > 0 => {
                return Err(Stored::cannot_hold(
                    "strips of triangles that are turned inside out".to_owned(),
                    "save as .glb",
                ));
            }
            "vertex" if Some(index) == stored.vertex_element => {
                // In the order of the bytes.
                let mut columns: Vec<usize> = stored.columns[3..6].iter().flatten().copied().collect();
                columns.sort_unstable();
                for is_turned in turned {
                    let Some(numbers) = record(element, &mut walk) else {
                        break;
                    };
                    for &column in columns.iter().filter(|_| *is_turned) {
                        if let (Kind::Scalar(scalar), Some(number)) =
                            (element.properties[column].kind, numbers[column].first())
                        {
                            out.negate(number, scalar);
                        }
                    }
                }
            }
            "face" => {
                let list = corner_list(element);
                for _ in 0..element.count {
                    let Some(numbers) = record(element, &mut walk) else {
                        break;
                    };
                    let Some(corners) = list.map(|list| &numbers[list]) else {
                        continue;
                    };
                    let first = corners.first().and_then(|(corner, _)| turned.get(*corner as usize));
                    if first.is_some_and(|is_turned| *is_turned) {
                        for ((_, old), (_, new)) in corners.iter().zip(wound_back(corners)) {
                            out.copy(old, new);
                        }
                    }
                }
            }
            _ => {
                for _ in 0..element.count {
                    if record(element, &mut walk).is_none() {
                        break;
                    }
                }
            }
        }
    }
    Ok(out.finish())
}

/// The numbers of the next record, property by property: a list's items, or the one number.
fn record(element: &Element, walk: &mut Walk<'_>) -> Option<Vec<Vec<Number>>> {
    let properties = element.properties.iter();
    let numbers = properties.map(|property| match property.kind {
        Kind::Scalar(scalar) => Some(vec![walk.number(scalar)?]),
        Kind::List { count, item } => {
            let count = walk.number(count)?.0;
            // The file was read, so its lists are no longer than itself.
            (0..count as u64).map(|_| walk.number(item)).collect()
        }
    });
    numbers.collect()
}

/// The bytes while they change. Changes come in the order of the bytes.
enum Out<'a> {
    Text(&'a [u8], Splice<'a>),
    /// Numbers of one type are as long as each other.
    Binary(&'a [u8], Vec<u8>, Encoding),
}

impl<'a> Out<'a> {
    fn of(bytes: &'a [u8], encoding: Encoding) -> Self {
        match encoding {
            Encoding::Ascii => Self::Text(bytes, Splice::new(bytes)),
            _ => Self::Binary(bytes, bytes.to_vec(), encoding),
        }
    }

    fn copy(&mut self, to: &Range<usize>, from: &Range<usize>) {
        match self {
            Self::Text(bytes, splice) => {
                let number = &bytes[from.clone()];
                splice.replace(to.clone(), |out| out.extend_from_slice(number));
            }
            Self::Binary(bytes, out, _) => out[to.clone()].copy_from_slice(&bytes[from.clone()]),
        }
    }

    fn negate(&mut self, (value, at): &Number, scalar: Scalar) {
        match self {
            Self::Text(bytes, splice) => {
                let number = &bytes[at.clone()];
                splice.replace(at.clone(), |out| push_negated(number, out));
            }
            Self::Binary(_, out, encoding) => encode(out, at.start, scalar.nearest(-value), scalar, *encoding),
        }
    }

    fn finish(self) -> Vec<u8> {
        match self {
            Self::Text(_, splice) => splice.finish(),
            Self::Binary(_, out, _) => out,
        }
    }
}
