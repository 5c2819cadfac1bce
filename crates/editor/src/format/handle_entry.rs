//! A handle in an edit file.

use glam::DVec3;
use pliant_deform::CONTINUITY_RANGE;
use serde::{Deserialize, Serialize};

use super::edit_error::EditError;
use super::field::FieldKind;
use super::pose::PoseEntry;
use super::selector::Selector;
use super::transform::optional_vector;
use crate::HandleTransform;
use crate::document::{HandleCurve, HandleLine, HandleSketch, is_bend_range_deg};

/// The smallest and the largest weight of a soft handle.
pub const SOFT_RANGE: std::ops::RangeInclusive<f64> = 1e-6..=1e6;

/// A handle: its vertices and their motion.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct HandleEntry {
    /// Its name, for a person. Without names they are "handle 1", "handle 2", ..
    #[serde(default)]
    pub name: String,
    /// Its vertices, unless it has a `pose`. A handle with a line may do without: a curve then has the vertices of the
    /// triangles under it. A sketch has those of the selected vertices, or of all, that are on the outline.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub select: Option<Selector>,
    /// The limb that it is, by the pose tool's own guess, in place of `select`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub pose: Option<PoseEntry>,
    /// Their motion.
    #[serde(default)]
    pub transform: HandleTransform,
    /// The direction in world space, of any length, along which they are free: `transform` holds them across it only, and
    /// they slide along it to where the energy is least.
    #[serde(default, skip_serializing_if = "Option::is_none", with = "optional_vector")]
    pub free_along: Option<DVec3>,
    /// The curve that they follow before `transform` moves them.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub curve: Option<HandleCurve>,
    /// Or the line to which their outline is drawn.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub sketch: Option<HandleSketch>,
    /// Its weight, in [`SOFT_RANGE`], if it only pulls at its vertices.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub soft: Option<f64>,
    /// The continuity of its own border, instead of [`EditFile::continuity`](super::EditFile::continuity).
    #[serde(skip_serializing_if = "Option::is_none")]
    pub continuity: Option<f64>,
    /// The place in the list, from 0, of the handle with which it rides along when a person moves that one in the
    /// window. Transforms are absolute, so it changes no shape.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub parent: Option<u32>,
    /// The least and the most bend at its joint in degrees, from 0 (straight) to 180, while it is pulled with its parent
    /// as a whole limb in the window; it changes no shape.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub bend: Option<[f64; 2]>,
}

impl HandleEntry {
    /// Returns true if it moves nothing.
    pub(super) fn is_at_rest(&self) -> bool {
        self.transform.is_identity() && self.line().is_none_or(|line| line.is_rest())
    }

    /// The line that it follows.
    pub(crate) fn line(&self) -> Option<HandleLine> {
        HandleLine::of(self.curve.as_ref(), self.sketch.as_ref())
    }

    /// Its weight, if it is soft: its own, or that of its sketch.
    pub(crate) fn softness(&self) -> Option<f64> {
        self.soft.or_else(|| self.sketch.as_ref()?.soft())
    }

    pub(super) fn check(&self) -> Result<(), EditError> {
        if self.curve.is_some() && self.sketch.is_some() {
            let sentence = "has both `curve` and `sketch`: keep one of them".to_owned();
            let place = String::new();
            return Err(EditError::Other { place, sentence });
        }
        let weight = FieldKind {
            name: "a weight",
            range: SOFT_RANGE,
            may_be_rigid: false,
        };
        let refuse = |sentence: &str| {
            let (place, sentence) = (String::new(), sentence.to_owned());
            Err(EditError::Other { place, sentence })
        };
        match (&self.select, &self.pose, self.line()) {
            (Some(_), Some(_), _) => {
                return refuse("has both `select` and `pose`: keep one, its vertices or a point on its limb");
            }
            (_, Some(_), Some(_)) => {
                return refuse("has a `pose` and a line: keep one, a point on its limb or the line that it follows");
            }
            _ if self.free_along.is_some() && self.line().is_some() => {
                return refuse("has a line and `free_along`: keep one, the line that it follows or its free direction");
            }
            (Some(select), ..) => select.check().map_err(|error| error.under("select"))?,
            (None, None, None) => {
                return Err(EditError::Missing {
                    member: "select",
                    place: String::new(),
                });
            }
            (None, ..) => {}
        }
        if let Some(direction) = self.free_along
            && direction.try_normalize().is_none()
        {
            return Err(EditError::OutOfRange {
                place: "free_along".to_owned(),
                found: format!("{}, {}, {}", direction.x, direction.y, direction.z),
                allowed: "a direction: three numbers, not all 0".to_owned(),
            });
        }
        if let Some(value) = self.soft {
            weight.check(value).map_err(|error| error.under("soft"))?;
        }
        if let Some(value) = self.continuity {
            continuity_kind()
                .check(value)
                .map_err(|error| error.under("continuity"))?;
        }
        if let Some(range) = self.bend.filter(|range| !is_bend_range_deg(*range)) {
            return Err(EditError::OutOfRange {
                place: "bend".to_owned(),
                found: format!("{}, {}", range[0], range[1]),
                allowed: "the least and the most angle, from 0 to 180 degrees".to_owned(),
            });
        }
        Ok(())
    }
}

/// Refuses a parent that is not in the list, and one that is among the handle's own descendants.
pub(super) fn check_parents(handles: &[HandleEntry]) -> Result<(), EditError> {
    let parent_of = |place: u32| handles.get(place as usize)?.parent;
    for (place, handle) in (0..).zip(handles) {
        let Some(parent) = handle.parent else { continue };
        let ancestors = std::iter::successors(Some(parent), |place| parent_of(*place)).take(handles.len());
        let allowed = if parent as usize >= handles.len() {
            Some("the place of a handle in the list, counted from 0")
        } else if ancestors.into_iter().any(|ancestor| ancestor == place) {
            Some("a handle that does not ride along with this one itself")
        } else {
            None
        };
        if let Some(allowed) = allowed {
            return Err(EditError::OutOfRange {
                place: format!("handles[{place}].parent"),
                found: parent.to_string(),
                allowed: allowed.to_owned(),
            });
        }
    }
    Ok(())
}

/// A continuity.
pub(super) fn continuity_kind() -> FieldKind {
    FieldKind {
        name: "a continuity",
        range: CONTINUITY_RANGE,
        may_be_rigid: false,
    }
}
