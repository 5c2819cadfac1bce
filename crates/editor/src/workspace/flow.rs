//! The flow on the surface: played, paused, taken a step, poured into, kept as colours.
//!
//! While it plays, the flow is outside the document: a step of it is a job, which shows new colours. A stretch of play
//! ends with a last job that gives the fluid's state, which then becomes one step of the history. So other edits in the
//! meantime have their own steps, and a stretch that is undone before its end leaves no trace.

use std::sync::Arc;

use super::flow_play::{Bound, Phase, Recorded};
use super::state::Workspace;
use crate::document::{Aspect, FlowOptions, Fluid};
use crate::jobs::{FlowMoment, FlowRecording, FlowRequest, JobKind, Splash};

/// The person's actions.
impl Workspace {
    /// Begins to play, or pauses.
    pub(crate) fn play_or_pause_flow(&mut self) {
        self.flow.phase = match std::mem::take(&mut self.flow.phase) {
            Phase::Still => Phase::Playing { is_first: true },
            Phase::Playing { is_first } => Phase::Ending { steps: 0, is_first },
            ending => ending,
        };
    }

    /// Pauses, if the flow plays.
    pub(crate) fn pause_flow(&mut self) {
        if self.flow.is_playing() {
            self.play_or_pause_flow();
        }
    }

    /// Takes one step.
    pub(crate) fn step_flow(&mut self) {
        if self.flow.is_still() {
            self.flow.phase = Phase::Ending {
                steps: 1,
                is_first: true,
            };
        }
    }

    /// Lets a brush act on the playing flow, before its next step.
    pub(crate) fn splash(&mut self, splash: Splash) {
        self.flow.splashes.push(splash);
    }

    /// Chooses the forces.
    pub(crate) fn set_flow_options(&mut self, options: FlowOptions) {
        if options.are_usable() {
            self.change("Change flow", |document| document.set_flow_options(options));
        }
    }

    /// Makes the dye vertex colours, and the fluid clear.
    pub(crate) fn keep_dye(&mut self) {
        let fluid = self.document.fluid().with_dye_kept();
        self.change("Keep as vertex colours", |document| document.set_fluid(fluid));
    }

    /// Makes the fluid clear, and stops it.
    pub(crate) fn clear_fluid(&mut self) {
        let fluid = Fluid {
            kept: self.document.fluid().kept.clone(),
            ..Fluid::default()
        };
        self.change("Clear dye", |document| document.set_fluid(fluid));
    }

    /// Forgets the dye that was kept as vertex colours.
    pub(crate) fn forget_kept_dye(&mut self) {
        let fluid = Fluid {
            kept: None,
            ..self.document.fluid().clone()
        };
        self.change("Remove vertex colours", |document| document.set_fluid(fluid));
    }

    /// Stops the computation of the flow: a flow that is being prepared is given up, another one pauses after its step.
    pub(crate) fn stop_flow(&mut self) {
        if self.flow.colours.is_some() {
            self.pause_flow();
        } else if !self.flow.is_still() {
            self.jobs.stop_asking(|slots| &mut slots.flow);
            self.flow.drop_stretch();
        }
    }
}

/// The jobs.
impl Workspace {
    /// Requests the next job of the flow, or ends a stretch: `is_idle` says that no gesture holds the document.
    pub(crate) fn follow_flow(&mut self, is_idle: bool) {
        self.flow
            .forget_recording_unless(self.document.versions().of(Aspect::Fluid));
        if let Phase::Ended(fluid) = &self.flow.phase {
            if is_idle && !self.is_adjusting() {
                let fluid = fluid.clone();
                self.end_stretch(fluid);
            }
            return;
        }
        if self.flow.is_still() || self.jobs.is_busy(JobKind::Flow) {
            return;
        }
        self.request_flow();
    }

    fn request_flow(&mut self) {
        let Some(model) = self.model().cloned() else { return };
        let versions = self.document.versions();
        let (at, mut on) = (
            versions.of(Aspect::Fluid),
            (self.jobs.model_revision(), versions.of(Aspect::Drawn)),
        );
        let (steps, is_last, is_first) = match self.flow.phase {
            Phase::Playing { is_first } => (1, false, is_first),
            Phase::Ending { steps, is_first } => (steps, true, is_first),
            Phase::Still | Phase::Ended(_) => return,
        };
        // During a stretch the fluid stays on the shape of its beginning.
        let bound = self.flow.bound.take().filter(|bound| !is_first || bound.on == on);
        let goes_on = self.flow.recorded.as_ref().is_some_and(|recorded| recorded.at == at);
        // A recording begins with the document's fluid, which is rounded, and so must the flow.
        let is_there = bound
            .as_ref()
            .is_some_and(|bound| !is_first || (goes_on && bound.at == Some(at)));
        if let Some(bound) = &bound {
            on = bound.on;
        }
        let is_bent = self.document.is_displaced() || self.document.is_applied();
        let displacements = is_bent.then(|| Arc::clone(self.document.from_file()));
        let fluid = self.document.fluid();
        let moment = FlowMoment {
            splashes: std::mem::take(&mut self.flow.splashes).into(),
            options: *self.document.flow_options(),
            steps,
        };
        let begun = (is_first && !is_there).then(|| Recorded {
            recording: FlowRecording::new(Arc::clone(&model), displacements.clone(), fluid.clone()),
            ended: 0,
            at,
        });
        let request = FlowRequest {
            model,
            displacements,
            start: (!is_there).then(|| fluid.clone()),
            kept: fluid.kept.clone(),
            flow: bound.map(|bound| bound.flow),
            moment: moment.clone(),
            is_last,
        };
        self.flow.record(begun, moment);
        self.flow.lent = Some((on, self.flow.stretches));
        match &mut self.flow.phase {
            Phase::Playing { is_first } | Phase::Ending { is_first, .. } => *is_first = false,
            Phase::Still | Phase::Ended(_) => {}
        }
        self.jobs.flow(request);
    }

    /// A job of the flow has ended, perhaps without a result.
    pub(crate) fn take_flowed(&mut self) {
        let Some(flowed) = self.jobs.computed.slots.flow.take() else {
            // It failed, or was stopped.
            if !self.jobs.is_busy(JobKind::Flow) {
                self.flow.drop_stretch();
            }
            return;
        };
        let Some((on, stretch)) = self.flow.lent.take() else {
            return;
        };
        self.flow.bound = Some(Bound {
            flow: flowed.flow,
            on,
            at: None,
        });
        if stretch != self.flow.stretches {
            return;
        }
        self.flow.colours = Some(flowed.colours);
        self.flow.revision += 1;
        if let Some(fluid) = flowed.fluid {
            self.flow.phase = Phase::Ended(fluid);
        }
    }

    /// Makes a stretch of play a step of the history.
    fn end_stretch(&mut self, fluid: Fluid) {
        let kept = self.document.fluid().kept.clone();
        if let Some(recorded) = &mut self.flow.recorded {
            recorded.ended = recorded.recording.len();
        }
        self.flow.drop_stretch();
        self.change("Flow", |document| document.set_fluid(Fluid { kept, ..fluid }));
        let at = self.document.versions().of(Aspect::Fluid);
        if let Some(bound) = &mut self.flow.bound {
            bound.at = Some(at);
        }
        if let Some(recorded) = &mut self.flow.recorded {
            recorded.at = at;
        }
    }
}
