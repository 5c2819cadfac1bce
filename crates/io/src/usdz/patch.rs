//! An edited USDZ file: the layer as read, with other numbers for the points and normals that changed.

use std::ops::Range;

use glam::DVec3;
use pliant_mesh::DrawnVertex;

use super::mesh::Of;
use super::stored::{Instance, Stored};
use super::tokens::{Token, Tokens};
use crate::archive::{Packing, with_parts};
use crate::quote::quoted;
use crate::save::bits::{bit_equal, placed};
use crate::save::course::Course;
use crate::save::frames::Frames;
use crate::save::moved::Moved;
use crate::save::turned::{push_negated, wound_back};
use crate::text::{Splice, push_f32, push_f64};
use crate::{Format, SaveError};

/// Other texts for places in the layer.
type Replaced = Vec<(Range<usize>, Vec<u8>)>;

/// The new bytes, and warnings.
pub(super) fn patched(
    stored: &Stored,
    moved: &Moved<'_>,
    course: &Course<'_>,
) -> Result<(Vec<u8>, Vec<String>), SaveError> {
    let rest: Option<Vec<DVec3>> = stored.look.normals.as_ref().map(|normals| {
        let each = normals.iter();
        each.map(|&normal| glam::Vec3::from(normal).as_dvec3()).collect()
    });
    let (of_frames, course) = course.split(if rest.is_some() { 0.5 } else { 0.0 });
    let frames = match (&rest, moved.moves_nothing()) {
        (Some(rest), false) => Some(moved.frames(rest, &of_frames)?),
        _ => None,
    };
    let mut replaced = Vec::new();
    let mut warnings = Vec::new();
    for (place, instance) in stored.instances.iter().enumerate() {
        course.reach(place, stored.instances.len())?;
        let range = instance.vertices.clone();
        let is_turned = range.clone().any(|vertex| moved.turns(DrawnVertex(vertex)));
        if !is_turned && !range.clone().any(|vertex| moved.moves(DrawnVertex(vertex))) {
            continue;
        }
        points(&mut replaced, &stored.text, instance, moved)?;
        if is_turned {
            turn(&mut replaced, &stored.text, instance, moved)?;
        }
        let Some(rest) = &rest else { continue };
        match &instance.mesh.normals {
            Some(normals) if normals.is_separate() => {
                let of_corners = normals.of == Of::Corners;
                self::normals(
                    &mut replaced,
                    (&stored.text, instance, of_corners),
                    moved,
                    (rest, frames.as_ref()),
                );
            }
            Some(_) => warnings.push(format!(
                "The normals of the mesh {} are shared, so they stay as they were: save as .glb to turn them.",
                quoted(&instance.name)
            )),
            None => {}
        }
    }
    replaced.sort_by_key(|(range, _)| range.start);
    let mut splice = Splice::new(&stored.text);
    for (range, text) in replaced {
        splice.replace(range, |out| out.extend_from_slice(&text));
    }
    let parts = [(stored.place, splice.finish())];
    let bytes = with_parts(&stored.bytes, &parts, Packing::Aligned).map_err(|what| SaveError::CannotHold {
        what: format!("this file, because {what},"),
        format: Format::Usdz,
        remedy: "save in another format".to_owned(),
    })?;
    Ok((bytes, warnings))
}

fn points(replaced: &mut Replaced, text: &[u8], instance: &Instance, moved: &Moved<'_>) -> Result<(), SaveError> {
    let mesh = &instance.mesh;
    let mut is_done = vec![false; mesh.points.len()];
    let inverse = instance.transform.inverse();
    for vertex in instance.vertices.clone() {
        let (rest, new) = (moved.drawn.positions[vertex as usize], moved.positions[vertex as usize]);
        let point = (moved.drawn.file_vertex[vertex as usize].0 - instance.first_file_vertex) as usize;
        // The first drawn vertex that moved counts, as in every format whose vertices are split by their looks.
        if bit_equal(rest, new) || is_done[point] {
            continue;
        }
        is_done[point] = true;
        if !inverse.is_finite() {
            return Err(SaveError::CannotHold {
                what: format!(
                    "the shape of the mesh {}, which the file shows flattened,",
                    quoted(&instance.name)
                ),
                format: Format::Usdz,
                remedy: "save as .glb".to_owned(),
            });
        }
        let own = placed(inverse, new);
        replace_vector(replaced, text, mesh.point_at[point], own, mesh.is_single);
    }
    Ok(())
}

/// Turns and negates the normals of the vertices that moved or are turned inside out.
fn normals(
    replaced: &mut Replaced,
    (text, instance, of_corners): (&[u8], &Instance, bool),
    moved: &Moved<'_>,
    (rest, frames): (&[DVec3], Option<&Frames>),
) {
    let to_own = instance.transform.matrix3.transpose();
    let first = instance.vertices.start;
    for (element, &at) in instance.mesh.normal_at.iter().enumerate() {
        let vertex = match of_corners {
            true => instance.corners.get(element).copied(),
            false => (element < instance.mesh.points.len()).then_some(first + element as u32),
        };
        let Some(vertex) = vertex.map(DrawnVertex) else {
            continue;
        };
        let normal = rest[vertex.index()];
        let carried = frames.map_or(normal, |frames| frames.carry_normal(vertex, normal));
        let is_turned = moved.turns(vertex);
        let is_carried = !bit_equal(carried, normal) && carried.is_finite();
        if !is_carried {
            if is_turned {
                negate(replaced, text, at);
            }
            continue;
        }
        let own = (to_own * carried).normalize_or_zero();
        replace_vector(replaced, text, at, if is_turned { -own } else { own }, true);
    }
}

/// Changes the signs of the three numbers from a place on. Digits stay, so that turning them again restores them.
fn negate(replaced: &mut Replaced, text: &[u8], at: usize) {
    for (word, range) in three_words(text, at) {
        let mut new = Vec::new();
        push_negated(word, &mut new);
        replaced.push((range, new));
    }
}

/// Reverses the corners of the faces that are turned inside out.
fn turn(replaced: &mut Replaced, text: &[u8], instance: &Instance, moved: &Moved<'_>) -> Result<(), SaveError> {
    let mesh = &instance.mesh;
    let is_split = instance.vertices.len() > mesh.points.len();
    if is_split {
        return Err(SaveError::CannotHold {
            what: format!(
                "the mesh {} turned inside out, whose faces have looks of their own at their corners,",
                quoted(&instance.name)
            ),
            format: Format::Usdz,
            remedy: "save as .glb".to_owned(),
        });
    }
    let mut tokens = Tokens::new(text, mesh.corners_value.clone());
    let mut places = Vec::with_capacity(mesh.corners.len());
    while let Ok(Some((token, range))) = tokens.next() {
        if matches!(token, Token::Word(_)) {
            places.push(range);
        }
    }
    let mut start = 0;
    for &count in &mesh.counts {
        let end = start + count as usize;
        let (Some(corners), Some(places)) = (instance.corners.get(start..end), places.get(start..end)) else {
            break;
        };
        if corners.first().is_some_and(|&first| moved.turns(DrawnVertex(first))) {
            let texts = wound_back(places).map(|place| text[place.clone()].to_vec());
            replaced.extend(places.iter().cloned().zip(texts));
        }
        start = end;
    }
    Ok(())
}

/// Replaces the three numbers from a place on, each if it changes.
fn replace_vector(replaced: &mut Replaced, text: &[u8], at: usize, vector: DVec3, is_single: bool) {
    for (number, (word, range)) in vector.to_array().into_iter().zip(three_words(text, at)) {
        let old: Option<f64> = std::str::from_utf8(word).ok().and_then(|word| word.parse().ok());
        let is_same = old.is_some_and(|old| match is_single {
            true => (old as f32).to_bits() == (number as f32).to_bits(),
            false => old.to_bits() == number.to_bits(),
        });
        if !is_same {
            let mut new = Vec::new();
            match is_single {
                true => push_f32(&mut new, number as f32),
                false => push_f64(&mut new, number),
            }
            replaced.push((range, new));
        }
    }
}

/// The next three words from a place on.
fn three_words(text: &[u8], at: usize) -> Vec<(&[u8], Range<usize>)> {
    let mut tokens = Tokens::new(text, at..text.len());
    let mut words = Vec::with_capacity(3);
    while let Ok(Some((token, range))) = tokens.next() {
        if let Token::Word(word) = token {
            words.push((word, range));
        }
        if words.len() == 3 {
            break;
        }
    }
    words
}
