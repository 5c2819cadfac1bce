//! Handles that are the limbs of the pose tool's own guess, for edits without a window.
//!
//! The handle, its joint and its region are those that a drag of the pose tool at the point would make. A limb whose
//! joint is on another limb takes its part of that one, whichever comes first in the list, and the surface around its
//! joint is free to bend.

use std::collections::BTreeMap;
use std::sync::Arc;

use glam::DVec3;
use pliant_deform::{Loose, Role};
use pliant_mesh::{Cancel, DistanceSearch, Joint, Model, Shape, SurfaceVertex};
use serde::{Deserialize, Serialize};

use super::edit_error::EditError;
use super::transform::vector;
use crate::document::{HandleId, Paint, Reach, Tips};
use crate::region::{FileContacts, Region, RegionInput, limb_joint};

/// A limb by a point on it.
#[derive(Clone, Copy, PartialEq, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PoseEntry {
    /// A point on the limb, in world space; the nearest point of the surface counts.
    #[serde(with = "vector")]
    pub at: DVec3,
    /// The number of candidates by which its joint is farther from the limb's tip than the guess; negative for one that is
    /// nearer, such as a finger's where the guess is the hand.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub up: i32,
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde passes by reference")]
fn is_zero(number: &i32) -> bool {
    *number == 0
}

/// A limb on a model.
pub(super) struct Limb {
    pub(super) joint: Joint,
    /// The vertices of its handle, ascending.
    pub(super) own: Vec<SurfaceVertex>,
}

/// The limbs of an edit's handles.
pub(super) struct Limbs {
    /// By the places of their handles, which ascend.
    limbs: Vec<(usize, Limb)>,
}

impl Limbs {
    /// Finds the limbs of handles, by their places in the list, which ascend.
    ///
    /// # Errors
    /// A point without a joint, a candidate that does not exist, and limbs that are the same, by their places.
    pub(super) fn of<'a>(
        poses: impl Iterator<Item = (usize, &'a PoseEntry)>,
        model: &Model,
    ) -> Result<Self, EditError> {
        let shape = Shape {
            triangles: &model.surface.triangles,
            topology: &model.topology,
            positions: &model.surface.positions,
        };
        let contacts = FileContacts::default();
        let mut limbs = Vec::new();
        for (index, pose) in poses {
            let joint = joint(model, &shape, &contacts, pose)
                .map_err(|error| error.under(&format!("handles[{index}].pose")))?;
            let own = joint.far_side.clone();
            limbs.push((index, Limb { joint, own }));
        }
        let mut limbs = Self { limbs };
        limbs.divide(&shape)?;
        Ok(limbs)
    }

    pub(super) fn is_empty(&self) -> bool {
        self.limbs.is_empty()
    }

    /// The limb of the handle at a place in the list, if it is one.
    pub(super) fn at(&self, index: usize) -> Option<&Limb> {
        let place = self.limbs.binary_search_by_key(&index, |(index, _)| *index).ok()?;
        Some(&self.limbs[place].1)
    }

    /// Gives each limb the part of larger ones that is beyond its own joint, and frees the surroundings of that joint.
    fn divide(&mut self, shape: &Shape<'_>) -> Result<(), EditError> {
        let mut order: Vec<usize> = (0..self.limbs.len()).collect();
        order.sort_by_key(|&place| std::cmp::Reverse(self.limbs[place].1.joint.limb.len()));
        let mut owner: Vec<Option<usize>> = vec![None; shape.positions.len()];
        let mut search = DistanceSearch::default();
        let position = |v: SurfaceVertex| shape.positions[v.index()];
        for &place in &order {
            let (_, limb) = &self.limbs[place];
            let seeds: Vec<(SurfaceVertex, f64)> = limb.own.iter().map(|&vertex| (vertex, 0.0)).collect();
            let reach = limb.joint.width();
            for &(vertex, _) in search.within(shape.triangles, shape.topology, position, &seeds, reach) {
                owner[vertex.index()] = None;
            }
            limb.own.iter().for_each(|vertex| owner[vertex.index()] = Some(place));
        }
        for (place, (index, limb)) in self.limbs.iter_mut().enumerate() {
            limb.own.retain(|vertex| owner[vertex.index()] == Some(place));
            if limb.own.is_empty() {
                let error = other("gives a limb that is all part of another handle's: choose another `up`");
                return Err(error.under(&format!("handles[{index}].pose")));
            }
        }
        Ok(())
    }

    /// Frees the region that the window gives to handles with these vertices.
    pub(super) fn free(&self, members: &[Vec<SurfaceVertex>], model: &Model, roles: &mut [Role]) {
        let mut paint = vec![Paint::Bare; roles.len()];
        let mut handles = Vec::with_capacity(members.len());
        for (index, own) in members.iter().enumerate() {
            let id = HandleId(index as u16);
            own.iter().for_each(|vertex| paint[vertex.index()] = Paint::Handle(id));
            let reach = self.at(index).map(|limb| Reach::Length(limb.joint.width()));
            handles.push((id, reach.unwrap_or_default()));
        }
        let input = RegionInput {
            model,
            paint: Arc::new(paint),
            handles,
            twins: BTreeMap::new(),
            rest: None,
            is_of_file: false,
            tips: Tips::default(),
            loose: Loose::Follow,
            loose_parts: Arc::default(),
            access: Arc::default(),
            contacts: FileContacts::default(),
            has_controls: false,
        };
        if let Ok(region) = Region::measure(&input, &Cancel::new()) {
            roles.copy_from_slice(&region.roles);
        }
        for role in roles {
            if matches!(role, Role::Handle(_)) {
                *role = Role::Fixed;
            }
        }
    }
}

fn other(sentence: &str) -> EditError {
    EditError::Other {
        place: String::new(),
        sentence: sentence.to_owned(),
    }
}

/// The joint of a limb.
fn joint(model: &Model, shape: &Shape<'_>, contacts: &FileContacts, pose: &PoseEntry) -> Result<Joint, EditError> {
    const NO_JOINT: &str = "has no joint: give a point on a limb that is narrower than the body, or use `select`";
    let (triangle, point) = shape.nearest(pose.at).ok_or_else(|| other(NO_JOINT))?;
    let found = limb_joint(model, shape, contacts, (triangle, point), pose.up, &Cancel::new());
    let joint = found.ok().flatten().ok_or_else(|| other(NO_JOINT))?;
    if joint.up == pose.up {
        return Ok(joint);
    }
    let error = EditError::OutOfRange {
        place: "up".to_owned(),
        found: pose.up.to_string(),
        allowed: match joint.up {
            0 => "0, because there is no candidate on that side".to_owned(),
            last => format!("a number from {} to {}", last.min(0), last.max(0)),
        },
    };
    Err(error)
}
