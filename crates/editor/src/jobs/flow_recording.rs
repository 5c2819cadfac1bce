//! A flow that was played, as its start and its moments, so that it can be played again.
//!
//! The colours of every step would take 16 bytes a vertex and step; the brushes and forces that acted take next to
//! nothing, and a flow from the same start gives the same bits.

use std::sync::Arc;

use glam::DVec3;
use pliant_deform::Budget;
use pliant_flow::{Flow, FlowError};
use pliant_mesh::{Cancel, Model, Progress};
use rayon::prelude::*;

use super::flow_moment::{FLOW_STEP, FlowMoment, begin_at, dyes};
use crate::document::{Dye, Fluid, over};

/// The most memory of the moments.
const MOST_BYTES: usize = 1 << 29;

/// A flow that was played.
#[derive(Clone, Debug)]
pub struct FlowRecording {
    model: Arc<Model>,
    /// The shape on which it was played; `None` is the file's.
    displacements: Option<Arc<Vec<DVec3>>>,
    start: Fluid,
    moments: Vec<FlowMoment>,
    /// The memory of the moments.
    bytes: usize,
}

impl FlowRecording {
    /// A recording without a moment.
    pub(crate) fn new(model: Arc<Model>, displacements: Option<Arc<Vec<DVec3>>>, start: Fluid) -> Self {
        Self {
            model,
            displacements,
            start,
            moments: Vec::new(),
            bytes: 0,
        }
    }

    /// Adds a moment; returns false if the recording would take too much memory.
    pub(crate) fn push(&mut self, moment: FlowMoment) -> bool {
        self.bytes += moment.bytes();
        self.moments.push(moment);
        self.bytes <= MOST_BYTES
    }

    /// The number of moments.
    pub(crate) fn len(&self) -> usize {
        self.moments.len()
    }

    /// Forgets all moments but the first `count`.
    pub(crate) fn truncate(&mut self, count: usize) {
        let forgotten = self.moments.drain(count.min(self.moments.len())..);
        self.bytes -= forgotten.map(|moment| moment.bytes()).sum::<usize>();
    }

    /// The number of steps.
    pub fn steps(&self) -> usize {
        self.moments.iter().map(|moment| moment.steps).sum()
    }

    /// Its length in seconds: its steps' sum.
    pub fn seconds(&self) -> f64 {
        self.steps() as f64 * FLOW_STEP
    }

    /// The length of a step in seconds.
    pub fn step_seconds(&self) -> f64 {
        FLOW_STEP
    }

    /// Plays the flow again. `each` gets the number of steps that were taken, from 0, and the dye of each surface vertex
    /// then, over the dye that was kept as vertex colours. They are the bits of the first time.
    ///
    /// # Errors
    /// Those of [`Flow::bind`] and [`Flow::step`], and of `each`.
    pub fn replay<E: From<FlowError>>(
        &self,
        budget: Budget,
        (progress, cancel): (&Progress, &Cancel),
        mut each: impl FnMut(usize, &[Dye]) -> Result<(), E>,
    ) -> Result<(), E> {
        let displacements = self.displacements.as_ref().map(|moved| moved.as_slice());
        let mut flow = Flow::bind_shape(&self.model, displacements, budget, progress, cancel)?;
        begin_at(&mut flow, &self.start);
        let kept = self.start.kept.as_ref().map(|kept| kept.as_slice());
        let shown = |flow: &Flow<'_>| with_kept(dyes(flow), kept);
        let vertex_count = self.model.surface.positions.len();
        let mut step = 0;
        each(step, &shown(&flow))?;
        for moment in &self.moments {
            moment.play(&mut flow, vertex_count, cancel, |flow| {
                step += 1;
                each(step, &shown(flow))
            })?;
        }
        Ok(())
    }
}

/// Dyes over the kept ones.
fn with_kept(mut dyes: Vec<Dye>, kept: Option<&[Dye]>) -> Vec<Dye> {
    if let Some(kept) = kept {
        let pairs = dyes.par_iter_mut().zip(kept);
        pairs.for_each(|(dye, kept)| *dye = over(*dye, *kept));
    }
    dyes
}
