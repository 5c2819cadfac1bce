//! Bends a part so that its borders reach their targets: the rims and one ring beside them are handles, and the surface
//! within reach of them is free.
//!
//! Each rim is several handles, so that methods which distribute the handles' turns over the surface bend each side of
//! the rim by its own turn.

use std::collections::BTreeMap;

use glam::{DAffine3, DMat3, DQuat, DVec3};
use pliant_deform::{
    BilaplacianOrder, BindError, Bound, Budget, Loose, Method, Problem, Role, SolveError, Target, fair,
};
use pliant_mesh::{Cancel, Progress, Surface, SurfaceVertex, Topology, distances_along_surface};

use super::choice;
use crate::error::StitchError;

/// The vertices of a part's rims.
pub(super) type Rims = BTreeMap<SurfaceVertex, RimVertex>;

/// The motion of a rim's vertex.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(super) struct RimVertex {
    /// Its displacement.
    pub way: DVec3,
    /// The turn of the surface there.
    pub turn: DQuat,
    /// Its handle. Handles are numbered from 0 without gaps.
    pub handle: u16,
}

/// The target of a handle's vertex.
#[derive(Clone, Copy, Debug)]
struct Placed {
    at: DVec3,
    handle: u16,
}

/// The input for the bending of a part.
#[derive(Clone, Copy, Debug)]
pub(super) struct Bending<'a> {
    /// Its surface, in its final place.
    pub surface: &'a Surface,
    /// The surface's connectivity.
    pub topology: &'a Topology,
    /// The largest distance along the surface from the rims at which it may bend, in world units.
    pub reach: f64,
    /// Displacements up to this length, in world units, are rounding: the part does not bend for them.
    pub touch: f64,
    /// The method.
    pub method: &'a Method,
    /// The memory for the binding.
    pub budget: Budget,
    /// `A` or `B`.
    pub name: &'static str,
}

/// The most steps of an iterative method.
const MOST_STEPS: u32 = 500;

impl Bending<'_> {
    /// Computes the displacement of each vertex of the surface, and tells whether the method converged. Rims reach their
    /// targets exactly.
    ///
    /// # Errors
    /// The refusals of the method.
    pub fn bent(&self, rims: &Rims, progress: &Progress, cancel: &Cancel) -> Result<(Vec<DVec3>, bool), StitchError> {
        let mut out = vec![DVec3::ZERO; self.surface.positions.len()];
        let places = self.places(rims);
        let way =
            |(vertex, place): (&SurfaceVertex, &Placed)| place.at.distance(self.surface.positions[vertex.index()]);
        if places.iter().map(way).fold(0.0, f64::max) <= self.touch {
            return Ok((out, true));
        }
        let sources: Vec<SurfaceVertex> = rims.keys().copied().collect();
        let far = distances_along_surface(self.surface, self.topology, &sources, self.reach);
        let role = |vertex: usize| match places.get(&SurfaceVertex(vertex as u32)) {
            Some(place) => Role::Handle(place.handle),
            None if far[vertex] <= self.reach => Role::Free,
            None => Role::Fixed,
        };
        let roles: Vec<Role> = (0..far.len()).map(role).collect();
        let stiffness = vec![1.0; roles.len()];
        let problem = Problem {
            loose: Loose::Rest,
            ..Problem::new((self.surface, self.topology), &roles, &stiffness, self.method)
        };
        let bind = |source: BindError| match source {
            BindError::Cancelled(cancelled) => cancelled.into(),
            source => StitchError::Bind {
                part: self.name,
                source,
            },
        };
        let ordering = problem.ordering_within(self.budget, progress, cancel)?;
        let mut bound = problem
            .bind_within(ordering.as_ref(), self.budget, progress, cancel)
            .map_err(bind)?;
        let has_converged = self.solve(&mut bound, &places, &mut out, cancel)?;
        // The bi-Laplacian spreads the displacements that the method leaves missing at the targets.
        let rest = |vertex: usize| self.surface.positions[vertex];
        let missing = |vertex: &SurfaceVertex, place: &Placed| place.at - rest(vertex.index()) - out[vertex.index()];
        let largest = places
            .iter()
            .map(|(vertex, place)| missing(vertex, place).length())
            .fold(0.0, f64::max);
        if largest > 1e-9 * self.reach {
            let mut ways = vec![[0.0; 3]; out.len()];
            for (vertex, place) in &places {
                ways[vertex.index()] = missing(vertex, place).to_array();
            }
            let free: Vec<u32> = (0..roles.len() as u32)
                .filter(|&v| roles[v as usize] == Role::Free)
                .collect();
            let order = BilaplacianOrder::ThinPlate;
            fair(
                self.surface,
                self.topology,
                &free,
                order,
                &mut ways,
                self.budget,
                cancel,
            )
            .map_err(bind)?;
            out.iter_mut()
                .zip(&ways)
                .for_each(|(out, way)| *out += DVec3::from_array(*way));
        }
        Ok((out, has_converged))
    }

    /// The targets of the rims' vertices and of those beside them, which turn with the rim.
    fn places(&self, rims: &Rims) -> BTreeMap<SurfaceVertex, Placed> {
        let position = |vertex: SurfaceVertex| self.surface.positions[vertex.index()];
        let mut beside: BTreeMap<SurfaceVertex, (DVec3, f64, u16)> = BTreeMap::new();
        for (&vertex, &RimVertex { way, turn, handle }) in rims {
            let others = self.topology.neighbours(vertex).iter();
            for &other in others.filter(|other| !rims.contains_key(other)) {
                let arm = position(other) - position(vertex);
                // The turn contributes a difference, so that the identity contributes exactly nothing.
                let turned = if turn == DQuat::IDENTITY {
                    DVec3::ZERO
                } else {
                    turn * arm - arm
                };
                let (sum, count, _) = beside.entry(other).or_insert((DVec3::ZERO, 0.0, handle));
                *sum += way + turned;
                *count += 1.0;
            }
        }
        let own = rims.iter().map(|(&vertex, rim)| {
            let at = position(vertex) + rim.way;
            (vertex, Placed { at, handle: rim.handle })
        });
        let beside = beside.into_iter().map(|(vertex, (sum, count, handle))| {
            let at = position(vertex) + sum / count;
            (vertex, Placed { at, handle })
        });
        own.chain(beside).collect()
    }

    /// Steps until the method is done, and tells whether it converged.
    fn solve(
        &self,
        bound: &mut Bound,
        places: &BTreeMap<SurfaceVertex, Placed>,
        out: &mut [DVec3],
        cancel: &Cancel,
    ) -> Result<bool, StitchError> {
        let refuse = |source: SolveError| StitchError::Solve {
            part: self.name,
            source,
        };
        let count = places
            .values()
            .map(|place| usize::from(place.handle) + 1)
            .max()
            .unwrap_or(0);
        let mut of_handles: Vec<(Vec<DVec3>, Vec<DVec3>)> = vec![Default::default(); count];
        for (vertex, place) in places {
            let (rest, list) = &mut of_handles[usize::from(place.handle)];
            rest.push(self.surface.positions[vertex.index()]);
            list.push(place.at);
        }
        let targets: Vec<Target> = of_handles
            .iter()
            .map(|(_, list)| Target::Places(list.clone()))
            .collect();
        match bound.set_places(&targets) {
            Err(SolveError::NoPlaces { .. }) => {
                let maps: Vec<DAffine3> = of_handles.iter().map(|(rest, list)| rigid(rest, list)).collect();
                bound.set_targets(&maps).map_err(refuse)?;
            }
            other => other.map_err(refuse)?,
        }
        for _ in 0..MOST_STEPS {
            cancel.check()?;
            let step = bound.step(out).map_err(refuse)?;
            if step.finished {
                return Ok(step.converged);
            }
        }
        Ok(false)
    }
}

/// The rigid motion that takes points nearest to others, as a map.
fn rigid(from: &[DVec3], to: &[DVec3]) -> DAffine3 {
    choice::fit(from, to).map_or(DAffine3::IDENTITY, |motion| {
        DAffine3::from_mat3_translation(DMat3::from_quat(motion.rotation()), motion.displace(DVec3::ZERO))
    })
}
