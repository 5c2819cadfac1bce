//! The frames of a flow that was played in the window: numbered files of the open model in its present shape.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use glam::DVec3;
use pliant_deform::Budget;
use pliant_editor::{Dye, FlowRecording};
use pliant_flow::FlowError;

use super::coloured_files::ColouredFiles;
use super::flowing::refused;
use super::refuse_format;
use crate::EngineError;
use crate::files::{Staged, Staging};
use crate::frames::{ExistingFrames, Frames, ROUNDING, checked_places, frame_count};
use crate::loading::Loaded;
use crate::watch::Watch;

/// The input of [`stage_played_flow`].
#[derive(Clone, Copy, Debug)]
pub struct PlayedFlow<'a> {
    /// The flow.
    pub recording: &'a FlowRecording,
    /// The file on whose surface it was played.
    pub loaded: &'a Loaded,
    /// The world position of each drawn vertex in all frames.
    pub positions: &'a [DVec3],
    /// The connected parts that are turned inside out, by their numbers.
    pub inside_out: &'a BTreeSet<u32>,
    /// A name that ends in `-####` before its extension, with the frame's number in place of the `#`s.
    pub output: &'a Path,
    /// The frames a second.
    pub fps: f64,
    /// Whether numbered files may replace others.
    pub frames: ExistingFrames,
    /// The memory that the Laplacian's factor may take.
    pub budget: Budget,
}

/// Frames of a flow that are ready to be written.
#[derive(Debug)]
pub struct StagedFlow {
    /// Their files.
    pub staged: Staged,
    /// Sentences that a person should know.
    pub warnings: Vec<String>,
}

/// The output for a name that a person has chosen: `-####` comes before its extension, unless it is there.
pub fn flow_frames_path(chosen: &Path) -> PathBuf {
    Frames::numbered(chosen)
}

/// Plays the flow again and prepares a file for each frame, from its start to its end. A frame between two steps has a
/// mixture of their colours. The last frame shows the end, even if the end comes less than a frame after the one before.
///
/// # Errors
/// A name or a format that can't have such frames, files that would be replaced, and any refusal of the flow or of a
/// file. Nothing is left behind then.
pub fn stage_played_flow(job: &PlayedFlow<'_>, watch: &Watch, staging: &Staging) -> Result<StagedFlow, EngineError> {
    refuse_format(job.output)?;
    let count = shown_frame_count(job.recording.seconds(), job.fps)?;
    let frames = Frames::of(job.output, count - 1);
    job.loaded
        .sources()
        .for_each(|(what, path)| watch.note_read(what, path));
    for place in checked_places(job.output, count)? {
        watch.refuse_outputs(&[("--output", &place)], None)?;
    }
    job.frames.check(&frames)?;
    let mut writer = FrameWriter {
        files: ColouredFiles::new(job.loaded, job.positions, job.inside_out, None, staging),
        frames,
        count,
        next: 0,
        frames_per_step: job.fps * job.recording.step_seconds(),
        before: Vec::new(),
        watch,
    };
    let progress = watch.begin("flowing");
    let steps = job.recording.steps();
    let binding = progress.part(0.0, 0.1);
    let played = job
        .recording
        .replay(job.budget, (&binding, &watch.cancel), |step, dyes| {
            writer.step(step, dyes, step == steps)?;
            progress.set(0.1 + 0.9 * (step as f32 / steps.max(1) as f32));
            Ok(())
        });
    played.map_err(|stop: Stop| match stop {
        Stop::Flow(error) => refused(&job.loaded.path, &job.loaded.model, error),
        Stop::Writing(error) => error,
    })?;
    let FrameWriter { files, frames, .. } = writer;
    let staged = files.staged.ok_or(EngineError::Interrupted)?;
    let mut warnings = files.warnings;
    warnings.extend(frames.left_after());
    Ok(StagedFlow { staged, warnings })
}

/// The number of frames whose last one is at the end or after it.
fn shown_frame_count(seconds: f64, fps: f64) -> Result<usize, EngineError> {
    let whole = frame_count(seconds, fps)?;
    let is_cut = seconds * fps - (whole - 1) as f64 > ROUNDING;
    Ok(whole + usize::from(is_cut))
}

/// The reason why frames are not written.
enum Stop {
    Flow(FlowError),
    Writing(EngineError),
}

impl From<FlowError> for Stop {
    fn from(error: FlowError) -> Self {
        Self::Flow(error)
    }
}

/// The frames, in order.
struct FrameWriter<'a> {
    files: ColouredFiles<'a>,
    frames: Frames,
    count: usize,
    /// The next frame.
    next: usize,
    frames_per_step: f64,
    /// The dye after the step before.
    before: Vec<Dye>,
    watch: &'a Watch,
}

impl FrameWriter<'_> {
    /// Writes the frames up to a step.
    fn step(&mut self, step: usize, dyes: &[Dye], is_last: bool) -> Result<(), Stop> {
        while self.next < self.count {
            // Its time in steps.
            let time = self.next as f64 / self.frames_per_step;
            if time > step as f64 && !is_last {
                break;
            }
            let share = (time - (step as f64 - 1.0)).clamp(0.0, 1.0) as f32;
            let mixed: Vec<[f64; 4]> = match self.before.is_empty() {
                true => dyes.iter().map(|dye| dye.map(f64::from)).collect(),
                false => {
                    let pairs = self.before.iter().zip(dyes);
                    pairs.map(|(before, dye)| mixed(*before, *dye, share)).collect()
                }
            };
            if let Some(place) = self.frames.at(self.next) {
                let written = self.files.write(&mixed, &place, self.watch);
                written.map_err(Stop::Writing)?;
            }
            self.next += 1;
        }
        self.before.clear();
        self.before.extend_from_slice(dyes);
        Ok(())
    }
}

/// A share of the way from one dye to another.
fn mixed(from: Dye, to: Dye, share: f32) -> [f64; 4] {
    std::array::from_fn(|k| f64::from(from[k] + share * (to[k] - from[k])))
}
