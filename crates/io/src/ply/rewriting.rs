//! Records that are read with the place of each number, and bytes in which some of them change.

use std::ops::Range;

use super::header::{Element, Kind};
use super::scalar::{Encoding, Scalar, Walk, encode};
use crate::save::turned::push_negated;
use crate::text::{Splice, push_f32};

/// A number of a record, and its place.
pub(super) type Number = (f64, Range<usize>);

/// The numbers of the next record, property by property: a list's items, or the one number.
pub(super) fn record(element: &Element, walk: &mut Walk<'_>) -> Option<Vec<Vec<Number>>> {
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

/// The bytes during the changes. Changes come in the order of the bytes.
pub(super) enum Out<'a> {
    Text(&'a [u8], Splice<'a>),
    /// Numbers of one type have the same length.
    Binary(&'a [u8], Vec<u8>, Encoding),
}

impl<'a> Out<'a> {
    pub(super) fn of(bytes: &'a [u8], encoding: Encoding) -> Self {
        match encoding {
            Encoding::Ascii => Self::Text(bytes, Splice::new(bytes)),
            _ => Self::Binary(bytes, bytes.to_vec(), encoding),
        }
    }

    /// Writes the number at `from` over the one at `to`.
    pub(super) fn copy(&mut self, to: &Range<usize>, from: &Range<usize>) {
        match self {
            Self::Text(bytes, splice) => {
                let number = &bytes[from.clone()];
                splice.replace(to.clone(), |out| out.extend_from_slice(number));
            }
            Self::Binary(bytes, out, _) => out[to.clone()].copy_from_slice(&bytes[from.clone()]),
        }
    }

    /// Writes a number with the opposite sign.
    pub(super) fn negate(&mut self, (value, at): &Number, scalar: Scalar) {
        match self {
            Self::Text(bytes, splice) => {
                let number = &bytes[at.clone()];
                splice.replace(at.clone(), |out| push_negated(number, out));
            }
            Self::Binary(_, out, encoding) => encode(out, at.start, scalar.nearest(-value), scalar, *encoding),
        }
    }

    /// Writes another number over the old one; text gets the shortest decimals of an f32.
    pub(super) fn set(&mut self, (_, at): &Number, scalar: Scalar, value: f64) {
        match self {
            Self::Text(_, splice) => splice.replace(at.clone(), |out| push_f32(out, value as f32)),
            Self::Binary(_, out, encoding) => encode(out, at.start, scalar.nearest(value), scalar, *encoding),
        }
    }

    /// The changed bytes.
    pub(super) fn finish(self) -> Vec<u8> {
        match self {
            Self::Text(_, splice) => splice.finish(),
            Self::Binary(_, out, _) => out,
        }
    }
}
