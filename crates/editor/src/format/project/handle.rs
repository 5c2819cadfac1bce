//! A handle in a project.

use glam::DVec3;
use pliant_deform::CONTINUITY_RANGE;
use pliant_mesh::MirrorPlane;
use serde::{Deserialize, Serialize};

use crate::document::{
    FREE_BEND_DEG, Handle, HandleCurve, HandleId, HandleLine, HandleSketch, PivotPlace, Twin, followed,
    is_bend_range_deg, means,
};
use crate::format::stored_field::Ranges;
use crate::warning::shortened;
use crate::{EditError, HandleTransform, Reach, SOFT_RANGE};

#[derive(Clone, PartialEq, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct StoredHandle {
    pub(super) id: u16,
    pub(super) name: String,
    colour: [u8; 4],
    pub(super) vertices: Ranges,
    #[serde(default, skip_serializing_if = "is_default")]
    transform: HandleTransform,
    /// The counted turn, in degrees about x, y and z.
    #[serde(default, skip_serializing_if = "is_no_turn")]
    turn_deg: [f64; 3],
    pivot: [f64; 3],
    #[serde(default)]
    pivot_place: StoredPivotPlace,
    reach: StoredReach,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    soft: Option<f64>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    continuity: Option<f64>,
    #[serde(default = "yes", skip_serializing_if = "is_yes")]
    visible: bool,
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    locked: bool,
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pin: bool,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    twin: Option<StoredTwin>,
    /// The number of the handle with which it rides along.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(super) parent: Option<u16>,
    /// The least and the most bend at its joint in degrees, if it is limited.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    bend: Option<[f64; 2]>,
    /// The curve that its vertices follow.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    curve: Option<HandleCurve>,
    /// The unit direction along which they are free.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    free_along: Option<[f64; 3]>,
    /// Or the line to which their outline is drawn.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    sketch: Option<HandleSketch>,
}

#[derive(Clone, Copy, PartialEq, Debug, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
enum StoredPivotPlace {
    #[default]
    Centroid,
    Border,
    Picked,
}

#[derive(Clone, Copy, PartialEq, Debug, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
enum StoredReach {
    Found,
    Bounded(f64),
    Feature,
    Creased(f64),
    Part,
    Radii(f64),
    Length(f64),
}

#[derive(Clone, Copy, PartialEq, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct StoredTwin {
    handle: u16,
    /// The world axis that is normal to the plane.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    axis: Option<usize>,
    /// Otherwise its normal.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    normal: Option<[f64; 3]>,
    /// Its distance from the origin along either.
    at: f64,
}

impl StoredTwin {
    /// The stored plane, if it is valid.
    fn plane(&self) -> Option<MirrorPlane> {
        let normal = match (self.axis, self.normal) {
            (Some(axis), None) => *DVec3::AXES.get(axis)?,
            (None, Some(normal)) => DVec3::from_array(normal),
            _ => return None,
        };
        MirrorPlane::new(normal, self.at)
    }
}

impl StoredHandle {
    pub(super) fn of(handle: &Handle, vertices: Ranges) -> Self {
        Self {
            id: handle.id.0,
            name: handle.name.clone(),
            colour: handle.colour,
            vertices,
            transform: handle.transform,
            turn_deg: handle.turn_deg.to_array(),
            pivot: handle.pivot.to_array(),
            pivot_place: match handle.pivot_place {
                PivotPlace::Centroid => StoredPivotPlace::Centroid,
                PivotPlace::Border => StoredPivotPlace::Border,
                PivotPlace::Picked => StoredPivotPlace::Picked,
            },
            reach: match handle.reach {
                Reach::Found => StoredReach::Found,
                Reach::Bounded(length) => StoredReach::Bounded(length),
                Reach::Feature => StoredReach::Feature,
                Reach::Creased(length) => StoredReach::Creased(length),
                Reach::Part => StoredReach::Part,
                Reach::Radii(radii) => StoredReach::Radii(radii),
                Reach::Length(length) => StoredReach::Length(length),
            },
            soft: handle.soft,
            continuity: handle.continuity,
            visible: handle.visible,
            locked: handle.locked,
            pin: handle.is_pin,
            twin: handle.twin.map(|twin| StoredTwin {
                handle: twin.handle.0,
                axis: twin.plane.axis(),
                normal: twin.plane.axis().is_none().then(|| twin.plane.normal().to_array()),
                at: twin.plane.distance(),
            }),
            parent: handle.parent.map(|parent| parent.0),
            bend: Some(handle.bend_deg).filter(|range| *range != FREE_BEND_DEG),
            free_along: handle.free_along.map(|direction| direction.to_array()),
            curve: handle.line.as_ref().and_then(HandleLine::curve).cloned(),
            sketch: handle.line.as_ref().and_then(HandleLine::sketch).cloned(),
        }
    }

    fn line(&self) -> Option<HandleLine> {
        HandleLine::of(self.curve.as_ref(), self.sketch.as_ref())
    }

    /// Returns true if it is at its rest position.
    pub(super) fn is_at_rest(&self) -> bool {
        is_default(&self.transform) && self.line().is_none_or(|line| line.is_rest())
    }

    pub(super) fn handle(&self) -> Result<Handle, EditError> {
        let is_reach_refused = match self.reach {
            StoredReach::Found | StoredReach::Feature | StoredReach::Part => false,
            StoredReach::Bounded(size)
            | StoredReach::Creased(size)
            | StoredReach::Radii(size)
            | StoredReach::Length(size) => !(size.is_finite() && size >= 0.0),
        };
        let refused_weight = self.soft.is_some_and(|weight| !SOFT_RANGE.contains(&weight))
            || self.continuity.is_some_and(|value| !CONTINUITY_RANGE.contains(&value));
        let free_along = self
            .free_along
            .map(|numbers| DVec3::from_array(numbers).try_normalize());
        if free_along == Some(None)
            || is_reach_refused
            || refused_weight
            || self.bend.is_some_and(|range| !is_bend_range_deg(range))
            || self.curve.as_ref().is_some_and(|curve| curve.snap().is_some())
            || self.twin.is_some_and(|twin| twin.plane().is_none())
        {
            return Err(EditError::Project(format!(
                "the handle `{}` has an invalid reach, weight, continuity, bend, free direction, curve or twin: save it again",
                shortened(&self.name)
            )));
        }
        let id = HandleId(self.id);
        let transform = self.transform;
        let counted = DVec3::from_array(self.turn_deg);
        Ok(Handle {
            colour: self.colour,
            // The counted turn must be the rotation, even in a file from another program.
            turn_deg: match transform {
                HandleTransform::Trs { rotation, .. } if !means(counted, rotation) => followed(DVec3::ZERO, rotation),
                _ => counted,
            },
            transform,
            pivot: DVec3::from_array(self.pivot),
            pivot_place: match self.pivot_place {
                StoredPivotPlace::Centroid => PivotPlace::Centroid,
                StoredPivotPlace::Border => PivotPlace::Border,
                StoredPivotPlace::Picked => PivotPlace::Picked,
            },
            reach: match self.reach {
                StoredReach::Found => Reach::Found,
                StoredReach::Bounded(length) => Reach::Bounded(length),
                StoredReach::Feature => Reach::Feature,
                StoredReach::Creased(length) => Reach::Creased(length),
                StoredReach::Part => Reach::Part,
                StoredReach::Radii(radii) => Reach::Radii(radii),
                StoredReach::Length(length) => Reach::Length(length),
            },
            soft: self.soft,
            continuity: self.continuity,
            visible: self.visible,
            locked: self.locked,
            is_pin: self.pin,
            twin: self.twin.and_then(|twin| {
                Some(Twin {
                    handle: HandleId(twin.handle),
                    plane: twin.plane()?,
                })
            }),
            parent: self.parent.map(HandleId),
            bend_deg: self.bend.unwrap_or(FREE_BEND_DEG),
            line: self.line(),
            free_along: self.free_along.map(DVec3::from_array),
            ..Handle::new(id, self.name.clone())
        })
    }
}

fn yes() -> bool {
    true
}

fn is_yes(flag: &bool) -> bool {
    *flag
}

fn is_no_turn(turn_deg: &[f64; 3]) -> bool {
    *turn_deg == [0.0; 3]
}

fn is_default(transform: &HandleTransform) -> bool {
    *transform == HandleTransform::default()
}
