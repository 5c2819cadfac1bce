//! Ascii STL: `solid`s of `facet normal … outer loop vertex … vertex … vertex … endloop endfacet`.

use std::ops::Range;

use glam::DVec3;
use pliant_mesh::Cancelled;

use super::facets::{changed_facets, facet_normal};
use crate::convert::faces::coarse_in_f32;
use crate::save::course::{Course, STEP};
use crate::save::moved::Moved;
use crate::save::turned::push_negated;
use crate::source::{Looks, Source};
use crate::text::{Cursor, Splice, excerpt, malformed_at, mark_len, push_f32, push_f64, shortest_f32};
use crate::{Format, ReadError};

/// The facets of an ascii file.
pub(super) struct Facets {
    /// The corners in order.
    pub(super) corners: Vec<DVec3>,
    /// The byte position of each facet's keyword.
    pub(super) places: Vec<usize>,
    /// The number of solids that begin.
    pub(super) solids: usize,
}

/// Reads the facets.
///
/// Keywords may be in any case and on any line. A file that ends within its last solid is accepted.
pub(super) fn read(source: &Source<'_>) -> Result<Facets, ReadError> {
    let mut cursor = Cursor::new(source.bytes, mark_len(source.bytes));
    let (mut corners, mut facets, mut looks) = (Vec::new(), Vec::new(), Looks::default());
    let mut solids = 0;
    loop {
        cursor.skip_space();
        if cursor.is_done() {
            return Ok(Facets {
                corners,
                places: facets,
                solids,
            });
        }
        let at = cursor.at();
        source.pass(&mut looks, at)?;
        let word = cursor.word();
        if word.eq_ignore_ascii_case(b"facet") {
            facets.push(at);
            corners.extend(facet(source, &mut cursor)?);
            if corners.len() > u32::MAX as usize - 3 {
                return Err(ReadError::TooLarge {
                    name: source.name.to_owned(),
                    what: format!("{} corners", corners.len()),
                });
            }
        } else if word.eq_ignore_ascii_case(b"solid") || word.eq_ignore_ascii_case(b"endsolid") {
            solids += usize::from(word.eq_ignore_ascii_case(b"solid"));
            // A name, which can be any text.
            cursor.next_line();
        } else {
            return Err(unexpected(source, at, word, "facet"));
        }
    }
}

fn unexpected(source: &Source<'_>, at: usize, word: &[u8], wanted: &str) -> ReadError {
    let reason = if word.is_empty() {
        format!("the file ends before '{wanted}': it is cut short")
    } else {
        format!("'{}' is in the place of '{wanted}': correct the line", excerpt(word))
    };
    malformed_at(source, Format::Stl, at, &reason)
}

/// Reads the text after `facet` up to `endfacet`.
fn facet(source: &Source<'_>, cursor: &mut Cursor<'_>) -> Result<[DVec3; 3], ReadError> {
    let keyword = |cursor: &mut Cursor<'_>, wanted: &str| {
        cursor.skip_space();
        let at = cursor.at();
        let word = cursor.word();
        if word.eq_ignore_ascii_case(wanted.as_bytes()) {
            Ok(())
        } else {
            Err(unexpected(source, at, word, wanted))
        }
    };
    let vector = |cursor: &mut Cursor<'_>| -> Result<DVec3, ReadError> {
        let mut values = [0.0; 3];
        for value in &mut values {
            cursor.skip_space();
            let at = cursor.at();
            *value = cursor
                .real()
                .ok_or_else(|| unexpected(source, at, cursor.clone().word(), "a number"))?;
        }
        Ok(DVec3::from_array(values))
    };
    keyword(cursor, "normal")?;
    vector(cursor)?;
    keyword(cursor, "outer")?;
    keyword(cursor, "loop")?;
    let mut corners = [DVec3::ZERO; 3];
    for corner in &mut corners {
        keyword(cursor, "vertex")?;
        *corner = vector(cursor)?;
    }
    keyword(cursor, "endloop")?;
    keyword(cursor, "endfacet")?;
    Ok(corners)
}

/// The bytes with the numbers of moved corners and of their facets' normals replaced.
pub(super) fn patched(
    bytes: &[u8],
    facets: &[usize],
    moved: &Moved<'_>,
    course: &Course<'_>,
) -> Result<Vec<u8>, Cancelled> {
    // Readers take ascii STL as f32, so more digits are written only if f32 would round visibly.
    let is_finer = coarse_in_f32(moved.positions).is_some();
    let push = |out: &mut Vec<u8>, value: f64| {
        if is_finer {
            push_f64(out, value)
        } else {
            push_f32(out, value as f32)
        }
    };
    // A number with more digits than f32 keeps is replaced by one with fewer, so that a save reads back as one of two
    // numbers: the new one, or the nearest one that the file stores.
    let is_same = |old: f64, new: f64| old == new || (!is_finer && old == shortest_f32(new));
    let mut splice = Splice::new(bytes);
    let changed = changed_facets(moved).take_while(|(number, ..)| *number < facets.len());
    for (place, (number, corners, has_moved)) in changed.enumerate() {
        if place.is_multiple_of(STEP) {
            course.reach(number, facets.len())?;
        }
        let vectors = [facet_normal(corners), corners[0], corners[1], corners[2]];
        let has_changed = [true, has_moved[0], has_moved[1], has_moved[2]];
        let mut cursor = Cursor::new(bytes, facets[number]);
        let mut slot = 0;
        while slot < 12 && !cursor.is_done() {
            cursor.skip_space();
            let start = cursor.at();
            // The keywords between the numbers never parse as numbers.
            let Some(old) = cursor.real() else {
                cursor.word();
                continue;
            };
            let new = vectors[slot / 3][slot % 3];
            if has_changed[slot / 3] && !is_same(old, new) {
                splice.replace(start..cursor.at(), |out| push(out, new));
            }
            slot += 1;
        }
    }
    Ok(splice.finish())
}

/// The bytes with reversed facets and normals.
pub(super) fn turned(bytes: &[u8], is_turned: impl Fn(usize) -> bool) -> Vec<u8> {
    let mut splice = Splice::new(bytes);
    let mut cursor = Cursor::new(bytes, mark_len(bytes));
    let mut facet = 0;
    loop {
        cursor.skip_space();
        if cursor.is_done() {
            return splice.finish();
        }
        let word = cursor.word();
        if word.eq_ignore_ascii_case(b"solid") || word.eq_ignore_ascii_case(b"endsolid") {
            cursor.next_line();
        } else if word.eq_ignore_ascii_case(b"facet") {
            if is_turned(facet) {
                turn(&mut cursor, bytes, &mut splice);
            }
            facet += 1;
        }
    }
}

/// Turns the facet whose keyword was read.
fn turn(cursor: &mut Cursor<'_>, bytes: &[u8], splice: &mut Splice<'_>) {
    let mut numbers: Vec<Range<usize>> = Vec::with_capacity(12);
    while numbers.len() < 12 && !cursor.is_done() {
        cursor.skip_space();
        let start = cursor.at();
        // The keywords between the numbers never parse as numbers.
        match cursor.real() {
            Some(_) => numbers.push(start..cursor.at()),
            None => {
                cursor.word();
            }
        }
    }
    for (slot, old) in numbers.iter().enumerate() {
        let (second, third) = (6..9, 9..12);
        let from = match slot {
            0..3 => {
                splice.replace(old.clone(), |out| push_negated(&bytes[old.clone()], out));
                continue;
            }
            _ if second.contains(&slot) => slot + 3,
            _ if third.contains(&slot) => slot - 3,
            _ => continue,
        };
        if let Some(new) = numbers.get(from) {
            splice.replace(old.clone(), |out| out.extend_from_slice(&bytes[new.clone()]));
        }
    }
}
