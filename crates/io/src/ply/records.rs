//! The records behind the header: vertices with what is drawn of them, faces, and strips of triangles.

use glam::DVec3;

use super::header::{Element, Header, Kind};
use super::scalar::{Encoding, Walk, decode};
use crate::source::{Looks, Source};
use crate::{Format, ReadError, quoted};

/// What is read of a vertex, in the order of [`Columns`].
pub(super) const COLUMN_NAMES: [&[&str]; 12] = [
    &["x"],
    &["y"],
    &["z"],
    &["nx", "normal_x"],
    &["ny", "normal_y"],
    &["nz", "normal_z"],
    &["red", "r", "diffuse_red"],
    &["green", "g", "diffuse_green"],
    &["blue", "b", "diffuse_blue"],
    &["alpha", "a", "diffuse_alpha"],
    &["s", "u", "texture_u", "texture_s"],
    &["t", "v", "texture_v", "texture_t"],
];

/// The property that holds each thing that is read of a vertex, if any: x, y, z, the normal, red, green, blue, alpha,
/// and the texture coordinates.
pub(super) type Columns = [Option<usize>; COLUMN_NAMES.len()];

/// Where the vertices' records are.
#[derive(Clone, Debug)]
pub(super) enum Places {
    /// One after the other at the same distance.
    Strided { first: usize, stride: usize },
    /// Each where it begins.
    Each(Vec<usize>),
}

impl Places {
    pub(super) fn of(&self, vertex: usize) -> usize {
        match self {
            Self::Strided { first, stride } => first + vertex * stride,
            Self::Each(starts) => starts[vertex],
        }
    }
}

/// The records as far as they are drawn or moved.
#[derive(Debug)]
pub(super) struct Records {
    /// The element that holds the vertices.
    pub(super) vertex_element: Option<usize>,
    pub(super) columns: Columns,
    pub(super) places: Places,
    pub(super) positions: Vec<DVec3>,
    /// Empty where the vertices have none. f32: drawn, and turned on saving, where f32 is what normals need.
    pub(super) normals: Vec<[f32; 3]>,
    /// From 0 to 1, as stored; empty where the vertices have none.
    pub(super) colours: Vec<[f32; 4]>,
    pub(super) uvs: Vec<[f32; 2]>,
    /// Corners of all faces, then strips' triangles, one after the other.
    pub(super) corners: Vec<u32>,
    /// Where each face's corners end.
    pub(super) face_ends: Vec<u32>,
    /// How many faces have fewer than three corners.
    pub(super) left_out: usize,
}

/// Reads the records up to the last element that is drawn.
///
/// # Errors
/// Records that are cut short or aren't numbers, lists with impossible counts, faces that name missing vertices.
pub(super) fn read(source: &Source<'_>, header: &Header) -> Result<Records, ReadError> {
    let mut records = Records {
        vertex_element: None,
        columns: Columns::default(),
        places: Places::Each(Vec::new()),
        positions: Vec::new(),
        normals: Vec::new(),
        colours: Vec::new(),
        uvs: Vec::new(),
        corners: Vec::new(),
        face_ends: Vec::new(),
        left_out: 0,
    };
    let is_drawn = |element: &Element| matches!(element.name.as_str(), "vertex" | "face" | "tristrips");
    let last = header.elements.iter().rposition(is_drawn).map_or(0, |last| last + 1);
    let mut walk = Walk::new(source.bytes, header.data_at, header.encoding);
    for (index, element) in header.elements[..last].iter().enumerate() {
        check_count(source, header, element, &walk)?;
        match element.name.as_str() {
            "vertex" if records.vertex_element.is_none() => {
                records.vertex_element = Some(index);
                read_vertices(source, header, element, &mut walk, &mut records)?;
            }
            // Such records take no bytes, so nothing bounds their count.
            _ if element.properties.is_empty() => {}
            "face" => read_faces(source, element, &mut walk, &mut records)?,
            "tristrips" => read_strips(source, element, &mut walk, &mut records)?,
            _ => pass_over(source, header, element, &mut walk)?,
        }
        source
            .progress
            .set(0.8 * (1.0 - walk.left() as f32 / source.bytes.len() as f32));
    }
    let count = records.positions.len();
    if let Some(&missing) = records.corners.iter().find(|&&corner| corner as usize >= count) {
        let reason =
            format!("a face names the vertex {missing}, but there are {count}, counted from 0: correct the face");
        return Err(source.malformed(Format::Ply, reason));
    }
    Ok(records)
}

/// Refuses a count that the bytes left can't hold, before anything is allocated for it.
fn check_count(source: &Source<'_>, header: &Header, element: &Element, walk: &Walk<'_>) -> Result<(), ReadError> {
    // The last number of an ascii file needs no separator behind it.
    let least = element.count.checked_mul(element.least_bytes(header.encoding));
    let fits = least.is_some_and(|least| least <= walk.left() + 1);
    let is_numbered = element.count < u64::from(u32::MAX) || element.properties.is_empty();
    if fits && is_numbered {
        return Ok(());
    }
    let reason = format!(
        "the header promises {} records of '{}', but only {} bytes are left for them: the file is cut short",
        element.count,
        quoted(&element.name),
        walk.left()
    );
    Err(source.malformed(Format::Ply, reason))
}

fn cut_short(source: &Source<'_>, element: &Element, record: u64, at: usize) -> ReadError {
    let reason = if at >= source.bytes.len() || source.bytes[at..].trim_ascii().is_empty() {
        format!(
            "the file ends in record {record} of {} of '{}': it is cut short",
            element.count,
            quoted(&element.name)
        )
    } else {
        format!(
            "record {record} of '{}' is damaged (byte {at}): export the file anew",
            quoted(&element.name)
        )
    };
    source.malformed(Format::Ply, reason)
}

/// Items of a list between two looks at whether they are still wanted.
const ITEMS_BETWEEN_LOOKS: u64 = 1 << 12;

/// Reads one record, giving each scalar with its property's number and each list's items.
fn read_record(
    element: &Element,
    walk: &mut Walk<'_>,
    is_wanted: impl Fn() -> bool,
    mut scalar: impl FnMut(usize, f64),
    mut item: impl FnMut(usize, f64),
) -> Option<()> {
    for (index, property) in element.properties.iter().enumerate() {
        match property.kind {
            Kind::Scalar(kind) => scalar(index, walk.number(kind)?.0),
            Kind::List { count, item: kind } => {
                let count = walk.number(count)?.0;
                if !(count >= 0.0 && count.fract() == 0.0 && count <= walk.left() as f64) {
                    return None;
                }
                for number in 0..count as u64 {
                    // A list may be as long as the file.
                    if number.is_multiple_of(ITEMS_BETWEEN_LOOKS) && !is_wanted() {
                        return None;
                    }
                    item(index, walk.number(kind)?.0);
                }
            }
        }
    }
    Some(())
}

/// Reads all records of an element, `visit` before each of them.
fn read_all(
    source: &Source<'_>,
    element: &Element,
    walk: &mut Walk<'_>,
    mut read_one: impl FnMut(&mut Walk<'_>) -> Option<()>,
) -> Result<(), ReadError> {
    let mut looks = Looks::default();
    for record in 0..element.count {
        source.pass(&mut looks, walk.at())?;
        if read_one(walk).is_none() {
            source.cancel.check()?;
            return Err(cut_short(source, element, record, walk.at()));
        }
    }
    Ok(())
}

fn pass_over(source: &Source<'_>, header: &Header, element: &Element, walk: &mut Walk<'_>) -> Result<(), ReadError> {
    match element.stride() {
        Some(stride) if header.encoding != Encoding::Ascii => {
            walk.skip(stride.saturating_mul(element.count as usize));
            Ok(())
        }
        _ => read_all(source, element, walk, |walk| {
            read_record(element, walk, || !source.cancel.is_cancelled(), |_, _| (), |_, _| ())
        }),
    }
}

fn read_vertices(
    source: &Source<'_>,
    header: &Header,
    element: &Element,
    walk: &mut Walk<'_>,
    records: &mut Records,
) -> Result<(), ReadError> {
    let is_scalar = |&index: &usize| matches!(element.properties[index].kind, Kind::Scalar(_));
    let columns = COLUMN_NAMES.map(|names| element.property(names).filter(is_scalar));
    records.columns = columns;
    if element.count == 0 {
        return Ok(());
    }
    if let Some(missing) = (0..3).find(|&axis| columns[axis].is_none()) {
        let reason = format!(
            "its vertices have no '{}': export the file anew",
            COLUMN_NAMES[missing][0]
        );
        return Err(source.malformed(Format::Ply, reason));
    }
    let has = |span: std::ops::Range<usize>| columns[span].iter().all(Option::is_some);
    let (has_normals, has_colours, has_uvs) = (has(3..6), has(6..9), has(10..12));
    // Colours are counted by their type: bytes to 255, 16 bits to 65535, floating point to 1.
    let colour_scale = columns[6].map_or(1.0, |red| match element.properties[red].kind {
        Kind::Scalar(scalar) => scalar.integer_range().map_or(1.0, |[_, most]| most.recip()),
        Kind::List { .. } => 1.0,
    });
    // The count was held against the bytes that are left.
    let count = element.count as usize;
    records.positions.reserve_exact(count);
    records.normals.reserve_exact(if has_normals { count } else { 0 });
    records.colours.reserve_exact(if has_colours { count } else { 0 });
    records.uvs.reserve_exact(if has_uvs { count } else { 0 });
    let mut take = |values: &[f64; COLUMN_NAMES.len()]| {
        records.positions.push(DVec3::new(values[0], values[1], values[2]));
        if has_normals {
            records.normals.push([3, 4, 5].map(|slot: usize| values[slot] as f32));
        }
        if has_colours {
            let alpha = if columns[9].is_some() {
                values[9] * colour_scale
            } else {
                1.0
            };
            let [r, g, b] = [6, 7, 8].map(|slot: usize| (values[slot] * colour_scale) as f32);
            records.colours.push([r, g, b, alpha as f32]);
        }
        if has_uvs {
            records.uvs.push([values[10] as f32, values[11] as f32]);
        }
    };
    let mut values = [0.0; COLUMN_NAMES.len()];
    if header.encoding != Encoding::Ascii
        && let Some(stride) = element.stride()
    {
        let wanted = wanted_offsets(element, &columns);
        let first = walk.at();
        for vertex in 0..element.count as usize {
            if vertex.is_multiple_of(1 << 13) {
                source.cancel.check()?;
            }
            for &(slot, offset, scalar) in &wanted {
                values[slot] = decode(source.bytes, first + vertex * stride + offset, scalar, header.encoding)
                    .ok_or_else(|| cut_short(source, element, vertex as u64, source.bytes.len()))?;
            }
            take(&values);
        }
        walk.skip(stride * element.count as usize);
        records.places = Places::Strided { first, stride };
        return Ok(());
    }
    let mut slots = vec![COLUMN_NAMES.len(); element.properties.len()];
    for (slot, property) in columns.iter().enumerate() {
        if let Some(property) = property {
            slots[*property] = slot;
        }
    }
    let mut starts = Vec::new();
    read_all(source, element, walk, |walk| {
        starts.push(walk.at());
        let keep = |property: usize, value| {
            if let Some(target) = values.get_mut(slots[property]) {
                *target = value;
            }
        };
        read_record(element, walk, || !source.cancel.is_cancelled(), keep, |_, _| ())?;
        take(&values);
        Some(())
    })?;
    records.places = Places::Each(starts);
    Ok(())
}

/// Column, offset within a binary record and type of what is read of a vertex.
fn wanted_offsets(element: &Element, columns: &Columns) -> Vec<(usize, usize, super::scalar::Scalar)> {
    let mut wanted = Vec::new();
    let mut offset = 0;
    for (index, property) in element.properties.iter().enumerate() {
        let Kind::Scalar(scalar) = property.kind else { continue };
        if let Some(slot) = columns.iter().position(|column| *column == Some(index)) {
            wanted.push((slot, offset, scalar));
        }
        offset += scalar.size();
    }
    wanted
}

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

fn read_faces(
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
fn read_strips(
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
