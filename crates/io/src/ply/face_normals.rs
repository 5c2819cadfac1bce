//! Normals of faces, which turn with them: `nx ny nz` in the element `face`.

use glam::{DMat3, DVec3};
use pliant_mesh::face_gradient;

use super::header::{Element, Kind};
use super::records::corner_list;
use super::rewriting::{Number, Out, record};
use super::scalar::{Scalar, Walk};
use super::stored::Stored;
use crate::save::frames::carried_normal;
use crate::save::moved::Moved;

/// A change of a face's normal.
enum Change {
    /// It turns by this gradient.
    Carried(DMat3),
    /// It points the other way.
    Negated,
}

/// The bytes, which may have other vertices already, with the normals of the faces at moved vertices turned.
pub(super) fn carried(stored: &Stored, bytes: Vec<u8>, moved: &Moved<'_>) -> Vec<u8> {
    rewritten(stored, bytes, |corners| gradient(corners, moved).map(Change::Carried))
}

/// The bytes, in which the faces whose first corner is `turned` inside out get the opposite normals.
pub(super) fn negated(stored: &Stored, bytes: Vec<u8>, turned: &[bool]) -> Vec<u8> {
    rewritten(stored, bytes, |corners| {
        let first = corners.first().and_then(|&corner| turned.get(corner));
        first.is_some_and(|is_turned| *is_turned).then_some(Change::Negated)
    })
}

fn rewritten(stored: &Stored, bytes: Vec<u8>, change: impl Fn(&[usize]) -> Option<Change>) -> Vec<u8> {
    let header = &stored.header;
    if !header.elements.iter().any(|element| columns(element).is_some()) {
        return bytes;
    }
    let mut out = Out::of(&bytes, header.encoding);
    let mut walk = Walk::new(&bytes, header.data_at, header.encoding);
    // Such elements' records take no bytes.
    for element in header.elements.iter().filter(|element| !element.properties.is_empty()) {
        let found = columns(element);
        for _ in 0..element.count {
            let Some(numbers) = record(element, &mut walk) else {
                return out.finish();
            };
            let Some((list, columns)) = &found else { continue };
            let old: Vec<&Number> = columns
                .iter()
                .filter_map(|(column, _)| numbers[*column].first())
                .collect();
            let [x, y, z] = old[..] else { continue };
            let corners: Vec<usize> = numbers[*list].iter().map(|(corner, _)| *corner as usize).collect();
            let Some(change) = change(&corners) else { continue };
            let normal = DVec3::new(x.0, y.0, z.0);
            let new = match &change {
                Change::Carried(gradient) => carried_normal(*gradient, normal).to_array().map(Some),
                Change::Negated => [None; 3],
            };
            let mut changes: Vec<(&Number, Scalar, Option<f64>)> = (old.iter().zip(columns).zip(new))
                .map(|((number, (_, scalar)), new)| (*number, *scalar, new))
                .collect();
            // In the order of the bytes.
            changes.sort_by_key(|(number, ..)| number.1.start);
            for (number, scalar, new) in changes {
                match new {
                    Some(new) => out.set(number, scalar, new),
                    None => out.negate(number, scalar),
                }
            }
        }
    }
    out.finish()
}

/// The list of corners and the three columns of a normal, with their types, for an element of faces that has them.
fn columns(element: &Element) -> Option<(usize, [(usize, Scalar); 3])> {
    if element.name != "face" {
        return None;
    }
    let column = |names: &[&str]| {
        let column = element.property(names)?;
        match element.properties[column].kind {
            Kind::Scalar(scalar) => Some((column, scalar)),
            Kind::List { .. } => None,
        }
    };
    let normal = [
        column(&["nx", "normal_x"])?,
        column(&["ny", "normal_y"])?,
        column(&["nz", "normal_z"])?,
    ];
    Some((corner_list(element)?, normal))
}

/// The mean gradient of a face's triangles, weighted by area; `None` if no corner moved or the face has no area.
fn gradient(corners: &[usize], moved: &Moved<'_>) -> Option<DMat3> {
    let of_file = moved.of_file();
    if !corners
        .iter()
        .any(|&corner| of_file.get(corner).is_some_and(Option::is_some))
    {
        return None;
    }
    let rest = |corner: usize| moved.drawn.positions.get(corner).copied();
    let new = |corner: usize| of_file.get(corner).copied().flatten().or_else(|| rest(corner));
    let (mut sum, mut whole) = (DMat3::ZERO, 0.0);
    for k in 2..corners.len() {
        let fan = [corners[0], corners[k - 1], corners[k]];
        let [a, b, c] = fan.map(rest);
        let [d, e, f] = fan.map(new);
        let (rest, new) = ([a?, b?, c?], [d?, e?, f?]);
        let area = 0.5 * (rest[1] - rest[0]).cross(rest[2] - rest[0]).length();
        let gradient = face_gradient(rest, new);
        if area > 0.0 && gradient.is_finite() {
            sum += gradient * area;
            whole += area;
        }
    }
    (whole > 0.0).then(|| sum * whole.recip())
}
