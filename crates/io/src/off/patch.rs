//! An edited OFF file: the bytes as read, with other numbers for the coordinates and normals of moved vertices.

use glam::DVec3;
use pliant_mesh::{Cancelled, DrawnVertex};

use super::stored::Stored;
use crate::save::course::Course;
use crate::save::moved::Moved;
use crate::text::{Cursor, Splice, push_f32, push_f64};

/// The new bytes.
pub(super) fn patched(stored: &Stored, moved: &Moved<'_>, course: &Course<'_>) -> Result<Vec<u8>, Cancelled> {
    let rest = &stored.records.normals;
    let (of_frames, course) = course.split(if rest.is_empty() { 0.0 } else { 0.5 });
    let frames = (!rest.is_empty()).then(|| moved.frames(rest, &of_frames)).transpose()?;
    let mut splice = Splice::new(&stored.bytes);
    let of_file = moved.of_file();
    for (vertex, new) in of_file.iter().enumerate() {
        course.pass(vertex, of_file.len())?;
        let Some(new) = new else { continue };
        let mut cursor = Cursor::new(&stored.bytes, stored.records.vertex_at[vertex]);
        replace_vector(&mut splice, &mut cursor, *new, push_f64);
        if let Some(frames) = &frames {
            let normal = frames.carry_normal(DrawnVertex(vertex as u32), rest[vertex]);
            if normal != rest[vertex] && normal.is_finite() {
                // f32 is a hundred times finer than an eye sees, and half as long as f64 in decimals.
                replace_vector(&mut splice, &mut cursor, normal, |out, number| {
                    push_f32(out, number as f32)
                });
            }
        }
    }
    Ok(splice.finish())
}

/// Replaces the next three numbers, each if it changes.
fn replace_vector(splice: &mut Splice<'_>, cursor: &mut Cursor<'_>, vector: DVec3, push: impl Fn(&mut Vec<u8>, f64)) {
    for number in vector.to_array() {
        cursor.skip_space_and_comments();
        let start = cursor.at();
        let Some(old) = cursor.real() else { return };
        if old.to_bits() != number.to_bits() {
            splice.replace(start..cursor.at(), |out| push(out, number));
        }
    }
}
