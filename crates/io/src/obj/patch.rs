//! An edited OBJ file: the bytes as read, with other numbers in the `v` lines of moved vertices and in the `vn` lines
//! that turn. If one `vn` line no longer fits all its users, new lines come before the first face that names one,
//! because many readers look up normals as they reach a face, and corners name other lines.

use std::ops::Range;

use glam::DVec3;
use pliant_mesh::Cancelled;

use super::faces::{self, Face};
use super::normals::Normals;
use super::statements::NONE;
use super::stored::Stored;
use crate::save::course::Course;
use crate::save::moved::Moved;
use crate::text::{Cursor, Splice, push_f32, push_f64};

/// An edited file.
#[derive(Debug)]
pub(super) struct Patched {
    pub(super) bytes: Vec<u8>,
    /// The `vn` line of each drawn vertex in it; [`NONE`] for those without one.
    pub(super) normal: Vec<u32>,
    /// The number of its `vn` lines.
    pub(super) normal_count: usize,
}

/// A change at a place of the bytes.
enum Change {
    Position(DVec3),
    Normal(DVec3),
    /// The digits up to here name this `vn` line, counted from 0.
    Name(usize, u32),
    /// New lines.
    Lines,
}

/// The file with the moved vertices' numbers and the normals around them changed.
pub(super) fn patched(stored: &Stored, moved: &Moved<'_>, course: &Course<'_>) -> Result<Patched, Cancelled> {
    let (of_normals, course) = course.split(if stored.normal.is_empty() { 0.0 } else { 0.5 });
    let normals = Normals::of(stored, moved, &of_normals)?;
    let statements = &stored.statements;
    let named = Renamed::of(stored, moved, &normals);
    let moved_vertices = moved.of_file().iter().enumerate();
    let positions = moved_vertices.filter_map(|(vertex, new)| {
        let new = (*new)?;
        Some((statements.position_at[vertex], Change::Position(new)))
    });
    let mut changes: Vec<(usize, Change)> = positions.collect();
    let of_lines = normals.changed.iter();
    changes.extend(of_lines.map(|&(index, normal)| (statements.normal_at[index as usize], Change::Normal(normal))));
    changes.extend(named.place.map(|at| (at, Change::Lines)));
    changes.extend(
        named
            .corners
            .iter()
            .map(|(span, line)| (span.start, Change::Name(span.end, *line))),
    );
    // Each of these lists is in order, and a stable sort merges such lists quickly.
    changes.sort_by_key(|(at, _)| *at);

    let mut splice = Splice::new(&stored.bytes);
    let count = changes.len();
    for (place, (at, change)) in changes.into_iter().enumerate() {
        course.pass(place, count)?;
        match change {
            Change::Position(new) => replace_numbers(&mut splice, &stored.bytes, at, new.to_array(), push_f64),
            // f32 is a hundred times finer than an eye sees, and half as long as f64 in decimals.
            Change::Normal(normal) => {
                replace_numbers(&mut splice, &stored.bytes, at, normal.as_vec3().to_array(), push_f32);
            }
            Change::Name(end, line) => splice.replace(at..end, |out| push_f64(out, f64::from(line) + 1.0)),
            Change::Lines => splice.replace(at..at, |out| push_lines(out, &normals.added, line_end(&stored.bytes))),
        }
    }
    Ok(Patched {
        bytes: splice.finish(),
        normal: named.of_vertex,
        normal_count: statements.normals.len() + normals.added.len(),
    })
}

/// The names of normals in an edited file.
struct Renamed {
    /// The place of the new lines; `None` if there are none.
    place: Option<usize>,
    /// The corners that need another name, in the order of the bytes, with the number of the line.
    corners: Vec<(Range<usize>, u32)>,
    of_vertex: Vec<u32>,
}

impl Renamed {
    fn of(stored: &Stored, moved: &Moved<'_>, normals: &Normals) -> Self {
        let mut out = Self {
            place: None,
            corners: Vec::new(),
            of_vertex: stored.normal.clone(),
        };
        let (old_count, added) = (stored.statements.normals.len() as u32, normals.added.len() as u32);
        if added == 0 {
            return out;
        }
        let is_added = |vertex: usize| (old_count..NONE).contains(&normals.of_vertex[vertex]);
        let mut before = 0;
        for_each_face(stored, moved, |face, drawn| {
            if out.place.is_none() && drawn.iter().any(|&vertex| is_added(vertex)) {
                out.place = Some(face.line_at);
                before = face.normals_before as u32;
            }
        });
        // The number of a line in the edited file, for its number in the input.
        let renamed = |line: u32| match line {
            NONE => NONE,
            line if line < before => line,
            line if line < old_count => line + added,
            line => line - old_count + before,
        };
        out.of_vertex = normals.of_vertex.iter().map(|&line| renamed(line)).collect();
        let place = out.place.unwrap_or(usize::MAX);
        for_each_face(stored, moved, |face, drawn| {
            for (number, corner) in face.corners.iter().enumerate() {
                let Some((old, span)) = &corner.normal else { continue };
                let wanted = match drawn.get(number) {
                    // A name without a line must not become that of a new one.
                    _ if *old >= old_count => old + added,
                    Some(&vertex) => out.of_vertex[vertex],
                    None => renamed(*old),
                };
                // A name that counts back from the face also counts the new lines, if they come before it.
                let counts_back = stored.bytes[span.start] == b'-';
                let found = if counts_back && face.line_at >= place {
                    old + added
                } else {
                    *old
                };
                if wanted != found && wanted != NONE {
                    out.corners.push((span.clone(), wanted));
                }
            }
        });
        out
    }
}

/// Calls `visit` with each face and the drawn vertices of its corners; a face that is not drawn has none.
fn for_each_face(stored: &Stored, moved: &Moved<'_>, mut visit: impl FnMut(&Face<'_>, &[usize])) {
    let of_polygons = stored.polygons.as_ref().map(|polygons| &polygons.corners[..]);
    let mut drawn = of_polygons.unwrap_or(moved.drawn.triangles.as_flattened()).iter();
    let mut own = Vec::new();
    faces::for_each(
        &stored.bytes,
        |face| {
            own.clear();
            if face.corners.len() > 2 {
                own.extend(drawn.by_ref().take(face.corners.len()).map(|vertex| vertex.index()));
            }
            visit(face, &own);
        },
        |_, _| (),
    );
}

/// The file's line ending.
fn line_end(bytes: &[u8]) -> &'static [u8] {
    match bytes.iter().position(|&byte| byte == b'\n') {
        Some(at) if at > 0 && bytes[at - 1] == b'\r' => b"\r\n",
        _ => b"\n",
    }
}

fn push_lines(out: &mut Vec<u8>, normals: &[DVec3], end: &[u8]) {
    for normal in normals {
        out.extend_from_slice(b"vn");
        for number in normal.as_vec3().to_array() {
            out.push(b' ');
            push_f32(out, number);
        }
        out.extend_from_slice(end);
    }
}

/// Replaces the three numbers that begin at byte `at`, each if it changes.
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
