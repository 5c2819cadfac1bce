//! An OBJ file with some parts turned inside out: the corners of their `f` lines in reverse, and other signs in the
//! `vn` lines that only they use.

use std::ops::Range;

use crate::save::turned::{push_negated, wound_back};
use crate::text::{Cursor, Splice};

/// The new bytes. `vertices` tells of each `v` line whether its part is turned, `normals` of each `vn` line.
pub(super) fn turned(bytes: &[u8], vertices: &[bool], normals: &[bool]) -> Vec<u8> {
    let mut splice = Splice::new(bytes);
    let mut cursor = Cursor::new(bytes, 0);
    let (mut vertex_count, mut normal_count) = (0, 0);
    while !cursor.is_done() {
        cursor.skip_blanks();
        match cursor.word() {
            b"v" => vertex_count += 1,
            b"vn" => {
                if normals.get(normal_count).is_some_and(|is_turned| *is_turned) {
                    negate(bytes, &mut cursor, &mut splice);
                }
                normal_count += 1;
            }
            b"f" | b"fo" => {
                let corners = corners(&mut cursor, vertex_count);
                let first = corners.first().and_then(|(vertex, _)| vertices.get((*vertex)?));
                if first.is_some_and(|is_turned| *is_turned) {
                    for ((_, old), (_, new)) in corners.iter().zip(wound_back(&corners)) {
                        splice.replace(old.clone(), |out| out.extend_from_slice(&bytes[new.clone()]));
                    }
                }
            }
            _ => {}
        }
        cursor.next_line();
    }
    splice.finish()
}

fn negate(bytes: &[u8], cursor: &mut Cursor<'_>, splice: &mut Splice<'_>) {
    for _ in 0..3 {
        cursor.skip_blanks_continued();
        let start = cursor.at();
        if cursor.real().is_none() {
            return;
        }
        let number = &bytes[start..cursor.at()];
        splice.replace(start..cursor.at(), |out| push_negated(number, out));
    }
}

/// The `v` line that each corner names, from 0, and where the corner stands.
fn corners(cursor: &mut Cursor<'_>, vertex_count: usize) -> Vec<(Option<usize>, Range<usize>)> {
    let mut corners = Vec::new();
    loop {
        cursor.skip_blanks_continued();
        if cursor.is_at_line_end() {
            return corners;
        }
        let start = cursor.at();
        let vertex = cursor.integer().and_then(|named| match named {
            1.. => usize::try_from(named - 1).ok(),
            _ => usize::try_from(named.checked_add(i64::try_from(vertex_count).ok()?)?).ok(),
        });
        while !matches!(cursor.peek(), None | Some(b' ' | b'\t'..=b'\r' | b'#' | b'\\')) {
            cursor.step();
        }
        corners.push((vertex, start..cursor.at()));
    }
}
