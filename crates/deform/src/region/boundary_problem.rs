//! The problem without its method: a surface and its constraints.

use pliant_mesh::{Bounds, Surface, SurfaceVertex, Topology, bounding_box};

use super::size;
use crate::{Constraints, Examples, Loose, Role};

/// The boundary value problem that a method solves: a [`crate::Problem`] without the method. All slices have one entry
/// per surface vertex.
#[derive(Clone, Copy, Debug)]
pub(crate) struct BoundaryProblem<'a> {
    pub surface: &'a Surface,
    pub topology: &'a Topology,
    pub roles: &'a [Role],
    pub handle_count: usize,
    pub stiffness: &'a [f64],
    pub constraints: Constraints<'a>,
    pub loose: Loose,
    /// The brought examples that the method takes.
    pub examples: Option<&'a Examples>,
}

impl<'a> BoundaryProblem<'a> {
    /// The problem of these roles and this stiffness, with hard handles and without examples; loose components follow.
    pub fn new((surface, topology): (&'a Surface, &'a Topology), roles: &'a [Role], stiffness: &'a [f64]) -> Self {
        Self {
            surface,
            topology,
            roles,
            handle_count: handle_count(roles),
            stiffness,
            constraints: Constraints::default(),
            loose: Loose::default(),
            examples: None,
        }
    }

    /// The behaviour of each component if nothing holds it.
    pub fn loose_by_component(&self) -> Vec<Loose> {
        let mut loose = vec![self.loose; self.topology.components().len()];
        for &(part, own) in self.constraints.parts {
            if let Some(loose) = loose.get_mut(part as usize) {
                *loose = own;
            }
        }
        loose
    }

    /// The surface's bounding box; bare points don't count if there are triangles.
    pub fn bounds(&self) -> Option<Bounds> {
        bounding_box(self.topology.main_positions(&self.surface.positions))
    }

    /// The size of the bending part, in world units.
    pub fn size(&self) -> f64 {
        size::size(self.surface, self.topology, self.roles)
    }

    /// Returns true if a vertex is free or held softly.
    pub fn may_move(&self, vertex: SurfaceVertex) -> bool {
        match self.roles.get(vertex.index()) {
            Some(Role::Free) => true,
            Some(Role::Handle(handle)) => self.constraints.weight(*handle).is_some(),
            Some(Role::Fixed) | None => false,
        }
    }
}

/// The number of handles up to the highest one that a role names.
pub(crate) fn handle_count(roles: &[Role]) -> usize {
    let number = |role: &Role| match role {
        Role::Handle(number) => Some(usize::from(*number) + 1),
        Role::Fixed | Role::Free => None,
    };
    roles.iter().filter_map(number).max().unwrap_or(0)
}
