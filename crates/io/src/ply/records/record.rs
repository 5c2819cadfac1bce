//! Reads the records of any element.

use crate::ply::header::{Element, Header, Kind};
use crate::ply::scalar::{Encoding, Walk};
use crate::source::{Looks, Source};
use crate::{Format, ReadError, quoted};

pub(super) fn cut_short(source: &Source<'_>, element: &Element, record: u64, at: usize) -> ReadError {
    let reason = if at >= source.bytes.len() || source.bytes[at..].trim_ascii().is_empty() {
        format!(
            "the file ends in record {record} of {} of '{}': it is cut short",
            element.count,
            quoted(&element.name)
        )
    } else {
        format!(
            "record {record} of '{}' is damaged (byte {at}): export the file again",
            quoted(&element.name)
        )
    };
    source.malformed(Format::Ply, reason)
}

/// Items of a list between two checks for cancellation.
const ITEMS_BETWEEN_LOOKS: u64 = 1 << 12;

/// Reads one record, giving each scalar with its property's number and each list's items.
pub(super) fn read_record(
    element: &Element,
    walk: &mut Walk<'_>,
    is_wanted: impl Fn() -> bool,
    mut scalar: impl FnMut(usize, f64),
    mut item: impl FnMut(usize, f64),
) -> Option<()> {
    for (index, property) in element.properties.iter().enumerate() {
        match property.kind {
            Kind::Scalar(kind) => scalar(index, walk.number(kind)?.0),
            Kind::List { count, item: kind } => {
                let count = walk.number(count)?.0;
                if !(count >= 0.0 && count.fract() == 0.0 && count <= walk.left() as f64) {
                    return None;
                }
                for number in 0..count as u64 {
                    // A list may be as long as the file.
                    if number.is_multiple_of(ITEMS_BETWEEN_LOOKS) && !is_wanted() {
                        return None;
                    }
                    item(index, walk.number(kind)?.0);
                }
            }
        }
    }
    Some(())
}

/// Reads all records of an element, calling `visit` before each of them.
pub(super) fn read_all(
    source: &Source<'_>,
    element: &Element,
    walk: &mut Walk<'_>,
    mut read_one: impl FnMut(&mut Walk<'_>) -> Option<()>,
) -> Result<(), ReadError> {
    let mut looks = Looks::default();
    for record in 0..element.count {
        source.pass(&mut looks, walk.at())?;
        if read_one(walk).is_none() {
            source.cancel.check()?;
            return Err(cut_short(source, element, record, walk.at()));
        }
    }
    Ok(())
}

pub(super) fn pass_over(
    source: &Source<'_>,
    header: &Header,
    element: &Element,
    walk: &mut Walk<'_>,
) -> Result<(), ReadError> {
    match element.stride() {
        Some(stride) if header.encoding != Encoding::Ascii => {
            walk.skip(stride.saturating_mul(element.count as usize));
            Ok(())
        }
        _ => read_all(source, element, walk, |walk| {
            read_record(element, walk, || !source.cancel.is_cancelled(), |_, _| (), |_, _| ())
        }),
    }
}
