//! The flow on the surface between the document and its jobs.

use std::sync::Arc;

use pliant_flow::Flow;

use crate::document::{Fluid, Version};
use crate::jobs::{FlowMoment, FlowRecording, Splash};
use crate::revision::Revision;

/// The flow between the document and its jobs.
#[derive(Default)]
pub(crate) struct FlowPlay {
    pub(super) phase: Phase,
    /// The flow after its last step, unless a job has it.
    pub(super) bound: Option<Bound>,
    /// The shape under the flow that a job has, and the stretch for which it has it.
    pub(super) lent: Option<(Ground, u64)>,
    /// The number of stretches that have ended.
    pub(super) stretches: u64,
    /// The colours during a stretch of play; `None` are those of the document.
    pub(super) colours: Option<Arc<Vec<[u8; 4]>>>,
    /// The brush's effects since the last step.
    pub(super) splashes: Vec<Splash>,
    /// Grows when the colours changed.
    pub(super) revision: u64,
    /// The stretches that followed each other, as long as nothing else changed the fluid.
    pub(super) recorded: Option<Recorded>,
}

/// A recording, and the part of it that led to the document's fluid.
pub(super) struct Recorded {
    pub(super) recording: FlowRecording,
    /// The number of moments up to the last end of a stretch.
    pub(super) ended: usize,
    /// The document's fluid at that end.
    pub(super) at: Version,
}

/// A flow that is ready for a step.
pub(super) struct Bound {
    pub(super) flow: Box<Flow<'static>>,
    pub(super) on: Ground,
    /// The document's fluid in whose state it is; `None` after a step in the middle of a stretch.
    pub(super) at: Option<Version>,
}

/// The model and the shape under a flow.
pub(super) type Ground = (Revision, Version);

/// A part of a stretch of play.
#[derive(Default)]
pub(super) enum Phase {
    #[default]
    Still,
    /// The next job is a step, the first one if the flag says so.
    Playing { is_first: bool },
    /// The next job gives the state, after as many steps.
    Ending { steps: usize, is_first: bool },
    /// The state that the history gets once nothing else is going on.
    Ended(Fluid),
}

impl FlowPlay {
    /// Returns true between play and pause.
    pub(crate) fn is_playing(&self) -> bool {
        matches!(self.phase, Phase::Playing { .. })
    }

    /// Returns true if no stretch has begun or is about to end.
    pub(crate) fn is_still(&self) -> bool {
        matches!(self.phase, Phase::Still)
    }

    /// The colour of each surface vertex during a stretch of play, sRGB with its coverage.
    pub(crate) fn colours(&self) -> Option<&[[u8; 4]]> {
        self.colours.as_ref().map(|colours| colours.as_slice())
    }

    /// Grows when the colours changed.
    pub(super) fn revision(&self) -> u64 {
        self.revision
    }

    /// The recording of the flow that led to this fluid of the document.
    pub(crate) fn recording(&self, at: Version) -> Option<&FlowRecording> {
        let recorded = self.recorded.as_ref()?;
        let is_whole = recorded.ended > 0 && recorded.ended == recorded.recording.len();
        (recorded.at == at && is_whole).then_some(&recorded.recording)
    }

    /// Records a moment, in the recording that begins with it or in the present one.
    pub(super) fn record(&mut self, begun: Option<Recorded>, moment: FlowMoment) {
        self.recorded = begun.or(self.recorded.take());
        let has_room = self.recorded.as_mut().map(|recorded| recorded.recording.push(moment));
        if has_room == Some(false) {
            self.recorded = None;
        }
    }

    /// Forgets a recording that did not lead to this fluid of the document, and its start.
    pub(super) fn forget_recording_unless(&mut self, at: Version) {
        if self.recorded.as_ref().is_some_and(|recorded| recorded.at != at) {
            self.recorded = None;
        }
    }

    /// Ends a stretch without a trace.
    pub(super) fn drop_stretch(&mut self) {
        if let Some(recorded) = &mut self.recorded {
            recorded.recording.truncate(recorded.ended);
        }
        self.phase = Phase::Still;
        self.stretches += 1;
        self.splashes.clear();
        if self.colours.take().is_some() {
            self.revision += 1;
        }
    }

    /// Another file: nothing flows there yet.
    pub(super) fn reset(&mut self) {
        self.drop_stretch();
        (self.bound, self.lent, self.recorded) = (None, None, None);
    }
}
