//! Bending a part so that its borders go to their places: the rims and one ring beside them are the handle, the surface
//! within reach of them is free.

use std::collections::BTreeMap;

use glam::{DQuat, DVec3};
use pliant_deform::{
    BilaplacianOrder, BindError, Bound, Budget, Constraints, Loose, Method, Problem, Role, SolveError, Target, fair,
};
use pliant_mesh::{Cancel, Progress, Surface, SurfaceVertex, Topology, distances_along_surface};

use crate::error::StitchError;

/// The way and the turn of each vertex of a part's rims.
pub(super) type Rims = BTreeMap<SurfaceVertex, (DVec3, DQuat)>;

/// How a part is bent.
#[derive(Clone, Copy, Debug)]
pub(super) struct Bending<'a> {
    /// Its surface, in its final place.
    pub surface: &'a Surface,
    /// The surface's connectivity.
    pub topology: &'a Topology,
    /// How far along the surface from the rims it may bend, in world units.
    pub reach: f64,
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
    /// The displacement of each vertex of the surface. Rims go exactly to their targets.
    ///
    /// # Errors
    /// The refusals of the method.
    pub fn bent(&self, rims: &Rims, progress: &Progress, cancel: &Cancel) -> Result<Vec<DVec3>, StitchError> {
        let mut out = vec![DVec3::ZERO; self.surface.positions.len()];
        let places = self.places(rims);
        if places
            .iter()
            .all(|(vertex, place)| *place == self.surface.positions[vertex.index()])
        {
            return Ok(out);
        }
        let sources: Vec<SurfaceVertex> = rims.keys().copied().collect();
        let far = distances_along_surface(self.surface, self.topology, &sources, self.reach);
        let role = |vertex: usize| match places.contains_key(&SurfaceVertex(vertex as u32)) {
            true => Role::Handle(0),
            false if far[vertex] <= self.reach => Role::Free,
            false => Role::Fixed,
        };
        let roles: Vec<Role> = (0..far.len()).map(role).collect();
        let problem = Problem {
            surface: self.surface,
            topology: self.topology,
            roles: &roles,
            handle_count: 1,
            stiffness: &vec![1.0; roles.len()],
            constraints: Constraints::default(),
            loose: Loose::Rest,
            method: self.method,
            attachments: &[],
            revision: 0,
        };
        let bind = |source: BindError| match source {
            BindError::Cancelled(cancelled) => cancelled.into(),
            source => StitchError::Bind {
                part: self.name,
                source,
            },
        };
        let power = problem.ordering_power_within(self.budget);
        let ordering = power.map(|power| pliant_deform::Ordering::of(self.topology, power, progress, cancel));
        let ordering = ordering.transpose()?;
        let mut bound = problem
            .bind_within(ordering.as_ref(), self.budget, progress, cancel)
            .map_err(bind)?;
        self.solve(&mut bound, &places, &mut out, cancel)?;
        // What the method does not take as places is spread by the bi-Laplacian.
        let rest = |vertex: usize| self.surface.positions[vertex];
        let missing = |vertex: &SurfaceVertex, place: &DVec3| *place - rest(vertex.index()) - out[vertex.index()];
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
        Ok(out)
    }

    /// The places of the rims' vertices and of those beside them, which turn with the rim.
    fn places(&self, rims: &Rims) -> BTreeMap<SurfaceVertex, DVec3> {
        let position = |vertex: SurfaceVertex| self.surface.positions[vertex.index()];
        let mut beside: BTreeMap<SurfaceVertex, (DVec3, f64)> = BTreeMap::new();
        for (&vertex, &(way, turn)) in rims {
            for &other in self
                .topology
                .neighbours(vertex)
                .iter()
                .filter(|other| !rims.contains_key(other))
            {
                let arm = position(other) - position(vertex);
                // The turn's own part is added as a difference, so that no turn leaves no trace.
                let moved = way + (turn * arm - arm);
                let (sum, count) = beside.entry(other).or_default();
                *sum += if turn == DQuat::IDENTITY { way } else { moved };
                *count += 1.0;
            }
        }
        let rims = rims.iter().map(|(&vertex, &(way, _))| (vertex, position(vertex) + way));
        let beside = beside
            .into_iter()
            .map(|(vertex, (sum, count))| (vertex, position(vertex) + sum / count));
        rims.chain(beside).collect()
    }

    fn solve(
        &self,
        bound: &mut Bound,
        places: &BTreeMap<SurfaceVertex, DVec3>,
        out: &mut [DVec3],
        cancel: &Cancel,
    ) -> Result<(), StitchError> {
        let refuse = |source: SolveError| StitchError::Solve {
            part: self.name,
            source,
        };
        let list: Vec<DVec3> = places.values().copied().collect();
        match bound.set_places(&[Target::Places(list.clone())]) {
            Err(SolveError::NoPlaces { .. }) => {
                let rest: Vec<DVec3> = places
                    .keys()
                    .map(|vertex| self.surface.positions[vertex.index()])
                    .collect();
                let motion = super::choice::fit(&rest, &list);
                let map = motion.map_or(glam::DAffine3::IDENTITY, |motion| {
                    let shift = motion.displace(DVec3::ZERO);
                    let axis = |axis: DVec3| axis + (motion.displace(axis) - shift);
                    let linear = glam::DMat3::from_cols(axis(DVec3::X), axis(DVec3::Y), axis(DVec3::Z));
                    glam::DAffine3::from_mat3_translation(linear, shift)
                });
                bound.set_targets(&[map]).map_err(refuse)?;
            }
            other => other.map_err(refuse)?,
        }
        for _ in 0..MOST_STEPS {
            cancel.check()?;
            if bound.step(out).map_err(refuse)?.finished {
                break;
            }
        }
        Ok(())
    }
}
