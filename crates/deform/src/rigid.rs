//! Parts of infinite stiffness: each moves as one body, by every method.
//!
//! A method is bound twice. First the parts are very stiff, which gives each one's motion: the rigid motion that fits
//! its vertices best [Hor87]. Then each part is a handle with that motion, so that it keeps its shape to rounding and
//! its surroundings join it like any handle.

use glam::DVec3;
use pliant_mesh::{Cancel, Progress, SurfaceVertex};

use crate::handles::{Handle, Motion};
use crate::needs::ConstraintKind;
use crate::numerical::rigid_fit::RigidMotion;
use crate::sparse::refactorisation::Refactorisation;
use crate::{BindError, Bound, Budget, Ordering, Problem, Role, SolveError, Step, Warning};

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
                "{count} free vertices are painted rigid together with some that are held still, so they stay: widen the \
                 handle's reach or the region over the whole part, or paint less of it rigid"
            )
            .into()
        })
    }

    /// Binds the problem of [`Softened::problem`] once more, with a handle for each part; `None` if every part belongs
    /// to a handle or is fixed.
    ///
    /// # Errors
    /// Those of any binding.
    pub fn bind_parts(
        &self,
        problem: &Problem,
        ordering: Option<&Ordering>,
        budget: Budget,
        progress: &Progress,
        cancel: &Cancel,
    ) -> Result<Option<RigidParts>, BindError> {
        if self.parts.is_empty() {
            return Ok(None);
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
        let mut problem = self.problem(problem);
        problem.roles = &roles;
        problem.handle_count += self.parts.len();
        problem.constraints.soft = &soft;
        let positions = &problem.surface.positions;
        let part = |vertices: &Vec<u32>| Part {
            rest: vertices.iter().map(|&vertex| positions[vertex as usize]).collect(),
            handle: Handle::new(vertices.clone(), positions),
        };
        let bound = Bound::bind_plain(&problem, ordering, Refactorisation::Never, budget, progress, cancel)?;
        Ok(Some(RigidParts {
            parts: self.parts.iter().map(part).collect(),
            moved: Vec::new(),
            bound,
        }))
    }
}

/// A part that moves as one body.
#[derive(Debug)]
struct Part {
    handle: Handle,
    rest: Vec<DVec3>,
}

/// The parts, and the problem in which they are handles.
#[derive(Debug)]
pub(crate) struct RigidParts {
    parts: Vec<Part>,
    /// Displacements of a part, kept from frame to frame.
    moved: Vec<DVec3>,
    pub bound: Bound,
}

impl RigidParts {
    /// Replaces a shape in which the parts are very stiff by one in which they are rigid.
    ///
    /// # Errors
    /// Those of a step.
    pub fn step(&mut self, motions: &[Motion], displacements: &mut [DVec3]) -> Result<Step, SolveError> {
        let mut all = motions.to_vec();
        for part in &self.parts {
            self.moved.clear();
            let vertices = part.handle.vertices.iter();
            self.moved
                .extend(vertices.map(|&vertex| displacements[vertex as usize]));
            let fit = RigidMotion::fit(&part.rest, &self.moved);
            all.push(fit.map_or(Motion::default(), |fit| fit.motion_of(&part.handle)));
        }
        let of_parts = all[motions.len()..].to_vec();
        self.bound.follow(all);
        let step = self.bound.step(displacements)?;
        // A method that only fits handles bends the parts a little.
        for (part, motion) in self.parts.iter().zip(&of_parts) {
            for (&vertex, &position) in part.handle.vertices.iter().zip(&part.rest) {
                displacements[vertex as usize] = motion.displace(part.handle.coordinates(position));
            }
        }
        Ok(step)
    }
}
