//! An OBJ file with some parts turned inside out: the corners of their `f` lines in reverse, and other signs in the
//! `vn` lines that only they use.

use std::cell::RefCell;

use super::faces;
use crate::save::turned::{push_negated, wound_back};
use crate::text::{Cursor, Splice};

/// The new bytes. `vertices` says for each `v` line whether its part is turned, `normals` for each `vn` line.
pub(super) fn turned(bytes: &[u8], vertices: &[bool], normals: &[bool]) -> Vec<u8> {
    let splice = RefCell::new(Splice::new(bytes));
    faces::for_each(
        bytes,
        |face| {
            let first = face.corners.first();
            let first = first.and_then(|corner| vertices.get(corner.vertex? as usize));
            if first.is_some_and(|is_turned| *is_turned) {
                for (old, new) in face.corners.iter().zip(wound_back(face.corners)) {
                    let new = &bytes[new.span.clone()];
                    let old = old.span.clone();
                    splice.borrow_mut().replace(old, |out| out.extend_from_slice(new));
                }
            }
        },
        |normal, cursor| {
            if normals.get(normal).is_some_and(|is_turned| *is_turned) {
                negate(bytes, cursor, &mut splice.borrow_mut());
            }
        },
    );
    splice.into_inner().finish()
}

fn negate(bytes: &[u8], mut cursor: Cursor<'_>, splice: &mut Splice<'_>) {
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
