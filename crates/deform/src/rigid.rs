//! Parts of infinite stiffness: each moves as one body, by every method.
//!
//! A method is bound twice. First the parts are very stiff, which gives each one's motion: the rigid motion that fits
//! its vertices best [Hor87]. Then each part is a handle with that motion, so that it keeps its shape to rounding and
//! its surroundings join it like any handle.

use glam::DVec3;
use pliant_mesh::SurfaceVertex;

use crate::handles::polar::Polar;
use crate::handles::{Handle, Motion};
use crate::needs::ConstraintKind;
use crate::numerical::rigid_fit::RigidMotion;
use crate::{BindError, Problem, Role, Warning};

/// The stiffness of the parts during the search for their motions. With more stiffness iterative methods converge more
/// slowly: on a bar ARAP takes 76 steps at 30, 129 at 100 and 550 at 1000, and the parts' motions differ from those at
/// 10,000 by up to 0.5%, 0.2% and 0.02% of the displacement.
const FIRM: f64 = 1e2;

/// The most parts: every part needs the tables of a handle.
pub const MOST_RIGID_PARTS: usize = 256;

/// A problem in which rigid parts are very stiff, and these parts.
#[derive(Debug)]
pub(crate) struct Softened {
    /// The roles, in which parts connected to one handle, or to fixed vertices, have that role.
    pub roles: Vec<Role>,
    pub stiffness: Vec<f64>,
    /// The free vertices of each other part, ascending.
    parts: Vec<Vec<u32>>,
    /// The number of free vertices that stay because their part contains fixed ones.
    held_count: usize,
}

impl Softened {
    /// `None` if nothing is rigid, or the tables don't fit the surface.
    ///
    /// # Errors
    /// [`BindError::RigidParts`].
    pub fn of(problem: &Problem) -> Result<Option<Self>, BindError> {
        let count = problem.surface.positions.len();
        let is_rigid = |vertex: usize| problem.stiffness[vertex] == f64::INFINITY;
        if problem.roles.len() != count || problem.stiffness.len() != count || !(0..count).any(is_rigid) {
            return Ok(None);
        }
        let firm = match problem.method.declaration().heeds(ConstraintKind::Stiffness) {
            true => FIRM,
            false => 1.0,
        };
        let stiffness = problem.stiffness.iter();
        let mut softened = Self {
            roles: problem.roles.to_vec(),
            stiffness: stiffness.map(|&s| if s == f64::INFINITY { firm } else { s }).collect(),
            parts: Vec::new(),
            held_count: 0,
        };
        let mut is_seen = vec![false; count];
        let mut bare = Vec::new();
        for first in 0..count {
            if is_seen[first] || !is_rigid(first) {
                continue;
            }
            let mut part = Vec::new();
            let mut stack = vec![first];
            is_seen[first] = true;
            while let Some(vertex) = stack.pop() {
                part.push(vertex as u32);
                for next in problem.topology.neighbours(SurfaceVertex(vertex as u32)) {
                    if is_rigid(next.index()) && !std::mem::replace(&mut is_seen[next.index()], true) {
                        stack.push(next.index());
                    }
                }
            }
            let is_bare = problem.topology.neighbours(SurfaceVertex(first as u32)).is_empty();
            if is_bare {
                // Points have no neighbours: all of them are one part.
                bare.append(&mut part);
            } else {
                softened.take_part(problem, part);
            }
        }
        if !bare.is_empty() {
            softened.take_part(problem, bare);
        }
        if softened.parts.len() > MOST_RIGID_PARTS {
            return Err(BindError::RigidParts {
                found: softened.parts.len(),
                most: MOST_RIGID_PARTS,
            });
        }
        Ok(Some(softened))
    }

    fn take_part(&mut self, problem: &Problem, mut part: Vec<u32>) {
        part.sort_unstable();
        let mut holders: Vec<Role> = part
            .iter()
            .map(|&vertex| problem.roles[vertex as usize])
            .filter(|&role| match role {
                Role::Free => false,
                Role::Fixed => true,
                Role::Handle(handle) => problem.constraints.weight(handle).is_none(),
            })
            .collect();
        holders.dedup();
        let is_one = holders.windows(2).all(|pair| pair[0] == pair[1]);
        part.retain(|&vertex| problem.roles[vertex as usize] == Role::Free);
        match holders.first() {
            Some(&holder) if is_one => {
                for &vertex in &part {
                    self.roles[vertex as usize] = holder;
                }
                if holder == Role::Fixed {
                    self.held_count += part.len();
                }
            }
            _ if part.is_empty() => {}
            _ => self.parts.push(part),
        }
    }

    /// The problem with these tables.
    pub fn problem<'a>(&'a self, problem: &Problem<'a>) -> Problem<'a> {
        Problem {
            roles: &self.roles,
            stiffness: &self.stiffness,
            ..*problem
        }
    }

    /// A sentence if paint fixes more than a person may have meant.
    pub fn warning(&self) -> Option<Warning> {
        let count = self.held_count;
        (count > 0).then(|| {
            format!(
                "{count} free vertices are painted rigid together with fixed ones, so they stay: widen the handle's \
                 reach or the region over the whole part, or paint less of it rigid"
            )
            .into()
        })
    }

    /// The tables in which each part is a handle after the problem's own; `None` if every part belongs to a handle or is
    /// fixed.
    pub fn bodies(&self, problem: &Problem) -> Option<Bodies> {
        if self.parts.is_empty() {
            return None;
        }
        let mut roles = self.roles.clone();
        for (number, part) in (problem.handle_count..).zip(&self.parts) {
            for &vertex in part {
                roles[vertex as usize] = Role::Handle(number as u16);
            }
        }
        let mut soft = problem.constraints.soft.to_vec();
        if !soft.is_empty() {
            soft.resize(problem.handle_count + self.parts.len(), None);
        }
        let positions = &problem.surface.positions;
        let part = |vertices: &Vec<u32>| Part {
            rest: vertices.iter().map(|&vertex| positions[vertex as usize]).collect(),
            handle: Handle::new(vertices.clone(), positions),
        };
        Some(Bodies {
            roles,
            soft,
            parts: self.parts.iter().map(part).collect(),
        })
    }
}

/// The parts as bodies, and the tables of the problem in which they are handles.
#[derive(Debug)]
pub(crate) struct Bodies {
    roles: Vec<Role>,
    soft: Vec<Option<f64>>,
    pub parts: Vec<Part>,
}

impl Bodies {
    /// The problem of [`Softened::problem`] with these tables.
    pub fn problem<'a>(&'a self, softened: &Problem<'a>) -> Problem<'a> {
        let mut problem = *softened;
        problem.roles = &self.roles;
        problem.handle_count += self.parts.len();
        problem.constraints.soft = &self.soft;
        problem
    }
}

/// A part that moves as one body.
#[derive(Debug)]
pub(crate) struct Part {
    handle: Handle,
    rest: Vec<DVec3>,
}

impl Part {
    /// The rigid motion that fits the part's displacements best; `moved` is scratch.
    pub fn motion(&self, displacements: &[DVec3], moved: &mut Vec<DVec3>) -> Motion {
        moved.clear();
        let vertices = self.handle.vertices.iter();
        moved.extend(vertices.map(|&vertex| displacements[vertex as usize]));
        let fit = RigidMotion::fit(&self.rest, moved);
        fit.map_or(Motion::default(), |fit| self.handle.rigid_motion(&fit))
    }

    /// The motion with the full turns that are nearest to those of the `last` one.
    pub fn wound(&self, motion: Motion, last: &Motion) -> Motion {
        let shortest = Polar::of(&self.handle.linear(&motion));
        Motion {
            turn_rad: Some(shortest.near(last.turn_rad.unwrap_or_default()).turn_rad),
            ..motion
        }
    }

    /// Moves the part as one body.
    pub fn place(&self, motion: &Motion, displacements: &mut [DVec3]) {
        for (&vertex, &position) in self.handle.vertices.iter().zip(&self.rest) {
            displacements[vertex as usize] = motion.displace(self.handle.coordinates(position));
        }
    }
}
