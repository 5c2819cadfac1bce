//! The corners of `f` lines and their places in the text, for giving them other normals.

use std::ops::Range;

use super::statements::resolve;
use crate::text::{Cursor, mark_len};

/// A corner of a face: the lines that it names, and its place.
#[derive(Clone, Debug)]
pub(super) struct Corner {
    /// The number of its `v` line, from 0.
    pub(super) vertex: Option<u32>,
    /// The number of its `vn` line, from 0, and the place where it is written.
    pub(super) normal: Option<(u32, Range<usize>)>,
    /// The place of the whole corner.
    pub(super) span: Range<usize>,
}

/// A face, and the number of `v` and `vn` lines before it.
#[derive(Debug)]
pub(super) struct Face<'a> {
    /// The start of its line.
    pub(super) line_at: usize,
    pub(super) normals_before: usize,
    pub(super) corners: &'a [Corner],
}

/// Calls `visit_face` with every `f` line of an OBJ file that was read, and `visit_normal` with the place after the
/// keyword of each `vn`, in the order of the bytes.
pub(super) fn for_each<'a>(
    bytes: &'a [u8],
    mut visit_face: impl FnMut(&Face<'_>),
    mut visit_normal: impl FnMut(usize, Cursor<'a>),
) {
    let mut cursor = Cursor::new(bytes, mark_len(bytes));
    let (mut vertex_count, mut normal_count) = (0, 0);
    let mut corners = Vec::new();
    while !cursor.is_done() {
        let line_at = cursor.at();
        cursor.skip_blanks();
        match cursor.word() {
            b"v" => vertex_count += 1,
            b"vn" => {
                visit_normal(normal_count, cursor.clone());
                normal_count += 1;
            }
            b"f" | b"fo" => {
                read(&mut cursor, vertex_count, normal_count, &mut corners);
                visit_face(&Face {
                    line_at,
                    normals_before: normal_count,
                    corners: &corners,
                });
            }
            _ => {}
        }
        cursor.next_line();
    }
}

/// The corners up to the end of the line.
fn read(cursor: &mut Cursor<'_>, vertex_count: usize, normal_count: usize, corners: &mut Vec<Corner>) {
    corners.clear();
    loop {
        cursor.skip_blanks_continued();
        if cursor.is_at_line_end() {
            return;
        }
        let start = cursor.at();
        let vertex = cursor.integer().and_then(|named| resolve(named, vertex_count));
        let mut normal = None;
        let mut slashes = 0;
        while !matches!(cursor.peek(), None | Some(b' ' | b'\t'..=b'\r' | b'#' | b'\\')) {
            let is_slash = cursor.peek() == Some(b'/');
            cursor.step();
            slashes += u32::from(is_slash);
            if is_slash && slashes == 2 {
                let at = cursor.at();
                let named = cursor.integer().and_then(|named| resolve(named, normal_count));
                normal = named.map(|named| (named, at..cursor.at()));
            }
        }
        corners.push(Corner {
            vertex,
            normal,
            span: start..cursor.at(),
        });
    }
}
