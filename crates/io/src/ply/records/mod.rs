//! The records after the header: vertices with the data for drawing them, faces, and strips of triangles.

mod drawn_records;
mod faces;
mod record;
mod vertices;

use super::header::{Element, Header};
use super::scalar::Walk;
use crate::source::Source;
use crate::{Format, ReadError, quoted};
pub(super) use drawn_records::{Columns, Places, Records};
pub(super) use faces::{TEXTURE_NUMBER, UV_LIST, corner_list};
use faces::{read_faces, read_strips};
use record::pass_over;
use vertices::read_vertices;

/// Reads the records up to the last element that is drawn.
///
/// # Errors
/// Records that are truncated or aren't numbers, lists with impossible counts, faces that name missing vertices.
pub(super) fn read(source: &Source<'_>, header: &Header) -> Result<Records, ReadError> {
    let mut records = Records::default();
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
            format!("a face names the vertex {missing}, but there are {count}, numbered from 0: correct the face");
        return Err(source.malformed(Format::Ply, reason));
    }
    Ok(records)
}

/// Refuses a count that the remaining bytes can't hold, before anything is allocated for it.
fn check_count(source: &Source<'_>, header: &Header, element: &Element, walk: &Walk<'_>) -> Result<(), ReadError> {
    // The last number of an ascii file needs no separator after it.
    let least = element.count.checked_mul(element.least_bytes(header.encoding));
    let fits = least.is_some_and(|least| least <= walk.left() + 1);
    let is_numbered = element.count < u64::from(u32::MAX) || element.properties.is_empty();
    if fits && is_numbered {
        return Ok(());
    }
    let reason = format!(
        "the header declares {} records of '{}', but only {} bytes are left for them: the file is cut short",
        element.count,
        quoted(&element.name),
        walk.left()
    );
    Err(source.malformed(Format::Ply, reason))
}
