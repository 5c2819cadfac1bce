//! A flow and its steps.

use std::sync::Arc;

use glam::{DVec2, DVec3};
use pliant_deform::{Budget, Ordering, PoissonEquation};
use pliant_mesh::{Cancel, Model, Progress, Surface, Topology};
use rayon::prelude::*;

use crate::advection::{Scratch, advect};
use crate::conservation::{conserve, integrals};
use crate::dye::Dye;
use crate::energy::{cap, check_finite};
use crate::error::FlowError;
use crate::fluid::Fluid;
use crate::forces::{confine, pull};
use crate::held::Held;
use crate::projection::{Pressure, divergence_norm};
use crate::settings::FlowSettings;
use crate::sheets::Sheets;
use crate::sums::CHUNK;
use crate::viscosity::Friction;

/// An incompressible fluid on a surface, and the dye in it. See the crate's page.
#[derive(Debug)]
pub struct Flow<'a> {
    fluid: Fluid<'a>,
    pressure: Pressure,
    /// Made when there is viscosity for the first time.
    friction: Option<Friction>,
    /// The velocity of each triangle, in its plane.
    velocity: Vec<DVec2>,
    /// The dye of each vertex; empty until some is poured.
    dye: Vec<Dye>,
    /// The integral of the dye over each component, as poured.
    poured: Vec<Dye>,
    /// Whether velocities were added since the last projection.
    has_added: bool,
    /// The length of the last step; 0 before the first.
    last_step: f64,
    /// The norm of the velocity on each component, while it is known.
    speeds: Option<Vec<f64>>,
    scratch: Scratch,
}

impl Flow<'static> {
    /// As [`Flow::bind`], on a model that it shares with others. With `displacements`, one for each vertex, the surface
    /// is bent by these.
    ///
    /// # Errors
    /// Those of [`Flow::bind`].
    pub fn bind_shape(
        model: &Arc<Model>,
        displacements: Option<&[DVec3]>,
        budget: Budget,
        progress: &Progress,
        cancel: &Cancel,
    ) -> Result<Self, FlowError> {
        let surface = match displacements {
            None => Held::OfModel(Arc::clone(model)),
            Some(displacements) => {
                let mut bent = model.surface.clone();
                let moved = bent.positions.iter_mut().zip(displacements);
                moved.for_each(|(position, displacement)| *position += *displacement);
                Held::Own(Box::new(bent))
            }
        };
        let topology = Held::OfModel(Arc::clone(model));
        Self::bind_held(surface, topology, budget, progress, cancel)
    }
}

impl<'a> Flow<'a> {
    /// Lays the surface out and factors its Laplacian. The fluid rests and is clear.
    ///
    /// # Errors
    /// If there is no triangle, if the Laplacian can't be factored within `budget`, or if `cancel` is raised.
    pub fn bind(
        surface: &'a Surface,
        topology: &'a Topology,
        budget: Budget,
        progress: &Progress,
        cancel: &Cancel,
    ) -> Result<Self, FlowError> {
        Self::bind_held(Held::Lent(surface), Held::Lent(topology), budget, progress, cancel)
    }

    fn bind_held(
        surface: Held<'a, Surface>,
        topology: Held<'a, Topology>,
        budget: Budget,
        progress: &Progress,
        cancel: &Cancel,
    ) -> Result<Self, FlowError> {
        if surface.triangles.is_empty() {
            return Err(FlowError::NoTriangles);
        }
        let sheets = Sheets::of(surface, topology);
        let vertex_count = sheets.surface.positions.len();
        let ordering = Ordering::of(&sheets.topology, 1, &progress.part(0.0, 0.5), cancel)?;
        let equation =
            PoissonEquation::bind(&sheets.surface, &sheets.topology, &ordering, budget, cancel).map_err(|error| {
                FlowError::of_binding(error, vertex_count).renumbered(|v| sheets.original(v as usize) as u32)
            })?;
        drop(ordering);
        progress.set(0.9);
        cancel.check()?;
        let fluid = Fluid::of(sheets);
        progress.set(1.0);
        Ok(Self {
            pressure: Pressure::new(equation, vertex_count),
            friction: None,
            velocity: vec![DVec2::ZERO; fluid.triangle_count()],
            dye: Vec::new(),
            poured: vec![Dye::default(); fluid.component_count()],
            has_added: false,
            last_step: 0.0,
            speeds: None,
            scratch: Scratch::default(),
            fluid,
        })
    }

    /// Adds the tangential part of a field of velocities, in world units per second at world positions. `shares` has a
    /// factor for each vertex of the surface; a triangle takes the mean of its corners'.
    pub fn add_velocity(&mut self, shares: &[f64], field: impl Fn(DVec3) -> DVec3 + Sync) {
        self.change_velocity(shares, |share, _, middle| field(middle) * share);
    }

    /// Moves the velocity towards the tangential part of another, in world units per second, by `shares` from 0 to 1,
    /// one for each vertex of the surface; a triangle takes the mean of its corners'.
    pub fn push(&mut self, shares: &[f64], towards: DVec3) {
        self.change_velocity(shares, |share, own, _| (towards - own) * share);
    }

    /// Adds the tangential part of `change` where the mean share of a triangle's corners is not 0. `change` takes that
    /// share, the triangle's velocity and its middle.
    fn change_velocity(&mut self, shares: &[f64], change: impl Fn(f64, DVec3, DVec3) -> DVec3 + Sync) {
        let fluid = &self.fluid;
        let share = |vertex: usize| shares.get(fluid.sheets.original(vertex)).copied().unwrap_or(0.0);
        let add = |(triangle, velocity): (usize, &mut DVec2)| {
            let mean = fluid.corners(triangle).map(share).iter().sum::<f64>() / 3.0;
            if mean != 0.0 {
                let [x, y] = fluid.axes(triangle);
                let change = change(mean, x * velocity.x + y * velocity.y, fluid.middle(triangle));
                *velocity += DVec2::new(x.dot(change), y.dot(change));
            }
        };
        let velocities = self.velocity.par_iter_mut().with_min_len(CHUNK);
        velocities.enumerate().for_each(add);
        self.has_added = true;
    }

    /// Goes back or forth to another state: the tangential part of a velocity for each triangle of the surface, in
    /// world units per second, and a dye for each vertex, as [`Flow::dyes`] gives it. The next step begins there.
    pub fn set_state(&mut self, velocity: impl Fn(usize) -> DVec3 + Sync, dye: impl Fn(usize) -> [f64; 4] + Sync) {
        let fluid = &self.fluid;
        for given in 0..fluid.triangle_count() {
            let (triangle, own) = (fluid.sheets.triangle(given), velocity(given));
            self.velocity[triangle] = DVec2::from(fluid.axes(triangle).map(|axis| axis.dot(own)));
        }
        let dyes = (0..fluid.vertex_count()).into_par_iter().with_min_len(CHUNK);
        self.dye = dyes.map(|vertex| dye(fluid.sheets.original(vertex))).collect();
        self.poured = integrals(fluid, &self.dye);
        if self.dye.iter().all(|dye| dye[3] == 0.0) {
            self.dye = Vec::new();
        }
        self.has_added = true;
        self.last_step = 0.0;
    }

    /// Pours dye over the dye that is there. `amounts` has a coverage from 0 to 1 for each vertex of the surface; the
    /// colour is linear red, green and blue, each from 0 to 1.
    pub fn pour(&mut self, amounts: &[f64], [red, green, blue]: [f64; 3]) {
        self.dye.resize(self.fluid.vertex_count(), Dye::default());
        for (vertex, dye) in self.dye.iter_mut().enumerate() {
            let amount = amounts
                .get(self.fluid.sheets.original(vertex))
                .map_or(0.0, |amount| amount.clamp(0.0, 1.0));
            let poured = [red, green, blue, 1.0].map(|value| value.clamp(0.0, 1.0));
            *dye = std::array::from_fn(|k| dye[k] + amount * (poured[k] - dye[k]));
        }
        self.poured = integrals(&self.fluid, &self.dye);
    }

    /// Takes dye away: `amounts` has the share that is lost, from 0 to 1, for each vertex of the surface.
    pub fn clear(&mut self, amounts: &[f64]) {
        for (vertex, dye) in self.dye.iter_mut().enumerate() {
            let amount = amounts.get(self.fluid.sheets.original(vertex)).copied().unwrap_or(0.0);
            *dye = dye.map(|value| value * (1.0 - amount.clamp(0.0, 1.0)));
        }
        self.poured = integrals(&self.fluid, &self.dye);
    }

    /// Takes the divergence out of the velocity. Steps do so themselves; velocities that were added need it if they are
    /// to be looked at before a step.
    ///
    /// # Errors
    /// If the pressure can't be found.
    pub fn project(&mut self) -> Result<(), FlowError> {
        self.speeds = None;
        let room = &mut self.scratch.room;
        self.pressure.project_added(&self.fluid, &mut self.velocity, room)?;
        self.has_added = false;
        Ok(())
    }

    /// Goes on by `seconds`. Without forces no component gains kinetic energy. A step that fails leaves the flow in the
    /// middle of it.
    ///
    /// # Errors
    /// If the pressure can't be found, if a velocity is no longer a number, or if `cancel` is raised.
    pub fn step(&mut self, seconds: f64, settings: &FlowSettings, cancel: &Cancel) -> Result<(), FlowError> {
        // What flows along must not diverge.
        if self.has_added {
            self.project()?;
        }
        let Self {
            fluid,
            velocity,
            dye,
            scratch,
            ..
        } = self;
        let mut allowed = self.speeds.take().unwrap_or_else(|| fluid.speeds(velocity));
        check_finite(&allowed)?;
        let steps = if self.last_step > 0.0 {
            seconds / self.last_step
        } else {
            0.0
        };
        self.last_step = seconds;
        advect(
            fluid,
            (self.pressure.total(), steps),
            velocity,
            dye,
            (seconds, settings.advection),
            scratch,
            cancel,
        )?;
        if !dye.is_empty() {
            let (room, _) = scratch.room[..4 * dye.len()].as_chunks_mut();
            conserve(fluid, &self.poured, dye, room);
        }
        cancel.check()?;
        if settings.has_force() {
            let before = fluid.speeds(velocity);
            pull(fluid, dye, settings.gravity, seconds, velocity);
            confine(fluid, settings.confinement, seconds, velocity);
            let after = fluid.speeds(velocity);
            check_finite(&after)?;
            for ((allowed, before), after) in allowed.iter_mut().zip(before).zip(after) {
                *allowed += (after - before).max(0.0);
            }
        }
        if settings.viscosity > 0.0 {
            let friction = self.friction.get_or_insert_with(|| Friction::of(fluid));
            friction.smooth(fluid, settings.viscosity * seconds, velocity);
        }
        let fastest = allowed.iter().copied().fold(0.0, f64::max);
        self.pressure.project(fluid, velocity, fastest, &mut scratch.room)?;
        self.speeds = Some(cap(fluid, &allowed, velocity));
        Ok(())
    }

    /// The velocity of each triangle of the surface, in world units per second.
    pub fn velocities(&self) -> Vec<DVec3> {
        let of = |given: usize| {
            let triangle = self.fluid.sheets.triangle(given);
            let ([x, y], own) = (self.fluid.axes(triangle), self.velocity[triangle]);
            x * own.x + y * own.y
        };
        (0..self.fluid.triangle_count())
            .into_par_iter()
            .with_min_len(CHUNK)
            .map(of)
            .collect()
    }

    /// The dye at each vertex of the surface: linear red, green and blue multiplied by the coverage, and the coverage,
    /// each from 0 to 1. A vertex at which the surface was cut has the mean of its sheets' dyes by area.
    pub fn dyes(&self) -> Vec<[f64; 4]> {
        let fluid = &self.fluid;
        let count = fluid.sheets.own_count();
        if self.dye.is_empty() {
            return vec![Dye::default(); count];
        }
        let mut dyes = self.dye[..count].to_vec();
        let mut masses = fluid.masses[..count].to_vec();
        for copy in count..self.dye.len() {
            let own = fluid.sheets.original(copy);
            let mass = fluid.masses[copy];
            masses[own] += mass;
            let share = if masses[own] > 0.0 { mass / masses[own] } else { 0.0 };
            dyes[own] = std::array::from_fn(|k| dyes[own][k] + share * (self.dye[copy][k] - dyes[own][k]));
        }
        dyes
    }

    /// The integral of the dye over the surface, in squared world units.
    pub fn dye_integral(&self) -> [f64; 4] {
        let mut total = Dye::default();
        for sum in integrals(&self.fluid, &self.dye) {
            total = std::array::from_fn(|k| total[k] + sum[k]);
        }
        total
    }

    /// Half the integral of the squared speed: the kinetic energy for a density of 1.
    pub fn kinetic_energy(&self) -> f64 {
        0.5 * self
            .fluid
            .speeds(&self.velocity)
            .iter()
            .map(|speed| speed * speed)
            .sum::<f64>()
    }

    /// The root of the integral of the velocity's squared divergence, in world units per second. After a step it is
    /// about 1e-15 of the root of twice the kinetic energy over the mean edge.
    pub fn divergence(&self) -> f64 {
        divergence_norm(&self.fluid, &self.velocity)
    }

    /// The mean length of an edge, in world units.
    pub fn mean_edge(&self) -> f64 {
        self.fluid.mean_edge
    }

    /// The number of vertices that were doubled where triangles don't meet as on a manifold: there the fluid of each
    /// sheet stays apart.
    pub fn cut_vertices(&self) -> usize {
        self.fluid.sheets.copies()
    }

    /// The number of entries that the Laplacian's factor stores, of eight bytes each.
    pub fn factor_len(&self) -> usize {
        self.pressure.factor_len()
    }
}
