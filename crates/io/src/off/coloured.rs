//! An OFF file with other colours in its vertices' lines; every other byte stays the same.

use super::stored::Stored;
use crate::text::{Cursor, Splice, mark_len};

/// The bytes with a colour and an alpha, from 0 to 255, for each vertex. A vertex that nothing uses becomes white.
pub(super) fn coloured(stored: &Stored, colours: &[Option<[u8; 4]>]) -> Vec<u8> {
    let records = &stored.records;
    let (has_normals, has_colours) = (!records.normals.is_empty(), !records.colours.is_empty());
    let mut splice = Splice::new(&stored.bytes);
    if !has_colours {
        mark(&mut splice, &stored.bytes);
    }
    for (vertex, &at) in records.vertex_at.iter().enumerate() {
        let mut cursor = Cursor::new(&stored.bytes, at);
        for _ in 0..if has_normals { 6 } else { 3 } {
            cursor.skip_space_and_comments();
            cursor.real();
        }
        let start = cursor.at();
        let mut ends = Vec::new();
        loop {
            cursor.skip_blanks();
            if cursor.is_at_line_end() || cursor.real().is_none() {
                break;
            }
            ends.push(cursor.at());
        }
        // Texture coordinates come last and stay; plain OFF files have colours here too.
        let kept = if records.uvs.is_empty() { 0 } else { 2 };
        let old = ends.len().saturating_sub(kept).min(4);
        let end = ends[..old].last().copied().unwrap_or(start);
        let colour = colours.get(vertex).copied().flatten().unwrap_or([u8::MAX; 4]);
        splice.replace(start..end, |out| {
            for channel in colour {
                out.extend_from_slice(format!(" {channel}").as_bytes());
            }
        });
    }
    splice.finish()
}

/// Says in the keyword that there are colours.
fn mark(splice: &mut Splice<'_>, bytes: &[u8]) {
    let mut cursor = Cursor::new(bytes, mark_len(bytes));
    cursor.skip_space_and_comments();
    let at = cursor.at();
    let word = cursor.clone().word();
    if word.ends_with(b"OFF") {
        let at = at + if word.starts_with(b"ST") { 2 } else { 0 };
        splice.replace(at..at, |out| out.push(b'C'));
    } else {
        splice.replace(at..at, |out| out.extend_from_slice(b"COFF\n"));
    }
}
