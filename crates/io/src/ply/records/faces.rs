//! The records of faces and of strips of triangles.

use super::drawn_records::Records;
use super::record::{read_all, read_record};
use crate::ply::header::{Element, Kind};
use crate::ply::scalar::Walk;
use crate::source::Source;
use crate::{Format, ReadError};

/// The list of corner numbers among an element's properties.
pub(crate) fn corner_list(element: &Element) -> Option<usize> {
    let is_list = |&index: &usize| matches!(element.properties[index].kind, Kind::List { .. });
    let named = element
        .property(&["vertex_indices", "vertex_index", "vertex_indexes", "vertices"])
        .filter(is_list);
    named.or_else(|| (0..element.properties.len()).find(is_list))
}

/// A corner's number; `None` if it can't be one.
fn corner(value: f64) -> Option<u32> {
    (value >= 0.0 && value < f64::from(u32::MAX) && value.fract() == 0.0).then_some(value as u32)
}

pub(super) fn read_faces(
    source: &Source<'_>,
    element: &Element,
    walk: &mut Walk<'_>,
    records: &mut Records,
) -> Result<(), ReadError> {
    // Most faces are triangles. The count was checked against the remaining bytes.
    records.face_ends.reserve_exact(element.count as usize);
    records
        .corners
        .reserve_exact((3 * element.count).min(walk.left()) as usize);
    let beside = Beside::of(element);
    let mut uvs: Vec<f32> = Vec::new();
    CornerLists::read_all(source, element, walk, |lists, walk| {
        let first = records.corners.len();
        let corners = &mut records.corners;
        let mut texture = 0;
        uvs.clear();
        lists.read_beside(
            walk,
            |value| {
                let corner = corner(value);
                corners.push(corner.unwrap_or(u32::MAX));
                corner.is_some()
            },
            |property, value| {
                if beside.uvs == Some(property) {
                    uvs.push(value as f32);
                }
            },
            |property, value| {
                if beside.texture == Some(property) {
                    texture = corner(value).unwrap_or(0);
                }
            },
        )?;
        let count = records.corners.len() - first;
        if count < 3 {
            records.corners.truncate(first);
            records.left_out += 1;
            return Some(());
        }
        records.face_ends.push(u32::try_from(records.corners.len()).ok()?);
        if beside.uvs.is_some() {
            // Elements of faces before this one had none.
            records.corner_uvs.resize(first, NO_UV);
            let each = uvs.chunks_exact(2).map(|uv| [uv[0], uv[1]]);
            match uvs.len() == 2 * count {
                true => records.corner_uvs.extend(each),
                false => records.corner_uvs.resize(first + count, NO_UV),
            }
        }
        if beside.texture.is_some() {
            records.textures.resize(records.face_ends.len() - 1, 0);
            records.textures.push(texture);
        }
        Some(())
    })
}

/// The texture coordinates of a corner that has none.
const NO_UV: [f32; 2] = [f32::NAN; 2];

/// The properties of a face that affect its appearance.
struct Beside {
    /// The list of the corners' u and v, in turn.
    uvs: Option<usize>,
    /// The number of the texture.
    texture: Option<usize>,
}

impl Beside {
    fn of(element: &Element) -> Self {
        let is_list = |index: &usize| matches!(element.properties[*index].kind, Kind::List { .. });
        Self {
            uvs: element.property(&[UV_LIST]).filter(is_list),
            texture: element.property(&[TEXTURE_NUMBER]).filter(|index| !is_list(index)),
        }
    }
}

/// The name of a face's texture coordinates.
pub(crate) const UV_LIST: &str = "texcoord";

/// The name of the number of a face's texture.
pub(crate) const TEXTURE_NUMBER: &str = "texnumber";

/// Strips: each corner makes a triangle with the two before it, every other one reversed; a negative number ends a
/// strip.
pub(super) fn read_strips(
    source: &Source<'_>,
    element: &Element,
    walk: &mut Walk<'_>,
    records: &mut Records,
) -> Result<(), ReadError> {
    CornerLists::read_all(source, element, walk, |lists, walk| {
        let mut strip = Strip::default();
        let Records { corners, face_ends, .. } = records;
        lists.read(walk, |value| {
            if value < 0.0 {
                strip = Strip::default();
                return true;
            }
            let corner = corner(value);
            // Repeated corners only continue the strip.
            if let Some(triangle) = corner.and_then(|corner| strip.next(corner)) {
                corners.extend(triangle);
                face_ends.push(corners.len() as u32);
            }
            corner.is_some()
        })?;
        u32::try_from(records.corners.len()).ok().map(|_| ())
    })
}

/// Reads the lists of corner numbers of an element's records.
struct CornerLists<'a> {
    source: &'a Source<'a>,
    element: &'a Element,
    /// The property that is the list.
    list: Option<usize>,
    /// The first number that can't be a corner.
    strange: Option<f64>,
}

impl<'a> CornerLists<'a> {
    /// Reads every record by `read_one`, which reads one list by [`Self::read`].
    ///
    /// # Errors
    /// Truncated records; the first number that can't be a corner.
    fn read_all(
        source: &'a Source<'a>,
        element: &'a Element,
        walk: &mut Walk<'_>,
        mut read_one: impl FnMut(&mut Self, &mut Walk<'_>) -> Option<()>,
    ) -> Result<(), ReadError> {
        let mut lists = Self {
            source,
            element,
            list: corner_list(element),
            strange: None,
        };
        read_all(source, element, walk, |walk| read_one(&mut lists, walk))?;
        lists.strange.map_or(Ok(()), |value| {
            let reason = format!("a face names the vertex {value}, which can't exist: correct the face");
            Err(source.malformed(Format::Ply, reason))
        })
    }

    /// Reads one record. `take` gets each number of its list and returns whether it can be a corner.
    fn read(&mut self, walk: &mut Walk<'_>, take: impl FnMut(f64) -> bool) -> Option<()> {
        self.read_beside(walk, take, |_, _| (), |_, _| ())
    }

    /// As [`Self::read`]; `item` and `scalar` get the numbers of the other properties.
    fn read_beside(
        &mut self,
        walk: &mut Walk<'_>,
        mut take: impl FnMut(f64) -> bool,
        mut item: impl FnMut(usize, f64),
        scalar: impl FnMut(usize, f64),
    ) -> Option<()> {
        let Self { list, strange, .. } = self;
        let take = |property, value| {
            if Some(property) != *list {
                item(property, value);
            } else if !take(value) {
                strange.get_or_insert(value);
            }
        };
        let is_wanted = || !self.source.cancel.is_cancelled();
        read_record(self.element, walk, is_wanted, scalar, take)
    }
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
