//! The places that an exported edit records.

use std::collections::BTreeMap;

use glam::{DAffine3, DVec3};
use pliant_deform::{CONTINUITY_RANGE, Loose, Role};
use pliant_mesh::{Model, SurfaceVertex};

use super::edit_error::EditError;
use super::edit_file::EditFile;
use super::field::{FieldEntry, lowest_file_vertices};
use super::other_mesh::is_beside;
use super::places::{Meaning, Oriented, Painted, Places, sample};
use super::selector::Selector;
use super::setup::Setup;
use crate::document::HandleId;

/// A painted field may be off by this where it would have too many places: its logarithm for a stiffness.
const FIELD_TOLERANCE: f64 = 0.02;

/// A displacement may be off by this share of the box's diagonal there.
const SHAPE_TOLERANCE: f64 = 1e-4;

impl EditFile {
    /// The edit with the places by which another mesh finds its sets. `model` has the vertices whose numbers the edit
    /// has; on it the edit stays the same to the bit.
    ///
    /// # Errors
    /// Those of [`EditFile::resolve`].
    pub fn with_places(&self, model: &Model) -> Result<Self, EditError> {
        let Some(bounds) = model.bounds() else {
            return Ok(self.clone());
        };
        let setup = self.resolve(model)?;
        let mesh = Oriented::of(model);
        let meaning = Meaning {
            class: classes(&setup, model),
            fields: fields(&setup, self, model)?,
            numbers: lowest_file_vertices(model),
        };
        let parts = |selector: &Selector| by_number(selector, model);
        let loose_parts = self.loose_parts.iter();
        let compact = |entries: &[FieldEntry], default: f64| -> Vec<FieldEntry> {
            let each = entries.iter().enumerate();
            each.map(|(index, entry)| entry.compact(if index == 0 { default } else { f64::NAN }))
                .collect()
        };
        Ok(Self {
            places: Some(Places::of(model, &sample(&mesh, bounds, &meaning))),
            loose_parts: loose_parts
                .map(|(select, loose)| Ok((parts(select)?, *loose)))
                .collect::<Result<_, EditError>>()?,
            inside_out: parts(&self.inside_out)?,
            stiffness: compact(&self.stiffness, 1.0),
            continuity: compact(&self.continuity, *CONTINUITY_RANGE.end()),
            ..self.clone()
        })
    }
}

/// A selector of whole parts by vertices, if these select the same vertices: another mesh numbers its parts otherwise.
fn by_number(selector: &Selector, model: &Model) -> Result<Selector, EditError> {
    let selection = selector.evaluate(model)?;
    let numbered = Selector::of_surface(model, |vertex| selection.contains(vertex));
    Ok(match numbered.evaluate(model)? == selection {
        true => numbered,
        false => selector.clone(),
    })
}

/// A number for each surface vertex: the same for vertices in the same sets.
fn classes(setup: &Setup, model: &Model) -> Vec<u32> {
    let loose: BTreeMap<u32, Loose> = setup.loose_parts.iter().copied().collect();
    let mut numbers: Vec<(Role, bool, Option<Loose>, bool)> = Vec::new();
    let meanings = setup.roles.iter().zip(&setup.stiffness).zip(0..);
    let class = |((role, stiffness), vertex): ((&Role, &f64), u32)| {
        let part = model.topology.component(SurfaceVertex(vertex));
        let is_inside_out = setup.inside_out.contains(&part);
        let meaning = (
            *role,
            *stiffness == f64::INFINITY,
            loose.get(&part).copied(),
            is_inside_out,
        );
        let place = numbers.iter().position(|other| *other == meaning);
        place.unwrap_or_else(|| {
            numbers.push(meaning);
            numbers.len() - 1
        }) as u32
    };
    meanings.map(class).collect()
}

/// The fields of an edit that are not the same everywhere.
fn fields(setup: &Setup, edit: &EditFile, model: &Model) -> Result<Vec<Painted>, EditError> {
    let diagonal = model.bounds().map_or(0.0, |bounds| bounds.diagonal());
    let stiffness = setup.stiffness.iter().map(|stiffness| match stiffness.is_finite() {
        true => DVec3::X * stiffness.ln(),
        // Rigid parts are sets.
        false => DVec3::ZERO,
    });
    let continuity = edit.painted_continuity(model)?.into_iter();
    let numbers = |values: Vec<DVec3>| Painted {
        values,
        tolerance: FIELD_TOLERANCE,
        is_exact: true,
    };
    let continuity = continuity.map(|value| DVec3::X * value);
    let mut fields = vec![numbers(stiffness.collect()), numbers(continuity.collect())];
    if let Some(kept) = &setup.kept {
        let shape = |values: &[DVec3], is_exact| Painted {
            values: values.to_vec(),
            tolerance: SHAPE_TOLERANCE * diagonal,
            is_exact,
        };
        fields.extend(
            kept.shape
                .corrections
                .as_ref()
                .map(|corrections| shape(corrections, true)),
        );
        if has_painted_on_bent(setup, model) {
            fields.push(shape(&kept.shape.shape, false));
        }
    }
    fields.retain(|field| field.values.iter().any(|value| *value != field.values[0]));
    Ok(fields)
}

/// Returns true if vertices of a handle are not where it moves them, because they were painted in the bent shape.
fn has_painted_on_bent(setup: &Setup, model: &Model) -> bool {
    let Some(kept) = &setup.kept else { return false };
    let maps: Vec<Option<DAffine3>> = (0..)
        .zip(&setup.handles)
        .map(|(place, handle)| {
            kept.shape
                .targets
                .get(&HandleId(place))
                .filter(|_| handle.line.is_none())
                .copied()
        })
        .collect();
    let diagonal = model.bounds().map_or(0.0, |bounds| bounds.diagonal());
    let each = setup
        .roles
        .iter()
        .zip(&model.surface.positions)
        .zip(kept.shape.shape.iter());
    each.into_iter().any(|((role, position), displacement)| {
        let Role::Handle(handle) = *role else { return false };
        maps[usize::from(handle)].is_some_and(|map| is_beside(map, *position, *displacement, diagonal))
    })
}
