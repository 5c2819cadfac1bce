//! An OBJ file with other colours after the positions of its `v` lines; every other byte stays the same.

use super::stored::Stored;
use crate::save::colours::unit;
use crate::text::{Cursor, Splice, push_f32};

/// The bytes with a colour, in sRGB from 0 to 1, for each `v` line. A `v` line that nothing uses becomes white.
pub(super) fn coloured(stored: &Stored, colours: &[Option<[u8; 4]>]) -> Vec<u8> {
    let mut splice = Splice::new(&stored.bytes);
    for (vertex, &at) in stored.statements.position_at.iter().enumerate() {
        let mut cursor = Cursor::new(&stored.bytes, at);
        let number = |cursor: &mut Cursor<'_>| {
            cursor.skip_blanks_continued();
            let is_there = !cursor.is_at_line_end() && cursor.real().is_some();
            is_there.then(|| cursor.at())
        };
        let [_, _, Some(start)] = [0, 1, 2].map(|_| number(&mut cursor)) else {
            continue;
        };
        // A weight, or the old colour; an alpha after that stays.
        let old = (0..3).map_while(|_| number(&mut cursor)).last();
        let [red, green, blue, _] = colours.get(vertex).copied().flatten().unwrap_or([u8::MAX; 4]);
        splice.replace(start..old.unwrap_or(start), |out| {
            for channel in [red, green, blue] {
                out.push(b' ');
                push_f32(out, unit(channel));
            }
        });
    }
    splice.finish()
}
