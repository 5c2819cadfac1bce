//! A handle's sketched line in both formats: `view_projection`, `line` and `weight`.

use glam::{DMat4, DVec2};
use serde::de::{Deserializer, Error};
use serde::ser::Serializer;
use serde::{Deserialize, Serialize};

use super::transform::Numbers;
use crate::document::HandleSketch;

/// The members in the file.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct StoredSketch {
    view_projection: Numbers<16>,
    line: Vec<Numbers<2>>,
    #[serde(default = "exact")]
    weight: f64,
}

fn exact() -> f64 {
    1.0
}

impl Serialize for HandleSketch {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let stored = StoredSketch {
            view_projection: Numbers(self.clip_from_world().to_cols_array()),
            line: self.line().iter().map(|point| Numbers(point.to_array())).collect(),
            weight: self.weight(),
        };
        stored.serialize(serializer)
    }
}

impl<'de> Deserialize<'de> for HandleSketch {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let stored = StoredSketch::deserialize(deserializer)?;
        let clip_from_world = DMat4::from_cols_array(&stored.view_projection.0);
        let line = stored
            .line
            .into_iter()
            .map(|point| DVec2::from_array(point.0))
            .collect();
        Self::new(clip_from_world, line, stored.weight).map_err(D::Error::custom)
    }
}
