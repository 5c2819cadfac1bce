//! Binary STL: an 80-byte header, a count, and 50 bytes per facet, little-endian.

use glam::{DVec3, Vec3};
use pliant_mesh::Cancelled;

use super::facets::{changed_facets, facet_normal};
use crate::save::course::{Course, STEP};
use crate::save::moved::Moved;
use crate::source::Source;
use crate::{Format, ReadError};

/// Bytes before the first facet.
const HEADER: usize = 84;

/// Bytes per facet: the normal, three corners and two attribute bytes.
const FACET: usize = 50;

fn stored_count(bytes: &[u8]) -> Option<u64> {
    let count: [u8; 4] = bytes.get(80..HEADER)?.try_into().ok()?;
    Some(u64::from(u32::from_le_bytes(count)))
}

/// Returns true if a file is binary, for any first word: its length is exactly that of its facet count, or its count
/// has a byte that no text has, and the file has all its facets.
pub(super) fn is_certain(bytes: &[u8]) -> bool {
    stored_count(bytes).is_some_and(|count| {
        let (wanted, length) = (HEADER as u64 + count * FACET as u64, bytes.len() as u64);
        wanted == length || wanted < length && bytes[80..HEADER].contains(&0)
    })
}

/// The facets of a file.
pub(super) struct Facets {
    /// The corners in order.
    pub(super) corners: Vec<DVec3>,
    /// True if a facet has attribute bytes, which some programs use for a colour.
    pub(super) have_attributes: bool,
}

/// The facets. Bytes after them are noted and kept.
pub(super) fn read(source: &Source<'_>, notes: &mut Vec<String>) -> Result<Facets, ReadError> {
    let bytes: &[u8] = source.bytes;
    let Some(count) = stored_count(bytes) else {
        let reason = "it has neither the 84 bytes of a binary header nor the 'solid' of an ascii file: export it again";
        return Err(source.malformed(Format::Stl, reason));
    };
    let room = (bytes.len() - HEADER) / FACET;
    if count > room as u64 {
        let reason = format!("it declares {count} facets but has only {room}: the file is cut short or not STL");
        return Err(source.malformed(Format::Stl, reason));
    }
    if count > u64::from(u32::MAX / 3) {
        return Err(ReadError::TooLarge {
            name: source.name.to_owned(),
            what: format!("{count} facets"),
        });
    }
    let rest = bytes.len() - HEADER - count as usize * FACET;
    if rest > 0 {
        notes.push(format!(
            "The file has {rest} bytes after its {count} facets; they are kept but not shown."
        ));
    }
    let mut corners = Vec::with_capacity(3 * count as usize);
    let mut have_attributes = false;
    for (number, facet) in bytes[HEADER..].chunks_exact(FACET).take(count as usize).enumerate() {
        if number.is_multiple_of(1 << 13) {
            source.cancel.check()?;
        }
        for corner in facet[12..48].chunks_exact(12) {
            corners.push(vector(corner).as_dvec3());
        }
        have_attributes |= facet[48..] != [0, 0];
    }
    Ok(Facets {
        corners,
        have_attributes,
    })
}

fn vector(bytes: &[u8]) -> Vec3 {
    Vec3::from_array(std::array::from_fn(|axis| {
        f32::from_le_bytes(std::array::from_fn(|byte| bytes[4 * axis + byte]))
    }))
}

fn put(out: &mut [u8], vector: DVec3) {
    // f32 is the format's precision.
    for (target, number) in out.chunks_exact_mut(4).zip(vector.as_vec3().to_array()) {
        target.copy_from_slice(&number.to_le_bytes());
    }
}

/// The bytes with the moved corners and their facets' normals replaced.
pub(super) fn patched(
    bytes: &[u8],
    facet_count: usize,
    moved: &Moved<'_>,
    course: &Course<'_>,
) -> Result<Vec<u8>, Cancelled> {
    let mut out = bytes.to_vec();
    let changed = changed_facets(moved).take_while(|(number, ..)| *number < facet_count);
    for (place, (number, corners, has_moved)) in changed.enumerate() {
        if place.is_multiple_of(STEP) {
            course.reach(number, facet_count)?;
        }
        let facet = &mut out[HEADER + number * FACET..][..FACET];
        put(&mut facet[..12], facet_normal(corners));
        for k in 0..3 {
            if has_moved[k] {
                put(&mut facet[12 + 12 * k..24 + 12 * k], corners[k]);
            }
        }
    }
    Ok(out)
}

/// The bytes with reversed facets and normals.
pub(super) fn turned(mut bytes: Vec<u8>, facet_count: usize, is_turned: impl Fn(usize) -> bool) -> Vec<u8> {
    let facets = bytes[HEADER..].chunks_exact_mut(FACET).take(facet_count).enumerate();
    for (_, facet) in facets.filter(|(number, _)| is_turned(*number)) {
        for number in facet[..12].chunks_exact_mut(4) {
            // The sign of a little-endian f32.
            number[3] ^= 0x80;
        }
        let (second, third) = facet[24..48].split_at_mut(12);
        second.swap_with_slice(third);
    }
    bytes
}
