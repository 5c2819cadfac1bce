//! The kept shape (see `document/kept_shape`), as a project stores it, and an edit.

use std::collections::BTreeMap;
use std::sync::Arc;

use glam::{DAffine3, DVec3};
use pliant_deform::Method;
use pliant_mesh::Model;
use serde::{Deserialize, Serialize};
use serde_json::Value;

use super::field::Field;
use crate::EditError;
use crate::document::{HandleId, KeptShape, bits_equal};
use crate::format::method::method_to_value;

/// A kept shape: which shape was seen, and where handles, control points and examples' weights stood then.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct StoredKept {
    /// The method, with its options, whose descent ended at the shape; no other method takes the shape. Without it the
    /// shape is carried along by every method.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    method: Option<Value>,
    /// Each handle's map of rest positions, by its number: three columns and the translation.
    handles: BTreeMap<u32, [f64; 12]>,
    /// Where control points were moved to.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    controls: Option<Vec<[f64; 3]>>,
    /// The examples' weights, `null` where one was found.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    weights: Vec<Option<f64>>,
    /// Displacements from the rest shape; `None` is the rest shape.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    shape: Option<Field>,
}

impl StoredKept {
    pub(crate) fn of(kept: &KeptShape, model: &Model) -> Self {
        let shape = Field::of(model, |vertex| {
            let value = kept.shape[vertex.index()];
            (!bits_equal(value, DVec3::ZERO)).then_some(value.to_array())
        });
        let handles = kept.targets.iter();
        Self {
            method: None,
            handles: handles
                .map(|(id, map)| (u32::from(id.0), map.to_cols_array()))
                .collect(),
            controls: kept
                .controls
                .as_ref()
                .map(|controls| controls.iter().map(|point| point.to_array()).collect()),
            weights: kept.weights.clone(),
            shape,
        }
    }

    /// The shape on its mesh; `name` is the member's, for messages.
    ///
    /// # Errors
    /// As [`Field::displacements`].
    pub(crate) fn on(&self, model: &Model, name: &str) -> Result<KeptShape, EditError> {
        let shape = match &self.shape {
            Some(shape) => shape.displacements(&format!("{name}: shape"), model)?,
            None => Arc::new(vec![DVec3::ZERO; model.surface.positions.len()]),
        };
        let handles = self.handles.iter();
        Ok(KeptShape {
            targets: handles
                .map(|(id, map)| {
                    (
                        HandleId(u16::try_from(*id).unwrap_or(u16::MAX)),
                        DAffine3::from_cols_array(map),
                    )
                })
                .collect(),
            controls: self.controls.as_ref().map(|controls| {
                let points = controls.iter().map(|point| DVec3::from_array(*point));
                Arc::new(points.collect())
            }),
            weights: self.weights.clone(),
            shape,
        })
    }

    /// The same as the end of a descent by `method`.
    pub(crate) fn by(self, method: &Method) -> Self {
        Self {
            method: Some(method_to_value(method, &BTreeMap::new())),
            ..self
        }
    }

    /// Whether `method` takes the shape.
    pub(crate) fn is_for(&self, method: &Method) -> bool {
        let own = || method_to_value(method, &BTreeMap::new());
        self.method.as_ref().is_none_or(|by| *by == own())
    }

    /// The same with other numbers for the handles; those without one are left out.
    pub(crate) fn renumbered(mut self, number: impl Fn(HandleId) -> Option<u32>) -> Self {
        let handles = self.handles.into_iter();
        let handles = handles.filter_map(|(id, map)| Some((number(HandleId(u16::try_from(id).ok()?))?, map)));
        self.handles = handles.collect();
        self
    }
}
