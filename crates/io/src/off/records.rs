//! The vertices and faces of an OFF file.

use glam::DVec3;

use super::header::Header;
use crate::source::{Looks, Source};
use crate::text::{Cursor, excerpt, malformed_at};
use crate::{Format, ReadError};

/// The contents of the lines after the head.
#[derive(Debug, Default)]
pub(super) struct Records {
    /// The byte of each vertex's first coordinate.
    pub(super) vertex_at: Vec<usize>,
    pub(super) positions: Vec<DVec3>,
    /// Empty if the vertices have none.
    pub(super) normals: Vec<DVec3>,
    /// As written, with [`OPAQUE`] for a missing alpha; empty if the vertices have none.
    pub(super) colours: Vec<[f32; 4]>,
    /// f32: only ever drawn.
    pub(super) uvs: Vec<[f32; 2]>,
    /// The corners of all faces, one after the other.
    pub(super) corners: Vec<u32>,
    /// The end of each face's corners.
    pub(super) face_ends: Vec<u32>,
    /// The number of faces with fewer than three corners.
    pub(super) left_out: usize,
    /// True if a colour follows the corners of a face.
    pub(super) has_face_colours: bool,
}

/// Reads the records that `header` promises.
///
/// A vertex begins on a line of its own; the rest of its line is skipped, because plain OFF files carry colours too.
/// The same is true of a face and its colour.
pub(super) fn read(source: &Source<'_>, header: &Header, mut cursor: Cursor<'_>) -> Result<Records, ReadError> {
    let (mut records, mut looks) = (Records::default(), Looks::default());
    records.positions.reserve_exact(header.vertices);
    records.vertex_at.reserve_exact(header.vertices);
    for vertex in 0..header.vertices {
        source.pass(&mut looks, cursor.at())?;
        cursor.skip_space_and_comments();
        records.vertex_at.push(cursor.at());
        let position = vector(&mut cursor).ok_or_else(|| no_number(source, &cursor, "vertex", vertex))?;
        records.positions.push(position);
        if header.has_normals {
            let normal = vector(&mut cursor).ok_or_else(|| no_number(source, &cursor, "vertex", vertex))?;
            records.normals.push(normal);
        }
        if header.has_colours || header.has_uvs {
            read_look(header, &mut cursor, &mut records);
        }
        cursor.next_line();
    }
    for face in 0..header.faces {
        read_face(source, face, &mut cursor, &mut looks, &mut records)?;
        cursor.skip_blanks();
        records.has_face_colours |= !cursor.is_at_line_end();
        cursor.next_line();
    }
    Ok(records)
}

/// Three numbers, on this line or the next ones.
fn vector(cursor: &mut Cursor<'_>) -> Option<DVec3> {
    let mut values = [0.0; 3];
    for value in &mut values {
        cursor.skip_space_and_comments();
        *value = cursor.real()?;
    }
    Some(DVec3::from_array(values))
}

/// The rest of a vertex's line: three or four numbers of colour, two of texture coordinates; 0 for missing ones.
fn read_look(header: &Header, cursor: &mut Cursor<'_>, records: &mut Records) {
    let mut numbers = [0.0f32; 6];
    let mut count = 0;
    loop {
        cursor.skip_blanks();
        match cursor.real() {
            Some(number) if count < numbers.len() => numbers[count] = number as f32,
            _ => break,
        }
        count += 1;
    }
    let colour_count = count.saturating_sub(if header.has_uvs { 2 } else { 0 });
    if header.has_colours {
        let [r, g, b, alpha, ..] = numbers;
        records
            .colours
            .push([r, g, b, if colour_count >= 4 { alpha } else { OPAQUE }]);
    }
    if header.has_uvs {
        let first = if header.has_colours { colour_count.min(4) } else { 0 };
        records.uvs.push([numbers[first], numbers[first + 1]]);
    }
}

/// The alpha of a colour that has none, in files that count to 1 or to 255.
pub(super) const OPAQUE: f32 = f32::NAN;

fn read_face(
    source: &Source<'_>,
    face: usize,
    cursor: &mut Cursor<'_>,
    looks: &mut Looks,
    records: &mut Records,
) -> Result<(), ReadError> {
    cursor.skip_space_and_comments();
    source.pass(looks, cursor.at())?;
    let at = cursor.at();
    let count = cursor.whole().and_then(|count| u64::try_from(count).ok());
    let count = count.ok_or_else(|| no_number(source, cursor, "face", face))?;
    // A digit and a separator each.
    if count.saturating_mul(2) > cursor.left() as u64 {
        let reason = format!("face {face} has {count} corners, but the file ends before them: it is cut short");
        return Err(malformed_at(source, Format::Off, at, &reason));
    }
    let first = records.corners.len();
    for _ in 0..count {
        cursor.skip_space_and_comments();
        let at = cursor.at();
        source.pass(looks, at)?;
        let corner = cursor.whole().ok_or_else(|| no_number(source, cursor, "face", face))?;
        match u32::try_from(corner) {
            Ok(corner) if (corner as usize) < records.positions.len() => records.corners.push(corner),
            _ => {
                let count = records.positions.len();
                let reason = format!(
                    "the face names the vertex {corner}, but there are {count}, numbered from 0: correct the number"
                );
                return Err(malformed_at(source, Format::Off, at, &reason));
            }
        }
    }
    if count < 3 {
        records.corners.truncate(first);
        records.left_out += 1;
        return Ok(());
    }
    let end = u32::try_from(records.corners.len()).map_err(|_| ReadError::TooLarge {
        name: source.name.to_owned(),
        what: format!("{} face corners", records.corners.len()),
    })?;
    records.face_ends.push(end);
    Ok(())
}

fn no_number(source: &Source<'_>, cursor: &Cursor<'_>, what: &str, number: usize) -> ReadError {
    let word = cursor.clone().word();
    let reason = if word.is_empty() {
        format!("the file ends in {what} {number}: it is cut short")
    } else {
        format!(
            "'{}' in {what} {number} is not a number: correct the line",
            excerpt(word)
        )
    };
    malformed_at(source, Format::Off, cursor.at(), &reason)
}
