//! An OFF file with some parts turned inside out: the corners of their faces in reverse, and normals with other signs.

use std::ops::Range;

use crate::save::turned::{push_negated, wound_back};
use crate::text::{Cursor, Splice};

/// The new bytes. The vertices' records begin at `first`; `turned` says for each vertex whether its part is turned, and
/// `has_normals` whether three numbers of a normal follow its position.
pub(super) fn turned(bytes: &[u8], first: usize, turned: &[bool], has_normals: bool, face_count: usize) -> Vec<u8> {
    let mut splice = Splice::new(bytes);
    let mut cursor = Cursor::new(bytes, first);
    for &is_turned in turned {
        for place in 0..if has_normals { 6 } else { 3 } {
            cursor.skip_space_and_comments();
            let start = cursor.at();
            if cursor.real().is_some() && is_turned && place >= 3 {
                let number = &bytes[start..cursor.at()];
                splice.replace(start..cursor.at(), |out| push_negated(number, out));
            }
        }
        cursor.next_line();
    }
    for _ in 0..face_count {
        cursor.skip_space_and_comments();
        let count = cursor.whole().unwrap_or(0);
        let mut corners: Vec<Range<usize>> = Vec::new();
        let mut is_turned = false;
        for place in 0..count {
            cursor.skip_space_and_comments();
            let start = cursor.at();
            let Some(corner) = cursor.whole() else { break };
            if place == 0 {
                let corner = usize::try_from(corner).ok().and_then(|corner| turned.get(corner));
                is_turned = corner.is_some_and(|is_turned| *is_turned);
            }
            corners.push(start..cursor.at());
        }
        if is_turned {
            for (old, new) in corners.iter().zip(wound_back(&corners)) {
                splice.replace(old.clone(), |out| out.extend_from_slice(&bytes[new.clone()]));
            }
        }
        cursor.next_line();
    }
    splice.finish()
}
