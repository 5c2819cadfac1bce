//! A moment of a flow that plays: the brushes that act, the forces, and the steps that follow.

use std::sync::Arc;

use glam::DVec3;
use pliant_flow::{Advection, Flow, FlowError, FlowSettings};
use pliant_mesh::{Cancel, SurfaceVertex};
use rayon::prelude::*;

use crate::document::{Dye, FlowOptions, Fluid};

/// The length of a step, in seconds: a picture of a common screen.
pub(super) const FLOW_STEP: f64 = 1.0 / 60.0;

/// The fluid that a brush puts in place of the one under it.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(crate) enum Poured {
    /// Dye of this colour: linear red, green and blue.
    Dye([f64; 3]),
    /// Clear fluid.
    Clear,
}

/// The effect of a brush on a flow.
#[derive(Clone, PartialEq, Debug)]
pub(crate) struct Splash {
    /// The vertices under the brush, each with its share from 0 to 1.
    pub(crate) vertices: Vec<(SurfaceVertex, f64)>,
    /// The fluid that is poured, if any.
    pub(crate) poured: Option<Poured>,
    /// The velocity that the brush gives the fluid.
    pub(crate) velocity: Option<DVec3>,
}

/// A moment: the brushes act, then the steps follow.
#[derive(Clone, Debug)]
pub(crate) struct FlowMoment {
    pub(crate) splashes: Arc<[Splash]>,
    pub(crate) options: FlowOptions,
    pub(crate) steps: usize,
}

impl FlowMoment {
    /// Plays the moment; `after` gets the flow after each step.
    ///
    /// # Errors
    /// Those of a step, and of `after`.
    pub(super) fn play<E: From<FlowError>>(
        &self,
        flow: &mut Flow<'_>,
        vertex_count: usize,
        cancel: &Cancel,
        mut after: impl FnMut(&Flow<'_>) -> Result<(), E>,
    ) -> Result<(), E> {
        for splash in self.splashes.iter() {
            pour(flow, splash, vertex_count);
        }
        let settings = FlowSettings {
            gravity: self.options.gravity,
            viscosity: self.options.viscosity,
            confinement: self.options.confinement,
            advection: Advection::SecondOrder,
        };
        for _ in 0..self.steps {
            flow.step(FLOW_STEP, &settings, cancel)?;
            after(flow)?;
        }
        Ok(())
    }

    /// Its memory.
    pub(super) fn bytes(&self) -> usize {
        let of_splash = |splash: &Splash| size_of::<Splash>() + size_of_val(splash.vertices.as_slice());
        size_of::<Self>() + self.splashes.iter().map(of_splash).sum::<usize>()
    }
}

/// Takes a flow to a state.
pub(super) fn begin_at(flow: &mut Flow<'_>, start: &Fluid) {
    let velocity = |triangle: usize| {
        let velocity = start.velocity.as_ref().map_or([0.0; 3], |field| field[triangle]);
        DVec3::from_array(velocity.map(f64::from))
    };
    let dye = |vertex: usize| start.dye.as_ref().map_or([0.0; 4], |dye| dye[vertex]).map(f64::from);
    flow.set_state(velocity, dye);
}

/// The dye of each surface vertex, as documents keep it.
pub(super) fn dyes(flow: &Flow<'_>) -> Vec<Dye> {
    let dyes = flow.dyes().into_par_iter();
    dyes.map(|dye| dye.map(|value| value as f32)).collect()
}

fn pour(flow: &mut Flow<'_>, splash: &Splash, vertex_count: usize) {
    let mut shares = vec![0.0; vertex_count];
    splash
        .vertices
        .iter()
        .for_each(|(vertex, share)| shares[vertex.index()] = *share);
    match splash.poured {
        Some(Poured::Dye(colour)) => flow.pour(&shares, colour),
        Some(Poured::Clear) => flow.clear(&shares),
        None => {}
    }
    if let Some(velocity) = splash.velocity {
        flow.push(&shares, velocity);
    }
}
