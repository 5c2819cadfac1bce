//! An edited OBJ file: the bytes as read, with other numbers in the `v` lines of moved vertices and in the `vn` lines
//! that only moved vertices use.
//!
//! Exporters share one `vn` line among all corners with the same normal, so a `vn` has no single vertex to follow. The
//! rule: a `vn` is rotated only if every vertex that uses it moved, and then by the mean of their rotations. One that
//! is also used by a vertex at rest keeps its bytes, because that vertex must look as before. Both compromises are
//! reported if they are visible. New `vn` lines are not made, because faces would have to change with them.

use glam::DVec3;
use pliant_mesh::{Cancelled, DrawnVertex};

use super::Stored;
use super::statements::NONE;
use crate::save::course::{Course, STEP};
use crate::save::moved::Moved;
use crate::text::{Cursor, Splice, push_f32, push_f64};

/// Users of one `vn` that deviate from their mean by more than this are reported: the cosine of 5 degrees.
const AGREEMENT: f64 = 0.996_194_698;

/// The new bytes and the warnings.
pub(super) fn patched(
    stored: &Stored,
    moved: &Moved<'_>,
    course: &Course<'_>,
) -> Result<(Vec<u8>, Vec<String>), Cancelled> {
    let mut warnings = Vec::new();
    let (of_normals, course) = course.split(if stored.normal.is_empty() { 0.0 } else { 0.5 });
    let normals = carried_normals(stored, moved, &mut warnings, &of_normals)?;
    let positions = moved.of_file();
    let mut splice = Splice::new(&stored.bytes);
    let mut normals = normals.into_iter().peekable();
    let write_normal = |splice: &mut Splice<'_>, (index, normal): (u32, DVec3)| {
        // f32 is a hundred times finer than an eye sees, and half as long as f64 in decimals.
        let numbers = normal.to_array().map(|component| component as f32);
        replace_numbers(
            splice,
            &stored.bytes,
            stored.statements.normal_at[index as usize],
            numbers,
            push_f32,
        );
    };
    for (vertex, new) in positions.iter().enumerate() {
        course.pass(vertex, positions.len())?;
        let Some(new) = new else { continue };
        let at = stored.statements.position_at[vertex];
        while let Some(normal) = normals.next_if(|(index, _)| stored.statements.normal_at[*index as usize] < at) {
            write_normal(&mut splice, normal);
        }
        replace_numbers(&mut splice, &stored.bytes, at, new.to_array(), push_f64);
    }
    for (place, normal) in normals.enumerate() {
        if place.is_multiple_of(STEP) {
            course.reach(1, 1)?;
        }
        write_normal(&mut splice, normal);
    }
    Ok((splice.finish(), warnings))
}

/// Replaces the three numbers that begin at byte `at`, each where it changes.
fn replace_numbers<T: Copy + Into<f64>>(
    splice: &mut Splice<'_>,
    bytes: &[u8],
    at: usize,
    numbers: [T; 3],
    push: impl Fn(&mut Vec<u8>, T),
) {
    let mut cursor = Cursor::new(bytes, at);
    for number in numbers {
        cursor.skip_blanks_continued();
        let start = cursor.at();
        let Some(stored) = cursor.real() else { return };
        if stored.to_bits() != number.into().to_bits() {
            splice.replace(start..cursor.at(), |out| push(out, number));
        }
    }
}

/// What the users of one `vn` want of it.
#[derive(Clone, Copy, Default)]
struct Wanted {
    sum: DVec3,
    users: u32,
    resting_users: u32,
    changed_users: u32,
}

/// The `vn` lines that change, in rising order, each with its new value.
fn carried_normals(
    stored: &Stored,
    moved: &Moved<'_>,
    warnings: &mut Vec<String>,
    course: &Course<'_>,
) -> Result<Vec<(u32, DVec3)>, Cancelled> {
    if stored.normal.is_empty() {
        return Ok(Vec::new());
    }
    let old = &stored.statements.normals;
    let of_vertex = |v: usize| {
        Some(stored.normal[v])
            .filter(|&index| index != NONE)
            .map(|index| old[index as usize])
    };
    let rest: Vec<DVec3> = (0..stored.normal.len())
        .map(|v| of_vertex(v).unwrap_or_default())
        .collect();
    let (of_frames, course) = course.split(0.8);
    let frames = moved.frames(&rest, &of_frames)?;
    let carried = |v: usize| {
        let vertex = DrawnVertex(v as u32);
        if moved.moves(vertex) {
            frames.carry_normal(vertex, rest[v])
        } else {
            rest[v]
        }
    };
    let mut wanted = vec![Wanted::default(); old.len()];
    for v in 0..rest.len() {
        course.pass(v, rest.len())?;
        if stored.normal[v] == NONE || !rest[v].is_finite() {
            continue;
        }
        let new = carried(v);
        let entry = &mut wanted[stored.normal[v] as usize];
        entry.sum += new.normalize_or_zero();
        entry.users += 1;
        entry.resting_users += u32::from(!moved.moves(DrawnVertex(v as u32)));
        entry.changed_users += u32::from(new != rest[v]);
    }
    let mut kept = 0usize;
    let mut blended = vec![false; wanted.len()];
    let mut changes = Vec::new();
    for (index, entry) in wanted.iter().enumerate() {
        if entry.changed_users == 0 {
            continue;
        }
        match entry.sum.try_normalize() {
            Some(direction) if entry.resting_users == 0 => {
                // The mean of users that agree has the length of their number; far less means that they differ.
                blended[index] = entry.sum.length() < AGREEMENT * f64::from(entry.users);
                changes.push((index as u32, direction * old[index].length()));
            }
            _ => kept += 1,
        }
    }
    let blended = blended.into_iter().filter(|&is_blended| is_blended).count();
    if kept > 0 {
        warnings.push(format!(
            "{kept} normals ('vn' lines) kept their old direction, because vertices that did not move share them."
        ));
    }
    if blended > 0 {
        warnings.push(format!(
            "{blended} normals ('vn' lines) turned by the mean of the vertices that share them, which bent apart by more than 5 degrees."
        ));
    }
    Ok(changes)
}
