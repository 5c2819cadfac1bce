//! A handle's curve in both formats: `points`, `closed`, `moved`, `twist`, `scale`, `pinned`,
//! `bends`, `crease` and `snap`.

use glam::DVec3;
use serde::de::{Deserializer, Error};
use serde::ser::Serializer;
use serde::{Deserialize, Serialize};

use super::transform::Numbers;
use crate::document::{Crease, HandleCurve, is_bend_range_deg};

/// The members in the file; each list but `points` may be left out.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct StoredCurve {
    points: Vec<Numbers<3>>,
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    closed: bool,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    moved: Option<Vec<Numbers<3>>>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    twist: Option<Vec<f64>>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    scale: Option<Vec<f64>>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pinned: Vec<u32>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    bends: Vec<[f64; 2]>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    crease: Option<StoredCrease>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    snap: Option<f64>,
}

impl StoredCurve {
    /// The first list that is of certain points, while `snap` has yet to find them.
    fn list_of_points(&self) -> Option<&'static str> {
        let lists = [
            ("moved", self.moved.is_some()),
            ("twist", self.twist.is_some()),
            ("scale", self.scale.is_some()),
            ("pinned", !self.pinned.is_empty()),
            ("bends", !self.bends.is_empty()),
        ];
        lists.into_iter().find(|(_, is_given)| *is_given).map(|(list, _)| list)
    }
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct StoredCrease {
    width: f64,
    #[serde(default)]
    sharpen: f64,
}

impl Serialize for HandleCurve {
    /// Lists of default values are left out.
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let numbers = |points: &[DVec3]| points.iter().map(|point| Numbers(point.to_array())).collect();
        let unless =
            |values: &[f64], default: f64| values.iter().any(|value| *value != default).then(|| values.to_vec());
        let points = self.rest().points();
        let stored = StoredCurve {
            points: numbers(points),
            closed: self.rest().is_closed(),
            moved: (self.moved() != points).then(|| numbers(self.moved())),
            twist: unless(self.twist_deg(), 0.0),
            scale: unless(self.scale(), 1.0),
            pinned: self.pinned().to_vec(),
            bends: self.bends_deg().to_vec(),
            crease: self.crease().map(|crease| StoredCrease {
                width: crease.width(),
                sharpen: crease.sharpen(),
            }),
            snap: self.snap(),
        };
        stored.serialize(serializer)
    }
}

impl<'de> Deserialize<'de> for HandleCurve {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let stored = StoredCurve::deserialize(deserializer)?;
        if let Some(distance) = stored
            .snap
            .filter(|distance| !(distance.is_finite() && *distance > 0.0))
        {
            return Err(D::Error::custom(format!(
                "can't be followed: its `snap` is {distance}: give a length above 0"
            )));
        }
        if let Some(list) = stored.snap.and_then(|_| stored.list_of_points()) {
            return Err(D::Error::custom(format!(
                "can't be followed: its `snap` finds other points, for which `{list}` is not meant: leave one of both out, \
                 and move the handle as a whole by its `transform`"
            )));
        }
        let vectors =
            |numbers: Vec<Numbers<3>>| -> Vec<DVec3> { numbers.into_iter().map(|own| own.0.into()).collect() };
        let points = vectors(stored.points);
        let count = points.len();
        if let Some(point) = stored.pinned.iter().find(|point| **point as usize >= count) {
            return Err(D::Error::custom(format!(
                "can't be followed: its `pinned` has the point {point}, but there are {count}, counted from 0"
            )));
        }
        if !stored.bends.is_empty() && stored.bends.len() != count {
            return Err(D::Error::custom(format!(
                "can't be followed: its `bends` has {} entries for {count} points",
                stored.bends.len()
            )));
        }
        if let Some(point) = stored.bends.iter().position(|range| !is_bend_range_deg(*range)) {
            return Err(D::Error::custom(format!(
                "can't be followed: its `bends` at point {point}, counted from 0, is no least and most angle from 0 to 180 \
                 degrees"
            )));
        }
        let crease = stored.crease.map(|own| Crease::new(own.width, own.sharpen)).transpose();
        let crease =
            crease.map_err(|refused| D::Error::custom(format!("can't be followed: its `crease` {refused}")))?;
        let curve = Self::new(
            points.clone(),
            stored.closed,
            stored.moved.map_or(points, vectors),
            stored.twist.unwrap_or_else(|| vec![0.0; count]),
            stored.scale.unwrap_or_else(|| vec![1.0; count]),
        );
        let curve = curve.map(|curve| {
            let curve = curve.pinned_at(stored.pinned).bent_within(stored.bends);
            curve.creased(crease).snapped_within(stored.snap)
        });
        curve.map_err(|(list, refused)| D::Error::custom(format!("can't be followed: its `{list}` {refused}")))
    }
}
