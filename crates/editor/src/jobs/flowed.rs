//! A flow on the shown shape, step by step: each step is a job, and the flow goes from one to the next.

use std::sync::Arc;

use glam::DVec3;
use pliant_flow::{Flow, FlowError};
use pliant_mesh::{Cancel, Model, Progress, SurfaceVertex};
use rayon::prelude::*;

use super::allowance::Allowance;
use super::flow_moment::{FlowMoment, begin_at, dyes};
use super::slot::{Unfinished, Work};
use crate::document::{Dye, Fluid, dye_colour, over, round_velocities, rounded_dye};

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
    pub(crate) moment: FlowMoment,
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
    let vertex_count = request.model.surface.positions.len();
    request
        .moment
        .play(&mut flow, vertex_count, cancel, |_| Ok::<(), FlowError>(()))?;
    let dyes = dyes(&flow);
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
