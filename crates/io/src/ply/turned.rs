//! A PLY file with some parts turned inside out: the corners of their faces in reverse, and normals with other signs.

use super::header::Kind;
use super::records::{UV_LIST, corner_list};
use super::rewriting::{Number, Out, record};
use super::scalar::Walk;
use super::stored::{Stored, cannot_hold};
use crate::SaveError;
use crate::save::turned::wound_back;

/// The new bytes; `turned` says for each vertex whether its part is turned.
///
/// # Errors
/// Strips of triangles, whose winding alternates.
pub(super) fn turned(stored: &Stored, bytes: &[u8], turned: &[bool]) -> Result<Vec<u8>, SaveError> {
    let header = &stored.header;
    let mut out = Out::of(bytes, header.encoding);
    let mut walk = Walk::new(bytes, header.data_at, header.encoding);
    for (index, element) in header.elements.iter().enumerate() {
        // Such records take no bytes.
        if element.properties.is_empty() {
            continue;
        }
        match element.name.as_str() {
            "tristrips" if element.count > 0 => {
                return Err(cannot_hold(
                    "strips of triangles that are turned inside out".to_owned(),
                    "save as .glb",
                ));
            }
            "vertex" if Some(index) == stored.vertex_element => {
                // In the order of the bytes.
                let mut columns: Vec<usize> = stored.columns[3..6].iter().flatten().copied().collect();
                columns.sort_unstable();
                for is_turned in turned {
                    let Some(numbers) = record(element, &mut walk) else {
                        break;
                    };
                    for &column in columns.iter().filter(|_| *is_turned) {
                        if let (Kind::Scalar(scalar), Some(number)) =
                            (element.properties[column].kind, numbers[column].first())
                        {
                            out.negate(number, scalar);
                        }
                    }
                }
            }
            "face" => {
                let list = corner_list(element);
                let uvs = element.property(&[UV_LIST]);
                for _ in 0..element.count {
                    let Some(numbers) = record(element, &mut walk) else {
                        break;
                    };
                    let Some(corners) = list.map(|list| &numbers[list]) else {
                        continue;
                    };
                    let first = corners.first().and_then(|(corner, _)| turned.get(*corner as usize));
                    if !first.is_some_and(|is_turned| *is_turned) {
                        continue;
                    }
                    let mut copies: Vec<(&Number, &Number)> = corners.iter().zip(wound_back(corners)).collect();
                    // Texture coordinates move with their corners.
                    let uvs: Vec<&[Number]> = uvs.map_or(Vec::new(), |uvs| numbers[uvs].chunks_exact(2).collect());
                    if uvs.len() == corners.len() {
                        let pairs = uvs.iter().zip(wound_back(&uvs));
                        copies.extend(pairs.flat_map(|(old, new)| old.iter().zip(new.iter())));
                    }
                    // In the order of the bytes.
                    copies.sort_by_key(|((_, old), _)| old.start);
                    for ((_, old), (_, new)) in copies {
                        out.copy(old, new);
                    }
                }
            }
            _ => {
                for _ in 0..element.count {
                    if record(element, &mut walk).is_none() {
                        break;
                    }
                }
            }
        }
    }
    Ok(out.finish())
}
