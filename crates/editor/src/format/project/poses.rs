//! Poses in a project.

use std::collections::BTreeMap;
use std::sync::Arc;

use glam::DVec3;
use pliant_deform::METHODS;
use serde::{Deserialize, Serialize};

use super::place::{StoredPlace, places, stored_places};
use crate::document::Pose;

#[derive(Clone, PartialEq, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct StoredPose {
    name: String,
    /// The stances, by the handles' numbers.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    handles: BTreeMap<u32, StoredPlace>,
    /// The moved positions of control points, by the attachments' names.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    controls: BTreeMap<String, Vec<[f64; 3]>>,
    /// The weights of examples, `null` for one that was found.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    weights: BTreeMap<String, Vec<Option<f64>>>,
}

impl StoredPose {
    pub(super) fn of(pose: &Pose) -> Self {
        let points = |points: &Arc<Vec<DVec3>>| points.iter().map(|point| point.to_array()).collect();
        Self {
            name: pose.name.clone(),
            handles: stored_places(&pose.handles),
            controls: pose
                .controls
                .iter()
                .map(|(name, own)| ((*name).to_owned(), points(own)))
                .collect(),
            weights: pose
                .weights
                .iter()
                .map(|(name, own)| ((*name).to_owned(), own.clone()))
                .collect(),
        }
    }

    pub(super) fn pose(&self) -> Pose {
        let points = |points: &Vec<[f64; 3]>| Arc::new(points.iter().map(|point| DVec3::from_array(*point)).collect());
        Pose {
            name: self.name.clone(),
            handles: places(&self.handles),
            // An attachment that no method declares has no place.
            controls: known(&self.controls).map(|(name, own)| (name, points(own))).collect(),
            weights: known(&self.weights).map(|(name, own)| (name, own.clone())).collect(),
        }
    }
}

/// The values stored under the names of attachments.
fn known<T>(stored: &BTreeMap<String, T>) -> impl Iterator<Item = (&'static str, &T)> {
    let declared = METHODS.iter().flat_map(|declaration| declaration.attachments);
    declared.filter_map(|declared| Some((declared.name, stored.get(declared.name)?)))
}
