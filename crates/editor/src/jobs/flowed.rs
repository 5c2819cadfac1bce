//! A flow on the shown shape, step by step: each step is a job, and the flow goes from one to the next.

use std::sync::Arc;

use glam::DVec3;
use pliant_flow::{Advection, Flow, FlowError, FlowSettings};
use pliant_mesh::{Cancel, Model, Progress, SurfaceVertex};
use rayon::prelude::*;

use super::allowance::Allowance;
use super::slot::{Unfinished, Work};
use crate::document::{Dye, FlowOptions, Fluid, dye_colour, over, round_velocities, rounded_dye};

/// The length of a step, in seconds: a picture of a common screen.
pub(crate) const FLOW_STEP: f64 = 1.0 / 60.0;

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

/// The input of a step.
pub(crate) struct FlowRequest {
    pub(crate) model: Arc<Model>,
    /// The bent shape's displacements, for a flow that is not bound yet; `None` is the file's shape.
    pub(crate) displacements: Option<Arc<Vec<DVec3>>>,
    /// The flow that goes on.
    pub(crate) flow: Option<Box<Flow<'static>>>,
    /// The state with which it begins, unless it is in this state.
    pub(crate) start: Option<Fluid>,
    /// The kept dye, which is shown under the other.
    pub(crate) kept: Option<Arc<Vec<Dye>>>,
    pub(crate) splashes: Vec<Splash>,
    pub(crate) options: FlowOptions,
    pub(crate) steps: usize,
    /// True if the state is wanted, and not only its colours.
    pub(crate) is_last: bool,
}

/// A flow after a step.
pub struct Flowed {
    pub(crate) flow: Box<Flow<'static>>,
    /// The colour of each surface vertex, sRGB with its coverage.
    pub(crate) colours: Arc<Vec<[u8; 4]>>,
    /// Its state, without kept dye, if that was wanted.
    pub(crate) fluid: Option<Fluid>,
}

/// The work of a request.
pub(super) fn flow_work(request: FlowRequest, allowance: Allowance) -> Work<Box<Flowed>> {
    Box::new(move |progress, cancel| {
        let model = Arc::clone(&request.model);
        flowed(request, allowance, progress, cancel)
            .map(Box::new)
            .map_err(|error| match error {
                FlowError::Cancelled(cancelled) => cancelled.into(),
                other => {
                    let of_file = other.renumbered(|vertex| model.first_file_vertex(SurfaceVertex(vertex)).0);
                    Unfinished::Failed(of_file.to_string())
                }
            })
    })
}

fn flowed(
    request: FlowRequest,
    allowance: Allowance,
    progress: &Progress,
    cancel: &Cancel,
) -> Result<Flowed, FlowError> {
    let mut flow = match request.flow {
        Some(flow) => flow,
        None => {
            let displacements = request.displacements.as_ref().map(|moved| moved.as_slice());
            let bound = Flow::bind_shape(&request.model, displacements, allowance.budget(), progress, cancel);
            Box::new(bound?)
        }
    };
    if let Some(start) = &request.start {
        begin_at(&mut flow, start);
    }
    for splash in &request.splashes {
        pour(&mut flow, splash, request.model.surface.positions.len());
    }
    let settings = FlowSettings {
        gravity: request.options.gravity,
        viscosity: request.options.viscosity,
        confinement: request.options.confinement,
        advection: Advection::SecondOrder,
    };
    for _ in 0..request.steps {
        flow.step(FLOW_STEP, &settings, cancel)?;
    }
    let dyes: Vec<Dye> = flow
        .dyes()
        .into_par_iter()
        .map(|dye| dye.map(|value| value as f32))
        .collect();
    let kept = |vertex: usize| request.kept.as_ref().map_or([0.0; 4], |kept| kept[vertex]);
    let colours = dyes
        .par_iter()
        .enumerate()
        .map(|(vertex, dye)| dye_colour(over(*dye, kept(vertex))));
    Ok(Flowed {
        colours: Arc::new(colours.collect()),
        fluid: request.is_last.then(|| state(&flow, dyes)),
        flow,
    })
}

/// Takes a flow to a state.
fn begin_at(flow: &mut Flow<'_>, start: &Fluid) {
    let velocity = |triangle: usize| {
        let velocity = start.velocity.as_ref().map_or([0.0; 3], |field| field[triangle]);
        DVec3::from_array(velocity.map(f64::from))
    };
    let dye = |vertex: usize| start.dye.as_ref().map_or([0.0; 4], |dye| dye[vertex]).map(f64::from);
    flow.set_state(velocity, dye);
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

/// The state of a flow with these dyes, rounded as history keeps it.
fn state(flow: &Flow<'_>, mut dyes: Vec<Dye>) -> Fluid {
    dyes.par_iter_mut().for_each(|dye| *dye = rounded_dye(*dye));
    let is_dyed = dyes.iter().any(|[.., coverage]| *coverage > 0.0);
    let velocities = flow.velocities();
    let moves = velocities.iter().any(|velocity| *velocity != DVec3::ZERO);
    let velocities = velocities.into_par_iter().map(|velocity| velocity.as_vec3().to_array());
    let mut velocities: Vec<[f32; 3]> = velocities.collect();
    round_velocities(&mut velocities);
    Fluid {
        dye: is_dyed.then(|| Arc::new(dyes)),
        velocity: moves.then(|| Arc::new(velocities)),
        kept: None,
    }
}
