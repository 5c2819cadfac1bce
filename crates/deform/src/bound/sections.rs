//! Sections of a handle: parts with a turn of their own.
//!
//! A handle along a curve turns by another angle at each of its vertices. Methods take turns from handles, so each
//! section is bound as a handle of its own; callers still see one handle. A method that does not take turns binds such a
//! handle as a whole: places are enough for it, and sections would only cost memory.

use glam::{DMat3, DVec3};

use super::target::{Target, TurnedMap};
use crate::handles::{Handle, Motion};
use crate::numerical::rigid_fit::best_rotation;
use crate::{Constraints, Problem, Role};

/// The handles of a problem, and the sections that are bound for them.
#[derive(Clone, Debug)]
pub(super) struct Sections {
    /// The handle of each section.
    pub handle_of: Vec<usize>,
    /// Each handle's surface vertices, ascending, with their sections.
    vertices: Vec<Vec<u32>>,
    section_of: Vec<Vec<usize>>,
}

/// A problem in which each section is a handle.
pub(super) struct Split {
    roles: Vec<Role>,
    soft: Vec<Option<f64>>,
    pub sections: Sections,
}

impl Split {
    /// `None` if no handle has sections, or the method does not take turns.
    pub fn of(problem: &Problem) -> Option<Self> {
        let Constraints { soft, sections, .. } = problem.constraints;
        let fits = sections.len() == problem.roles.len() && (soft.is_empty() || soft.len() == problem.handle_count);
        if !fits || !problem.method.implementation().takes_turns() {
            return None;
        }
        let mut keys: Vec<(u16, u16)> = Vec::new();
        let own = |role: &Role, section: u16| match role {
            Role::Handle(handle) => Some((*handle, section)),
            Role::Fixed | Role::Free => None,
        };
        keys.extend(
            problem
                .roles
                .iter()
                .zip(sections)
                .filter_map(|(role, section)| own(role, *section)),
        );
        keys.sort_unstable();
        keys.dedup();
        if keys.len() > usize::from(u16::MAX) {
            return None;
        }
        let mut roles = problem.roles.to_vec();
        let (mut vertices, mut section_of) = (
            vec![Vec::new(); problem.handle_count],
            vec![Vec::new(); problem.handle_count],
        );
        for (vertex, (role, section)) in roles.iter_mut().zip(sections).enumerate() {
            let Some(key) = own(role, *section) else { continue };
            let number = keys.partition_point(|other| *other < key);
            let handle = usize::from(key.0);
            vertices.get_mut(handle)?.push(vertex as u32);
            section_of.get_mut(handle)?.push(number);
            *role = Role::Handle(number as u16);
        }
        let handle_of: Vec<usize> = keys.iter().map(|(handle, _)| usize::from(*handle)).collect();
        Some(Self {
            soft: handle_of
                .iter()
                .map(|handle| soft.get(*handle).copied().flatten())
                .collect(),
            roles,
            sections: Sections {
                handle_of,
                vertices,
                section_of,
            },
        })
    }

    /// The problem with a handle for each section.
    pub fn problem<'a>(&'a self, whole: &Problem<'a>) -> Problem<'a> {
        Problem {
            roles: &self.roles,
            handle_count: self.sections.handle_of.len(),
            constraints: Constraints {
                soft: &self.soft,
                sections: &[],
                ..whole.constraints
            },
            ..*whole
        }
    }
}

impl Sections {
    /// The number of handles.
    pub fn handle_count(&self) -> usize {
        self.vertices.len()
    }

    /// A handle's surface vertices, ascending; empty for a number that no handle has.
    pub fn vertices(&self, handle: usize) -> &[u32] {
        self.vertices.get(handle).map_or(&[], Vec::as_slice)
    }

    /// For each section, whether its handle has no other.
    pub fn are_whole(&self) -> Vec<bool> {
        let mut counts = vec![0; self.handle_count()];
        for handle in &self.handle_of {
            counts[*handle] += 1;
        }
        self.handle_of.iter().map(|handle| counts[*handle] == 1).collect()
    }

    /// The target of each section, from one target for each handle with an entry for each of its vertices.
    pub fn targets(&self, targets: &[Target]) -> Vec<Target> {
        let mut own: Vec<Target> = self
            .handle_of
            .iter()
            .map(|handle| match &targets[*handle] {
                Target::Map(map) => Target::Map(*map),
                Target::Places(_) => Target::Places(Vec::new()),
                Target::Maps(_) => Target::Maps(Vec::new()),
            })
            .collect();
        for (target, sections) in targets.iter().zip(&self.section_of) {
            for (at, section) in sections.iter().enumerate() {
                match (&mut own[*section], target) {
                    (Target::Places(own), Target::Places(places)) => own.push(places[at]),
                    (Target::Maps(own), Target::Maps(maps)) => own.push(maps[at]),
                    _ => {}
                }
            }
        }
        own
    }
}

/// The largest difference, in radians, between the turns of two vertices with these maps if no vertex has a turn between
/// them.
pub(super) fn largest_gap_rad(maps: &[TurnedMap]) -> f64 {
    let mut turns: Vec<f64> = maps.iter().map(|map| map.turn_rad.length()).collect();
    turns.sort_unstable_by(f64::total_cmp);
    turns.windows(2).map(|pair| pair[1] - pair[0]).fold(0.0, f64::max)
}

/// The motion of a section whose vertices move with these maps: their mean place, turn and size.
pub(super) fn mean_motion(handle: &Handle, maps: &[TurnedMap]) -> Motion {
    let Some(TurnedMap { map: first, .. }) = maps.first() else {
        return Motion::default();
    };
    let count = maps.len() as f64;
    let turn_rad = Some(maps.iter().map(|map| map.turn_rad).sum::<DVec3>() / count);
    let maps = || maps.iter().map(|own| &own.map);
    if maps().all(|map| map == first) {
        return Motion {
            turn_rad,
            ..handle.motion(first)
        };
    }
    // As differences from the first map, so that far from the origin the shift keeps its digits.
    let start = handle.motion(first);
    let others = maps().map(|map| handle.motion(map).shift - start.shift);
    let shift = start.shift + others.sum::<DVec3>() / count;
    let sum = maps().fold(DMat3::ZERO, |sum, map| sum + map.matrix3.transpose());
    let size = maps().map(|map| map.matrix3.determinant().cbrt()).sum::<f64>() / count;
    let linear = DMat3::from_quat(best_rotation(&sum)) * size;
    Motion {
        linear: (linear - DMat3::IDENTITY) * handle.radius,
        shift,
        turn_rad,
    }
}
