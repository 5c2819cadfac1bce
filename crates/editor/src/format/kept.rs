//! The kept shape (see `document/kept_shape`), in a project and in an edit.

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::sync::Arc;

use glam::{DAffine3, DVec3};
use pliant_deform::Method;
use pliant_mesh::Model;
use serde::{Deserialize, Serialize};
use serde_json::Value;

use crate::EditError;
use crate::document::{Carries, HandleCurve, HandleId, KeptShape, bits_equal};
use crate::format::method::method_to_value;
use crate::format::stored_field::Field;

/// A kept shape: the visible shape, and the handles, control points and examples' weights at that time.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct StoredKept {
    /// The method, with its options, that has made the shape: another method takes only the corrections by hand.
    /// Without it every method takes the whole shape.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    method: Option<Value>,
    /// Each handle's map of rest positions, by its number: three columns and the translation.
    handles: BTreeMap<u32, [f64; 12]>,
    /// The handles' curves, by the same numbers.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    curves: BTreeMap<u32, HandleCurve>,
    /// The moved positions of control points.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    controls: Option<Vec<[f64; 3]>>,
    /// The examples' weights, `null` for one that was found.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    weights: Vec<Option<f64>>,
    /// Displacements from the rest shape; `None` is the rest shape.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    shape: Option<Field>,
    /// The part of these that was corrected by hand; `None` without any.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    corrections: Option<Field>,
    /// The residual beside the solution.
    #[serde(default, skip_serializing_if = "StoredCarries::is_default")]
    carries: StoredCarries,
}

/// [`Carries`] by its name.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case", expecting = "\"difference\" or \"corrections\"")]
enum StoredCarries {
    #[default]
    Difference,
    Corrections,
}

impl StoredCarries {
    fn is_default(&self) -> bool {
        *self == Self::default()
    }
}

impl StoredKept {
    pub(crate) fn of(kept: &KeptShape, model: &Model) -> Self {
        let handles = kept.targets.iter();
        Self {
            method: None,
            handles: handles
                .map(|(id, map)| (u32::from(id.0), map.to_cols_array()))
                .collect(),
            curves: kept
                .curves
                .iter()
                .map(|(id, curve)| (u32::from(id.0), curve.clone()))
                .collect(),
            controls: kept
                .controls
                .as_ref()
                .map(|controls| controls.iter().map(|point| point.to_array()).collect()),
            weights: kept.weights.clone(),
            shape: stored(&kept.shape, model),
            corrections: kept
                .corrections
                .as_ref()
                .and_then(|corrections| stored(corrections, model)),
            carries: match kept.carries {
                Carries::Difference => StoredCarries::Difference,
                Carries::Corrections => StoredCarries::Corrections,
            },
        }
    }

    /// The remaining part for another method; `None` if nothing was corrected by hand.
    pub(crate) fn for_another_method(self) -> Option<Self> {
        self.corrections.as_ref()?;
        Some(Self {
            method: None,
            carries: StoredCarries::Corrections,
            ..self
        })
    }

    /// The shape on its mesh; `name` is the member's, for messages.
    ///
    /// # Errors
    /// Those of [`Field::displacements`].
    pub(crate) fn on(&self, model: &Model, name: &str) -> Result<KeptShape, EditError> {
        let shape = match &self.shape {
            Some(shape) => shape.displacements(&format!("{name}: shape"), model)?,
            None => Arc::new(vec![DVec3::ZERO; model.surface.positions.len()]),
        };
        let corrections = self.corrections.as_ref();
        let corrections = corrections.map(|field| field.displacements(&format!("{name}: corrections"), model));
        let handle = |id: &u32| HandleId(u16::try_from(*id).unwrap_or(u16::MAX));
        let maps = self.handles.iter();
        let curves = self.curves.iter();
        Ok(KeptShape {
            targets: maps
                .map(|(id, map)| (handle(id), DAffine3::from_cols_array(map)))
                .collect(),
            curves: curves.map(|(id, curve)| (handle(id), curve.clone())).collect(),
            controls: self.controls.as_ref().map(|controls| {
                let points = controls.iter().map(|point| DVec3::from_array(*point));
                Arc::new(points.collect())
            }),
            weights: self.weights.clone(),
            shape,
            corrections: corrections.transpose()?,
            carries: match self.carries {
                StoredCarries::Difference => Carries::Difference,
                StoredCarries::Corrections => Carries::Corrections,
            },
        })
    }

    /// The map of a handle with the shape, by its place in the list.
    pub(crate) fn map_of(&self, handle: usize) -> Option<DAffine3> {
        Some(DAffine3::from_cols_array(
            self.handles.get(&u32::try_from(handle).ok()?)?,
        ))
    }

    /// The shape's displacement of each of `count` drawn vertices.
    ///
    /// # Errors
    /// Those of [`Field::by_number`].
    pub(crate) fn shape_by_number(&self, count: usize) -> Result<Vec<DVec3>, EditError> {
        displacements(self.shape.as_ref(), "kept: shape", count)
    }

    /// The same for the corrections by hand; `None` without any.
    ///
    /// # Errors
    /// Those of [`Field::by_number`].
    pub(crate) fn corrections_by_number(&self, count: usize) -> Result<Option<Vec<DVec3>>, EditError> {
        let corrections = self.corrections.as_ref();
        let field = corrections.map(|field| displacements(Some(field), "kept: corrections", count));
        field.transpose()
    }

    /// The same with these displacements of the surface's vertices of another mesh.
    pub(crate) fn on_other(self, model: &Model, shape: &[DVec3], corrections: Option<&[DVec3]>) -> Self {
        Self {
            shape: stored(shape, model),
            corrections: corrections.and_then(|corrections| stored(corrections, model)),
            ..self
        }
    }

    /// The same as a shape that `method` has made.
    pub(crate) fn by(self, method: &Method) -> Self {
        Self {
            method: Some(method_to_value(method, &BTreeMap::new())),
            ..self
        }
    }

    /// The part of it that `method` takes; `None` for no part.
    pub(crate) fn taken_by(&self, method: &Method) -> Option<Cow<'_, Self>> {
        match &self.method {
            Some(by) if *by != method_to_value(method, &BTreeMap::new()) => {
                self.clone().for_another_method().map(Cow::Owned)
            }
            _ => Some(Cow::Borrowed(self)),
        }
    }

    /// The same with other numbers for the handles; those without one are left out.
    pub(crate) fn renumbered(mut self, number: impl Fn(HandleId) -> Option<u32>) -> Self {
        let place = |id: u32| number(HandleId(u16::try_from(id).ok()?));
        let handles = self.handles.into_iter();
        self.handles = handles.filter_map(|(id, map)| Some((place(id)?, map))).collect();
        let curves = self.curves.into_iter();
        self.curves = curves.filter_map(|(id, curve)| Some((place(id)?, curve))).collect();
        self
    }
}

/// Displacements without those that are zero.
fn stored(field: &[DVec3], model: &Model) -> Option<Field> {
    Field::of(model, |vertex| {
        let value = field[vertex.index()];
        (!bits_equal(value, DVec3::ZERO)).then_some(value.to_array())
    })
}

fn displacements(field: Option<&Field>, name: &str, count: usize) -> Result<Vec<DVec3>, EditError> {
    let Some(field) = field else {
        return Ok(vec![DVec3::ZERO; count]);
    };
    Ok(field
        .by_number(name, count)?
        .into_iter()
        .map(DVec3::from_array)
        .collect())
}
