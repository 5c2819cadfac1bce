//! An edited PLY file: the bytes as read, with other numbers for the coordinates and normals of moved vertices.

use glam::{DVec3, Vec3};
use pliant_mesh::{Cancelled, DrawnVertex};

use super::header::{Element, Kind};
use super::scalar::{Encoding, Scalar, Walk, encode};
use super::stored::{Stored, cannot_hold};
use crate::SaveError;
use crate::convert::faces::coarse_in_f32;
use crate::save::course::Course;
use crate::save::moved::Moved;
use crate::text::{Splice, push_f32, push_f64, shortest_f32};

/// The new bytes and the warnings.
///
/// # Errors
/// A position beyond the range of the file's number type; the end of `course`.
pub(super) fn patched(
    stored: &Stored,
    moved: &Moved<'_>,
    course: &Course<'_>,
) -> Result<(Vec<u8>, Vec<String>), SaveError> {
    let Some(element) = stored.vertex_element.map(|index| &stored.header.elements[index]) else {
        return Ok((stored.bytes.to_vec(), Vec::new()));
    };
    let (of_edits, of_bytes) = course.split(0.6);
    let edits = Edits::of(stored, element, moved, &of_edits)?;
    let bytes = match stored.header.encoding {
        Encoding::Ascii => edits.into_text(stored, element, moved.positions, &of_bytes)?,
        _ => edits.into_binary(stored, element, &of_bytes)?,
    };
    let warnings = whole_numbers_warning(stored, element).into_iter().collect();
    Ok((bytes, warnings))
}

/// The number nearest to `value` that the column of a coordinate holds, as it is read back.
pub(super) fn nearest(stored: &Stored, axis: usize, value: f64) -> f64 {
    let element = stored.vertex_element.map(|index| &stored.header.elements[index]);
    let scalar = element.and_then(|element| scalar_of(element, stored.columns[axis]?));
    match (scalar, stored.header.encoding) {
        (Some(Scalar::F32), Encoding::Ascii) => shortest_f32(value),
        (scalar, _) => scalar.map_or(value, |scalar| scalar.nearest(value)),
    }
}

/// The type of a vertex's property; `None` for lists.
fn scalar_of(element: &Element, property: usize) -> Option<Scalar> {
    match element.properties[property].kind {
        Kind::Scalar(scalar) => Some(scalar),
        Kind::List { .. } => None,
    }
}

fn whole_numbers_warning(stored: &Stored, element: &Element) -> Option<String> {
    let are_whole = stored.columns[..3]
        .iter()
        .flatten()
        .any(|&property| scalar_of(element, property).is_some_and(|scalar| scalar.integer_range().is_some()));
    are_whole.then(|| "The file stores positions as whole numbers, so the moved ones were rounded.".to_owned())
}

/// One vertex's new numbers.
struct Edit {
    vertex: usize,
    /// x, y, z, then the normal; `None` for numbers that keep their bytes.
    numbers: [Option<f64>; 6],
}

struct Edits(Vec<Edit>);

impl Edits {
    fn of(stored: &Stored, element: &Element, moved: &Moved<'_>, course: &Course<'_>) -> Result<Self, SaveError> {
        let rest: Vec<DVec3> = (stored.of_drawn(&stored.normals))
            .map(|normal| Vec3::from(normal).as_dvec3())
            .collect();
        let (of_frames, course) = course.split(if rest.is_empty() { 0.0 } else { 0.7 });
        let frames = (!rest.is_empty())
            .then(|| moved.frames(&rest, &of_frames))
            .transpose()?;
        let mut edits = Vec::new();
        let of_file = moved.of_file();
        for (vertex, new) in of_file.iter().enumerate() {
            course.pass(vertex, of_file.len())?;
            let Some(new) = new else { continue };
            let mut numbers = [None; 6];
            numbers[..3].copy_from_slice(&new.to_array().map(Some));
            for (axis, number) in numbers[..3].iter().enumerate() {
                check(element, stored.columns[axis], vertex, *number)?;
            }
            if let Some(frames) = &frames {
                let normal = frames.carry_normal(DrawnVertex(vertex as u32), rest[vertex]);
                if normal.is_finite() {
                    for axis in (0..3).filter(|&axis| normal[axis] != rest[vertex][axis]) {
                        numbers[3 + axis] = Some(normal[axis]);
                    }
                }
            }
            edits.push(Edit { vertex, numbers });
        }
        Ok(Self(edits))
    }

    fn into_binary(self, stored: &Stored, element: &Element, course: &Course<'_>) -> Result<Vec<u8>, Cancelled> {
        let encoding = stored.header.encoding;
        let mut out = stored.bytes.to_vec();
        self.visit(stored, element, course, |scalar, span, value, old| {
            let value = scalar.nearest(value);
            if value.to_bits() != old.to_bits() {
                encode(&mut out, span.start, value, scalar, encoding);
            }
        })?;
        Ok(out)
    }

    fn into_text(
        self,
        stored: &Stored,
        element: &Element,
        positions: &[DVec3],
        course: &Course<'_>,
    ) -> Result<Vec<u8>, Cancelled> {
        // If a file's text is finer than its named type (scans at geographic coordinates, called 'float'), following
        // the name would lose digits.
        let is_finer = coarse_in_f32(positions).is_some();
        let mut splice = Splice::new(&stored.bytes);
        self.visit(stored, element, course, |scalar, span, value, old| {
            let is_short = scalar == Scalar::F32 && !is_finer;
            let nearest = match scalar {
                Scalar::F32 if is_short => shortest_f32(value),
                Scalar::F32 => value,
                _ => scalar.nearest(value),
            };
            // Unchanged numbers keep their digits, even if these are more than the type holds.
            if ![value, nearest].map(f64::to_bits).contains(&old.to_bits()) {
                splice.replace(span, |out| {
                    if is_short {
                        push_f32(out, value as f32)
                    } else {
                        push_f64(out, nearest)
                    }
                });
            }
        })?;
        Ok(splice.finish())
    }

    /// Goes through the edited vertices' records and gives each edited number its type, place, new and old value, in
    /// the order of the bytes.
    fn visit(
        self,
        stored: &Stored,
        element: &Element,
        course: &Course<'_>,
        mut change: impl FnMut(Scalar, std::ops::Range<usize>, f64, f64),
    ) -> Result<(), Cancelled> {
        let count = self.0.len();
        for (number, edit) in self.0.into_iter().enumerate() {
            course.pass(number, count)?;
            let mut walk = Walk::new(&stored.bytes, stored.places.of(edit.vertex), stored.header.encoding);
            for (property, description) in element.properties.iter().enumerate() {
                let slot = stored.columns[..6].iter().position(|column| *column == Some(property));
                match description.kind {
                    Kind::Scalar(scalar) => {
                        let Some((old, span)) = walk.number(scalar) else { break };
                        if let Some(value) = slot.and_then(|slot| edit.numbers[slot]) {
                            change(scalar, span, value, old);
                        }
                    }
                    Kind::List { count, item } => {
                        let items = walk.number(count).map_or(0, |(count, _)| count as u64);
                        for _ in 0..items {
                            if walk.number(item).is_none() {
                                break;
                            }
                        }
                    }
                }
            }
        }
        Ok(())
    }
}

/// Refuses a coordinate that its type can't hold.
fn check(element: &Element, property: Option<usize>, vertex: usize, number: Option<f64>) -> Result<(), SaveError> {
    let (Some(scalar), Some(number)) = (property.and_then(|property| scalar_of(element, property)), number) else {
        return Ok(());
    };
    match scalar.integer_range() {
        Some([least, most]) if !(least..=most).contains(&number.round()) => Err(cannot_hold(
            format!("the new position of vertex {vertex}, {number}, beyond the whole numbers of this file,"),
            "save as .glb or move it less",
        )),
        None if !scalar.nearest(number).is_finite() => Err(SaveError::NotFinite {
            file_vertex: vertex as u32,
        }),
        _ => Ok(()),
    }
}
