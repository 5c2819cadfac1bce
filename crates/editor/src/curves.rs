//! The curves that handles follow, on a surface: the place of each vertex, and the vertices' maps at a share of the way.

use std::sync::Arc;

use glam::{DAffine3, DVec3};
use pliant_deform::{Role, Target};

use crate::document::HandleCurve;

/// The sections of a handle along its curve ([`pliant_deform::Constraints::sections`]): at a bend by 300 degrees each of
/// them turns by less than 10 degrees against the next.
const SECTIONS: f64 = 32.0;

/// In one step a curve turns by at most this angle, in radians, so that methods follow full turns.
const STEP_RAD: f64 = std::f64::consts::FRAC_PI_4;

/// The curves of a setup's handles, with the nearest places of their vertices. Copies share them.
#[derive(Clone, PartialEq, Debug, Default)]
pub struct Curves {
    each: Arc<Vec<LaidCurve>>,
    /// The section of each surface vertex; empty without curves.
    sections: Arc<Vec<u16>>,
}

/// A curve and the vertices that follow it.
#[derive(Clone, PartialEq, Debug)]
struct LaidCurve {
    /// The handle's number.
    handle: usize,
    curve: HandleCurve,
    /// The place on the curve at rest that is nearest to each of the handle's vertices, which ascend.
    places: Vec<f64>,
}

impl Curves {
    /// The curves of handles on surface vertices with these rest positions and roles.
    pub(crate) fn of<'a>(
        curves: impl Iterator<Item = Option<&'a HandleCurve>>,
        roles: &[Role],
        world_rest: &[DVec3],
    ) -> Self {
        let mut own = Self::default();
        for (handle, curve) in curves.enumerate() {
            let Some(curve) = curve else { continue };
            let sections = Arc::make_mut(&mut own.sections);
            sections.resize(roles.len(), 0);
            let rest = curve.rest();
            let mut places = Vec::new();
            for (vertex, _) in roles
                .iter()
                .enumerate()
                .filter(|(_, role)| **role == Role::Handle(handle as u16))
            {
                let place = rest.nearest(world_rest[vertex]);
                sections[vertex] = (SECTIONS * place / rest.length()).min(SECTIONS - 1.0) as u16;
                places.push(place);
            }
            Arc::make_mut(&mut own.each).push(LaidCurve {
                handle,
                curve: curve.clone(),
                places,
            });
        }
        own
    }

    /// Returns true if no handle follows a curve.
    pub fn is_empty(&self) -> bool {
        self.each.is_empty()
    }

    /// The section of each surface vertex; empty without curves.
    pub(crate) fn sections(&self) -> &[u16] {
        &self.sections
    }

    /// The number of steps to a share of the curves' way from rest.
    pub(crate) fn steps(&self, share: f64) -> usize {
        let turns = self.each.iter().map(|laid| laid.curve.largest_turn_rad());
        (share * turns.fold(0.0, f64::max) / STEP_RAD).ceil() as usize
    }

    /// The handles' targets at a share of the curves' way: first the curve moves its vertices, then the handle's map.
    pub fn targets(&self, maps: &[DAffine3], share: f64) -> Vec<Target> {
        let mut targets: Vec<Target> = maps.iter().copied().map(Target::Map).collect();
        for laid in self.each.iter() {
            let motion = laid.curve.motion_at(share);
            let Some(target) = targets.get_mut(laid.handle).filter(|_| !motion.is_rest()) else {
                continue;
            };
            let then = maps[laid.handle];
            let of_place = |place: &f64| match then == DAffine3::IDENTITY {
                true => motion.map_at(*place),
                false => then * motion.map_at(*place),
            };
            *target = Target::Maps(laid.places.iter().map(of_place).collect());
        }
        targets
    }
}
