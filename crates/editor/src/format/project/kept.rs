//! The kept shape (see `document/kept_shape`), as a project stores it.

use std::collections::BTreeMap;
use std::sync::Arc;

use glam::{DAffine3, DVec3};
use serde::{Deserialize, Serialize};

use super::field::Field;
use crate::document::{HandleId, KeptShape};

#[derive(Clone, PartialEq, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct StoredKept {
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
    pub(super) shape: Option<Field>,
}

impl StoredKept {
    pub(super) fn of(kept: &KeptShape, shape: Option<Field>) -> Self {
        let handles = kept.targets.iter();
        Self {
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

    pub(super) fn kept(&self, shape: Arc<Vec<DVec3>>) -> KeptShape {
        let handles = self.handles.iter();
        KeptShape {
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
        }
    }
}
