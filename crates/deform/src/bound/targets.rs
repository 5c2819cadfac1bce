//! The handles' targets: maps, or places for all their vertices.

use std::sync::Arc;

use glam::{DAffine3, DVec3};

use super::{Bound, Target};
use crate::SolveError;
use crate::handles::offsets::Offsets;
use crate::handles::{Handle, Motion};

impl Bound {
    /// Sets the handles' targets: for each handle, one affine map of world positions, from rest.
    ///
    /// # Errors
    /// A wrong count, or a transform that is not finite; the previous targets stay.
    pub fn set_targets(&mut self, world_targets: &[DAffine3]) -> Result<(), SolveError> {
        if world_targets.len() != self.handles.len() {
            return Err(SolveError::TargetCount {
                found: world_targets.len(),
                expected: self.handles.len(),
            });
        }
        if let Some(handle) = world_targets.iter().position(|target| !target.is_finite()) {
            return Err(SolveError::TargetNotFinite { handle });
        }
        let motions: Vec<Motion> = self
            .handles
            .iter()
            .zip(world_targets)
            .map(|(handle, target)| handle.motion(target))
            .collect();
        self.aim(motions, Offsets::default(), &[]);
        Ok(())
    }

    /// Like [`Bound::set_targets`], but a handle's target may be places for all its vertices instead of a map: every
    /// vertex of a hard handle then goes exactly to its place, and every vertex of a soft handle is pulled there.
    ///
    /// # Errors
    /// Those of [`Bound::set_targets`], and [`SolveError::NoPlaces`] for a method that takes no places; the previous
    /// targets stay.
    pub fn set_places(&mut self, targets: &[Target]) -> Result<(), SolveError> {
        let expected = self.handles.len();
        if targets.len() != expected {
            let found = targets.len();
            return Err(SolveError::TargetCount { found, expected });
        }
        let mut offsets = Offsets::default();
        let mut placed = vec![false; expected];
        let mut motions = Vec::with_capacity(expected);
        for (number, target) in targets.iter().enumerate() {
            let handle = &self.handles[number];
            motions.push(match target {
                Target::Map(map) if !map.is_finite() => return Err(SolveError::TargetNotFinite { handle: number }),
                Target::Map(map) => handle.motion(map),
                Target::Places(places) => {
                    let world_rest = self.world_rest.get(number);
                    let world_rest = world_rest.ok_or(SolveError::NoPlaces { method: self.name })?;
                    let displacements = displacements_to(places, number, handle, world_rest)?;
                    placed[number] = true;
                    offsets.take(handle, world_rest, &displacements)
                }
            });
        }
        self.aim(motions, offsets.sorted(), &placed);
        Ok(())
    }

    /// The surface vertices of a handle, ascending; empty for a number that no handle has.
    pub fn handle_vertices(&self, handle: usize) -> &[u32] {
        self.handles.get(handle).map_or(&[], |handle| &handle.vertices)
    }

    /// Sets motions and offsets, and updates the warnings for these targets. `placed` tells for each handle whether its
    /// vertices have places.
    fn aim(&mut self, motions: Vec<Motion>, offsets: Offsets, placed: &[bool]) {
        if offsets != *self.offsets {
            self.put_offsets(Arc::new(offsets));
        }
        self.put_motions(motions);
        let of_binding = self.of_binding.iter();
        self.warnings.clear();
        self.warnings
            .extend(of_binding.filter(|warning| !warning.is_void(placed)).cloned());
        self.binding_warnings = self.warnings.len();
        self.warnings.extend(self.method.blind_to(&self.motions));
        let limit = self.turn_limit.as_ref();
        self.warnings
            .extend(limit.and_then(|limit| limit.warning(&self.handles, &self.motions)));
        self.target_warnings = self.warnings.len();
    }
}

/// The displacements that take a handle's vertices to these places.
///
/// # Errors
/// A wrong count, or a place that is not finite.
fn displacements_to(
    places: &[DVec3],
    number: usize,
    handle: &Handle,
    world_rest: &[DVec3],
) -> Result<Vec<DVec3>, SolveError> {
    if places.len() != world_rest.len() {
        return Err(SolveError::PlaceCount {
            handle: number,
            found: places.len(),
            expected: world_rest.len(),
        });
    }
    if let Some(at) = places.iter().position(|place| !place.is_finite()) {
        return Err(SolveError::PlaceNotFinite {
            handle: number,
            vertex: handle.vertices[at],
        });
    }
    Ok(places
        .iter()
        .zip(world_rest)
        .map(|(place, rest)| *place - *rest)
        .collect())
}
