//! The vertices' records: the properties that are read of them, and their values.

use glam::DVec3;

use super::drawn_records::{COLUMN_NAMES, Columns, Places, Records};
use super::record::{cut_short, read_all, read_record};
use crate::ply::header::{Element, Header, Kind};
use crate::ply::scalar::{Encoding, Scalar, Walk, decode};
use crate::source::Source;
use crate::{Format, ReadError};

pub(super) fn read_vertices(
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
            "its vertices have no '{}': export the file again",
            COLUMN_NAMES[missing][0]
        );
        return Err(source.malformed(Format::Ply, reason));
    }
    let mut vertices = Vertices::reserved(element, records);
    let places = match element.stride().filter(|_| header.encoding != Encoding::Ascii) {
        Some(stride) => read_strided(source, header, element, stride, walk, &mut vertices)?,
        None => read_each(source, element, walk, &mut vertices)?,
    };
    records.places = places;
    if let Some(Kind::Scalar(scalar)) = columns[6].map(|red| element.properties[red].kind) {
        scale_colours(&mut records.colours, scalar);
    }
    Ok(())
}

/// Scales stored colours to the range from 0 to 1. Bytes count to 255 and unsigned 16-bit numbers to 65535. The other
/// types can hold more than any program's largest value, so the largest channel decides: floating point counts to 1,
/// whole numbers to 255 or to 65535, whichever is enough. A missing alpha is infinite, and becomes 1.
fn scale_colours(colours: &mut [[f32; 4]], scalar: Scalar) {
    let largest = colours
        .iter()
        .flat_map(|[r, g, b, _]| [r, g, b])
        .fold(0.0, |most: f32, &channel| most.max(channel));
    let ranges: &[f32] = match scalar {
        Scalar::I8 | Scalar::U8 => &[255.0],
        Scalar::U16 => &[65_535.0],
        Scalar::F32 | Scalar::F64 => &[1.0, 255.0, 65_535.0],
        _ => &[255.0, 65_535.0],
    };
    let enough = ranges.iter().copied().find(|most| largest <= *most);
    let most = enough.unwrap_or(largest);
    for colour in colours {
        *colour = colour.map(|channel| (channel / most).min(1.0));
    }
}

/// The values of a vertex's columns; columns that the file doesn't have are not read.
type Values = [f64; COLUMN_NAMES.len()];

/// The records to which vertices are appended, and the columns that the file has.
struct Vertices<'a> {
    records: &'a mut Records,
    has_normals: bool,
    has_colours: bool,
    has_alpha: bool,
    has_uvs: bool,
}

impl<'a> Vertices<'a> {
    /// Reserves room for all vertices of the element in `records`, whose columns are known.
    fn reserved(element: &Element, records: &'a mut Records) -> Self {
        let columns = records.columns;
        let has = |span: std::ops::Range<usize>| columns[span].iter().all(Option::is_some);
        let (has_normals, has_colours, has_uvs) = (has(3..6), has(6..9), has(10..12));
        // The count was checked against the remaining bytes.
        let count = element.count as usize;
        records.positions.reserve_exact(count);
        records.normals.reserve_exact(if has_normals { count } else { 0 });
        records.colours.reserve_exact(if has_colours { count } else { 0 });
        records.uvs.reserve_exact(if has_uvs { count } else { 0 });
        Self {
            records,
            has_normals,
            has_colours,
            has_alpha: columns[9].is_some(),
            has_uvs,
        }
    }

    fn push(&mut self, values: &Values) {
        let records = &mut *self.records;
        records.positions.push(DVec3::new(values[0], values[1], values[2]));
        if self.has_normals {
            records.normals.push([3, 4, 5].map(|slot: usize| values[slot] as f32));
        }
        if self.has_colours {
            let alpha = if self.has_alpha {
                values[9] as f32
            } else {
                f32::INFINITY
            };
            let [r, g, b] = [6, 7, 8].map(|slot: usize| values[slot] as f32);
            records.colours.push([r, g, b, alpha]);
        }
        if self.has_uvs {
            records.uvs.push([values[10] as f32, values[11] as f32]);
        }
    }
}

/// Reads binary records that are all of `stride` bytes.
fn read_strided(
    source: &Source<'_>,
    header: &Header,
    element: &Element,
    stride: usize,
    walk: &mut Walk<'_>,
    vertices: &mut Vertices<'_>,
) -> Result<Places, ReadError> {
    let wanted = wanted_offsets(element, &vertices.records.columns);
    let first = walk.at();
    let mut values: Values = Default::default();
    for vertex in 0..element.count as usize {
        if vertex.is_multiple_of(1 << 13) {
            source.cancel.check()?;
        }
        for &(slot, offset, scalar) in &wanted {
            values[slot] = decode(source.bytes, first + vertex * stride + offset, scalar, header.encoding)
                .ok_or_else(|| cut_short(source, element, vertex as u64, source.bytes.len()))?;
        }
        vertices.push(&values);
    }
    walk.skip(stride * element.count as usize);
    Ok(Places::Strided { first, stride })
}

/// Reads records with different lengths: text, or records with lists.
fn read_each(
    source: &Source<'_>,
    element: &Element,
    walk: &mut Walk<'_>,
    vertices: &mut Vertices<'_>,
) -> Result<Places, ReadError> {
    let mut slots = vec![COLUMN_NAMES.len(); element.properties.len()];
    for (slot, property) in vertices.records.columns.iter().enumerate() {
        if let Some(property) = property {
            slots[*property] = slot;
        }
    }
    let mut values: Values = Default::default();
    let mut starts = Vec::new();
    read_all(source, element, walk, |walk| {
        starts.push(walk.at());
        let keep = |property: usize, value| {
            if let Some(target) = values.get_mut(slots[property]) {
                *target = value;
            }
        };
        read_record(element, walk, || !source.cancel.is_cancelled(), keep, |_, _| ())?;
        vertices.push(&values);
        Some(())
    })?;
    Ok(Places::Each(starts))
}

/// Column, offset within a binary record and type of each datum of a vertex.
fn wanted_offsets(element: &Element, columns: &Columns) -> Vec<(usize, usize, Scalar)> {
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
