//! The handles' targets: maps, or places for all their vertices.

use std::sync::Arc;

use glam::{DAffine3, DMat3, DVec3};

use super::Bound;
use super::sections::{Sections, largest_gap_rad, mean_motion};
use super::target::{Target, TurnedMap};
use crate::handles::Motion;
use crate::handles::offsets::Offsets;
use crate::{Remedy, SolveError, Warning};

impl Bound {
    /// Sets the handles' targets: for each handle, one affine map of world positions, from rest.
    ///
    /// # Errors
    /// A wrong count, or a transform that is not finite; the previous targets stay.
    pub fn set_targets(&mut self, world_targets: &[DAffine3]) -> Result<(), SolveError> {
        let found = world_targets.len();
        self.check_count(found)?;
        if let Some(handle) = world_targets.iter().position(|target| !target.is_finite()) {
            return Err(SolveError::TargetNotFinite { handle });
        }
        let map_of = |section: usize| match &self.sections {
            Some(sections) => &world_targets[sections.handle_of[section]],
            None => &world_targets[section],
        };
        let handles = self.handles.iter().enumerate();
        let motions: Vec<Motion> = handles.map(|(number, handle)| handle.motion(map_of(number))).collect();
        self.own_ways.clear();
        self.aim(motions, Offsets::default(), &[]);
        Ok(())
    }

    /// Like [`Bound::set_targets`], but a handle's target may be places or maps for all its vertices instead of one map:
    /// every vertex of a hard handle then goes exactly to its place, and every vertex of a soft handle is pulled there.
    ///
    /// # Errors
    /// Those of [`Bound::set_targets`], and [`SolveError::NoPlaces`] for a method that takes no places; the previous
    /// targets stay. Every method takes maps of a handle with [`crate::Constraints::sections`].
    pub fn set_places(&mut self, targets: &[Target]) -> Result<(), SolveError> {
        self.check_count(targets.len())?;
        for (number, target) in targets.iter().enumerate() {
            self.check_target(number, target)?;
        }
        let of_sections = self.sections.as_ref().map(|sections| sections.targets(targets));
        let mut aims = Aims::default();
        for (number, target) in of_sections.as_deref().unwrap_or(targets).iter().enumerate() {
            let handle = &self.handles[number];
            let motion = match target {
                Target::Map(map) => handle.motion(map),
                Target::Places(places) => {
                    let rest = &self.world_rest[number];
                    let displacements: Vec<DVec3> =
                        places.iter().zip(rest).map(|(place, rest)| *place - *rest).collect();
                    aims.offsets.take(handle, rest, &displacements)
                }
                Target::Maps(maps) => {
                    let ways = ways(maps, &self.world_rest[number]);
                    let motion = mean_motion(handle, maps);
                    if self.takes_places {
                        aims.offsets.add(handle, &self.world_rest[number], &ways, &motion);
                    } else if self.is_exact && self.soft[number].is_none() {
                        aims.own_ways.extend(handle.vertices.iter().copied().zip(ways));
                    }
                    motion
                }
            };
            aims.placed.push(!matches!(target, Target::Map(_)));
            aims.motions.push(motion);
        }
        let is_rest = aims.own_ways.iter().all(|(_, way)| *way == DVec3::ZERO);
        self.own_ways = if is_rest { Vec::new() } else { aims.own_ways };
        self.aim(aims.motions, aims.offsets.sorted(), &aims.placed);
        self.warn_of_gaps(targets);
        Ok(())
    }

    /// The surface vertices of a handle, ascending; empty for a number that no handle has.
    pub fn handle_vertices(&self, handle: usize) -> &[u32] {
        match &self.sections {
            Some(sections) => sections.vertices(handle),
            None => self.handles.get(handle).map_or(&[], |handle| &handle.vertices),
        }
    }

    fn check_count(&self, found: usize) -> Result<(), SolveError> {
        let handles = self.sections.as_ref().map(Sections::handle_count);
        let expected = handles.unwrap_or(self.handles.len());
        if found == expected {
            Ok(())
        } else {
            Err(SolveError::TargetCount { found, expected })
        }
    }

    /// Refuses a target that is not finite, has a wrong number of entries, or is of a kind that the method does not take.
    fn check_target(&self, handle: usize, target: &Target) -> Result<(), SolveError> {
        let vertices = self.handle_vertices(handle);
        let (found, is_taken, wrong) = match target {
            Target::Map(map) if map.is_finite() => return Ok(()),
            Target::Map(_) => return Err(SolveError::TargetNotFinite { handle }),
            Target::Places(places) => {
                let wrong = places.iter().position(|place| !place.is_finite());
                (places.len(), self.takes_places, wrong)
            }
            Target::Maps(maps) => {
                let wrong = maps.iter().position(|map| !map.is_finite());
                (maps.len(), self.takes_places || self.sections.is_some(), wrong)
            }
        };
        let expected = vertices.len();
        if !is_taken {
            return Err(SolveError::NoPlaces { method: self.name });
        }
        if found != expected {
            return Err(SolveError::PlaceCount {
                handle,
                found,
                expected,
            });
        }
        match wrong {
            Some(at) => Err(SolveError::PlaceNotFinite {
                handle,
                vertex: vertices[at],
            }),
            None => Ok(()),
        }
    }

    /// Sets motions and offsets, and updates the warnings for these targets. `placed` tells for each bound handle whether
    /// its vertices have places.
    fn aim(&mut self, motions: Vec<Motion>, offsets: Offsets, placed: &[bool]) {
        if offsets != *self.offsets {
            self.put_offsets(Arc::new(offsets));
        }
        let motions = self.slid(motions, placed);
        self.put_motions(motions);
        let of_binding = self.of_binding.iter();
        self.warnings.clear();
        self.warnings
            .extend(of_binding.filter(|warning| !warning.is_void(placed)).cloned());
        self.binding_warnings = self.warnings.len();
        let blind = self.method.blind_to(&self.motions);
        let limit = self.turn_limit.as_ref();
        let limit = limit.and_then(|limit| limit.warning(&self.handles, &self.motions));
        let of_targets = self.about_handles(blind.into_iter().chain(limit).collect());
        self.warnings.extend(of_targets);
        self.target_warnings = self.warnings.len();
    }

    /// Adds a sentence about each handle that turns far where it has no vertices, beyond what the method
    /// follows.
    fn warn_of_gaps(&mut self, targets: &[Target]) {
        if self.largest_gap_rad.is_infinite() {
            return;
        }
        for (number, target) in targets.iter().enumerate() {
            let Target::Maps(maps) = target else { continue };
            let gap_rad = largest_gap_rad(maps);
            if gap_rad > self.largest_gap_rad {
                let degrees = gap_rad.to_degrees().round();
                let others = Remedy::FollowingTurns(degrees as u16);
                self.warnings.push(Warning::of_handle(number, |handle| {
                    format!(
                        "{handle} turns by {degrees:.0}° where it has no vertices, which `{}` does not follow: select \
                         vertices all along the curve, or take {others}",
                        self.name
                    )
                }));
            }
        }
        self.target_warnings = self.warnings.len();
    }

    /// The warnings with the numbers of handles instead of those of sections.
    pub(super) fn about_handles(&self, warnings: Vec<Warning>) -> Vec<Warning> {
        match &self.sections {
            None => warnings,
            Some(sections) => {
                let number = |section: usize| sections.handle_of[section];
                warnings.into_iter().map(|warning| warning.renumbered(number)).collect()
            }
        }
    }
}

/// The motions of all handles, with the places of single vertices.
#[derive(Default)]
struct Aims {
    motions: Vec<Motion>,
    offsets: Offsets,
    own_ways: Vec<(u32, DVec3)>,
    placed: Vec<bool>,
}

/// The displacement of each point by its map.
fn ways(maps: &[TurnedMap], world_rest: &[DVec3]) -> Vec<DVec3> {
    let way =
        |(TurnedMap { map, .. }, rest): (&TurnedMap, &DVec3)| (map.matrix3 - DMat3::IDENTITY) * *rest + map.translation;
    maps.iter().zip(world_rest).map(way).collect()
}
