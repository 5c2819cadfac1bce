//! The records of faces and of strips of triangles.

use super::Records;
use super::record::{read_all, read_record};
use crate::ply::header::{Element, Kind};
use crate::ply::scalar::Walk;
use crate::source::Source;
use crate::{Format, ReadError};

/// The list of corner numbers among an element's properties.
fn corner_list(element: &Element) -> Option<usize> {
    let is_list = |&index: &usize| matches!(element.properties[index].kind, Kind::List { .. });
    let named = element
        .property(&["vertex_indices", "vertex_index", "vertex_indexes", "vertices"])
        .filter(is_list);
    named.or_else(|| (0..element.properties.len()).find(is_list))
}

/// A corner's number; `None` for what can't be one.
fn corner(value: f64) -> Option<u32> {
    (value >= 0.0 && value < f64::from(u32::MAX) && value.fract() == 0.0).then_some(value as u32)
}

pub(super) fn read_faces(
    source: &Source<'_>,
    element: &Element,
    walk: &mut Walk<'_>,
    records: &mut Records,
) -> Result<(), ReadError> {
    let list = corner_list(element);
    let mut strange = None;
    // Most faces are triangles; the count was held against the bytes that are left.
    records.face_ends.reserve_exact(element.count as usize);
    records
        .corners
        .reserve_exact((3 * element.count).min(walk.left()) as usize);
    read_all(source, element, walk, |walk| {
        let first = records.corners.len();
        let corners = &mut records.corners;
        let take = |property, value| {
            if Some(property) == list {
                corners.push(corner(value).unwrap_or_else(|| {
                    strange.get_or_insert(value);
                    u32::MAX
                }));
            }
        };
        read_record(element, walk, || !source.cancel.is_cancelled(), |_, _| (), take)?;
        if records.corners.len() - first < 3 {
            records.corners.truncate(first);
            records.left_out += 1;
        } else {
            records.face_ends.push(u32::try_from(records.corners.len()).ok()?);
        }
        Some(())
    })?;
    strange.map_or(Ok(()), |value| Err(no_corner(source, value)))
}

fn no_corner(source: &Source<'_>, value: f64) -> ReadError {
    let reason = format!("a face names the vertex {value}, which can't exist: correct the face");
    source.malformed(Format::Ply, reason)
}

/// Strips: each corner makes a triangle with the two before it, every other one turned; a negative number ends one.
pub(super) fn read_strips(
    source: &Source<'_>,
    element: &Element,
    walk: &mut Walk<'_>,
    records: &mut Records,
) -> Result<(), ReadError> {
    let list = corner_list(element);
    let mut strange = None;
    read_all(source, element, walk, |walk| {
        let mut strip = Strip::default();
        let Records { corners, face_ends, .. } = records;
        let take = |property, value: f64| {
            if Some(property) != list {
                return;
            }
            if value < 0.0 {
                strip = Strip::default();
            } else if let Some(corner) = corner(value) {
                // Repeated corners only carry the strip on.
                if let Some(triangle) = strip.next(corner) {
                    corners.extend(triangle);
                    face_ends.push(corners.len() as u32);
                }
            } else {
                strange.get_or_insert(value);
            }
        };
        read_record(element, walk, || !source.cancel.is_cancelled(), |_, _| (), take)?;
        u32::try_from(records.corners.len()).ok().map(|_| ())
    })?;
    strange.map_or(Ok(()), |value| Err(no_corner(source, value)))
}

/// The last two corners of a strip.
#[derive(Default)]
struct Strip {
    before: [Option<u32>; 2],
    is_turned: bool,
}

impl Strip {
    /// The triangle that `corner` closes, if it has three different corners.
    fn next(&mut self, corner: u32) -> Option<[u32; 3]> {
        let [first, second] = self.before;
        self.before = [second, Some(corner)];
        let (first, second) = (first?, second?);
        let is_turned = self.is_turned;
        self.is_turned = !is_turned;
        let triangle = if is_turned {
            [second, first, corner]
        } else {
            [first, second, corner]
        };
        (first != second && second != corner && first != corner).then_some(triangle)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_strip_keeps_its_winding_through_repeated_corners() {
        let mut strip = Strip::default();
        let triangles: Vec<_> = [0, 1, 2, 3, 3, 4, 5]
            .into_iter()
            .filter_map(|corner| strip.next(corner))
            .collect();
        assert_eq!(triangles, [[0, 1, 2], [2, 1, 3], [3, 4, 5]]);
    }
}
