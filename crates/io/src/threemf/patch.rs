//! An edited 3MF file: the archive as read, with other numbers in the parts that have moved vertices.

use std::collections::BTreeMap;
use std::ops::Range;

use glam::{DAffine3, DVec3};
use pliant_mesh::DrawnVertex;

use super::stored::{Instance, Stored};
use super::xml::element_at;
use crate::archive::{Packing, with_parts};
use crate::save::bits::{bit_equal, placed};
use crate::save::course::Course;
use crate::save::moved::Moved;
use crate::text::{Splice, push_f64};
use crate::{Format, SaveError};

/// The share of an object's size within which two places of it may differ from each other.
const SAME: f64 = 1e-9;

/// The changes of one object.
#[derive(Default)]
struct Changes {
    /// The new coordinates of vertices, by their numbers in the object.
    vertices: BTreeMap<u32, DVec3>,
    /// Triangles that are turned, by their numbers in the object.
    turned: Vec<bool>,
}

/// The new bytes.
pub(super) fn patched(stored: &Stored, moved: &Moved<'_>, course: &Course<'_>) -> Result<Vec<u8>, SaveError> {
    let mut changes: BTreeMap<(usize, usize), Changes> = BTreeMap::new();
    let mut shown: BTreeMap<(usize, usize), usize> = BTreeMap::new();
    for (place, instance) in stored.instances.iter().enumerate() {
        course.reach(place, 2 * stored.instances.len())?;
        let key = (instance.part, instance.object);
        let own = gathered(stored, instance, moved)?;
        let times = shown.entry(key).or_default();
        *times += 1;
        let known = changes.entry(key).or_default();
        if *times == 1 {
            *known = own;
        } else if !is_same(stored, instance, known, &own) {
            return Err(SaveError::CannotHold {
                what: "an object that the file shows several times, each in another shape,".to_owned(),
                format: Format::Threemf,
                remedy: "save as .glb, or change all of them alike".to_owned(),
            });
        }
    }
    let mut parts = Vec::new();
    for (number, part) in stored.parts.iter().enumerate() {
        course.reach(stored.parts.len() + number, 2 * stored.parts.len())?;
        let mut replaced = Vec::new();
        for (place, object) in part.objects.iter().enumerate() {
            let Some(changes) = changes.get(&(number, place)) else {
                continue;
            };
            for (&vertex, &position) in &changes.vertices {
                move_vertex(&mut replaced, &part.bytes, object.vertex_at[vertex as usize], position);
            }
            for (triangle, _) in changes.turned.iter().enumerate().filter(|(_, is_turned)| **is_turned) {
                turn(&mut replaced, &part.bytes, object.triangles[triangle].at);
            }
        }
        if !replaced.is_empty() {
            // Attributes and elements may come in any order.
            replaced.sort_by_key(|(range, _)| range.start);
            let mut splice = Splice::new(&part.bytes);
            for (range, text) in replaced {
                splice.replace(range, |out| out.extend_from_slice(&text));
            }
            parts.push((part.place, splice.finish()));
        }
    }
    with_parts(&stored.bytes, &parts, Packing::Deflated).map_err(|what| SaveError::CannotHold {
        what: format!("this file, because {what},"),
        format: Format::Threemf,
        remedy: "save in another format".to_owned(),
    })
}

/// The changes of an object that one of its places asks for.
fn gathered(stored: &Stored, instance: &Instance, moved: &Moved<'_>) -> Result<Changes, SaveError> {
    let object = &stored.parts[instance.part].objects[instance.object];
    let mut changes = Changes::default();
    let to_object = inverse(instance.transform);
    for drawn in instance.vertices.clone() {
        let (rest, new) = (moved.drawn.positions[drawn as usize], moved.positions[drawn as usize]);
        if bit_equal(rest, new) {
            continue;
        }
        let to_object = to_object.ok_or_else(|| SaveError::CannotHold {
            what: format!("the shape of object {}, which the file shows flattened,", object.id),
            format: Format::Threemf,
            remedy: "save as .glb".to_owned(),
        })?;
        let vertex = moved.drawn.file_vertex[drawn as usize].0 - instance.first_file_vertex;
        let own = placed(to_object, new);
        // The first place that moved counts, as in every format whose vertices are split by their looks.
        changes.vertices.entry(vertex).or_insert(own);
    }
    if moved.turns_any() {
        let corners = instance
            .triangles
            .clone()
            .map(|triangle| moved.drawn.triangles[triangle as usize][0]);
        changes.turned = corners.map(|corner: DrawnVertex| moved.turns(corner)).collect();
    }
    Ok(changes)
}

fn inverse(transform: DAffine3) -> Option<DAffine3> {
    let inverse = transform.inverse();
    inverse.is_finite().then_some(inverse)
}

/// Returns true if two places ask for one shape of the object.
fn is_same(stored: &Stored, instance: &Instance, a: &Changes, b: &Changes) -> bool {
    let object = &stored.parts[instance.part].objects[instance.object];
    let size = object.vertices.iter().filter(|vertex| vertex.is_finite());
    let size = size.fold(0.0, |size: f64, vertex| size.max(vertex.abs().max_element()));
    let alike = |(a, b): ((&u32, &DVec3), (&u32, &DVec3))| {
        let most = SAME * size.max(a.1.abs().max_element());
        a.0 == b.0 && (*a.1 - *b.1).abs().max_element() <= most
    };
    a.vertices.len() == b.vertices.len() && a.turned == b.turned && a.vertices.iter().zip(&b.vertices).all(alike)
}

/// Other texts for places in a part.
type Replaced = Vec<(Range<usize>, Vec<u8>)>;

/// Replaces each coordinate that changes.
fn move_vertex(replaced: &mut Replaced, part: &[u8], at: usize, position: DVec3) {
    let Some(element) = element_at(part, at) else { return };
    for (name, number) in ["x", "y", "z"].into_iter().zip(position.to_array()) {
        let (Ok(old), Some((_, range))) = (element.real(name), element.raw(name)) else {
            continue;
        };
        if old.to_bits() != number.to_bits() {
            let mut text = Vec::new();
            push_f64(&mut text, number);
            replaced.push((range, text));
        }
    }
}

/// Exchanges the second and the third corner of a triangle, with their colours or texture coordinates.
fn turn(replaced: &mut Replaced, part: &[u8], at: usize) {
    let Some(element) = element_at(part, at) else { return };
    for [second, third] in [["v2", "v3"], ["p2", "p3"]] {
        if let (Some((of_second, at_second)), Some((of_third, at_third))) = (element.raw(second), element.raw(third)) {
            replaced.push((at_second, of_third.to_vec()));
            replaced.push((at_third, of_second.to_vec()));
        }
    }
}
