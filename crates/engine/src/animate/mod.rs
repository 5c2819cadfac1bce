//! Animations: an edit with keys over time, as numbered files, as a point cache or as morph targets of a glTF.
//!
//! Every frame is solved for the handles' transforms at its time, and starts from the same shape, so that a frame is the
//! same wherever a run begins.

mod kind;
mod report;
mod writer;

use std::time::Instant;

use glam::DVec3;
use pliant_deform::Bound;
use pliant_editor::{Dye, EditFile, Setup, Start, Timeline, sum_of_shapes};
use pliant_mesh::{Progress, SurfaceVertex};

use self::kind::Kind;
pub use self::kind::animation_path;
pub(crate) use self::kind::check_output;
pub use self::report::{AnimationReport, MorphReport};
pub(crate) use self::writer::{AnimationFiles, AnimationWriter, MovedVertices};
use crate::EngineError;
use crate::binding::{Prepared, check_bends, prepare};
use crate::edit_job::{EditJob, with_keys};
use crate::files::{NewFile, Staged, Staging};
use crate::flow::with_dye;
use crate::frames::{ExistingFrames, Frames, checked_places, frame_count};
use crate::loading::Loaded;
use crate::report::{FrameTimes, ms_since};
use crate::watch::Watch;

/// The [`Animate::tolerance`] of an animation that has no other.
pub const MORPH_TOLERANCE: f64 = 1e-5;

/// The input of [`animate`].
#[derive(Clone, Copy, Debug)]
pub struct Animate<'a> {
    /// The edit, which has keys, and its files. The output is a point cache (pc2, mdd), a glTF (glb, gltf), or a name
    /// that ends in `-####` before its extension, with the frame's number in place of the `#`s.
    pub job: EditJob<'a>,
    /// The name of the animation in a glTF; its morph targets have numbers after it.
    pub name: &'a str,
    /// The largest distance of a vertex from its place in a frame of a glTF, as a share of the diagonal of the shape's
    /// box, above 0.
    pub tolerance: f64,
    /// The frames a second.
    pub fps: f64,
    /// Whether numbered files may replace others.
    pub frames: ExistingFrames,
}

/// Solves every frame of an animation and writes it and the report, or nothing at all.
///
/// # Errors
/// Any refusal of the file, of the edit or of a frame. Nothing is written then.
pub fn animate(animation: &Animate<'_>, watch: &Watch, staging: &Staging) -> Result<AnimationReport, EngineError> {
    let job = &animation.job;
    Kind::of(job.output)?;
    let report_to = job.report_to()?;
    let (loaded, load_ms) = job.load(job.file, watch)?;
    let edit = job.edit_with_examples(&loaded, watch)?;
    let edit = with_keys(&edit)?;
    let animated = stage_animation(animation, &loaded, (edit, None), watch, staging)?;
    let report = AnimationReport {
        load_ms,
        ..animated.report
    };
    let mut staged = animated.staged;
    if let Some(to) = report_to {
        let text = report.to_json();
        let file = NewFile {
            to,
            bytes: text.as_bytes(),
        };
        staged = staged.and(staging.stage_watched(&[file], None, &Progress::new(), &watch.cancel)?);
    }
    loaded.refuse_changed(&staged)?;
    staged.commit()?;
    Ok(report)
}

/// An animation that is ready to be written.
#[derive(Debug)]
pub struct Animated {
    /// Its files.
    pub staged: Staged,
    /// Its course.
    pub report: AnimationReport,
}

/// Solves every frame of an animation of a file that was read already, for an edit that contains all that it needs, and
/// prepares its files. `dye` was kept as vertex colours, for each surface vertex. The job's own file and edit only give
/// their names.
///
/// # Errors
/// Any refusal of the output, of the edit or of a frame.
pub fn stage_animation(
    animation: &Animate<'_>,
    loaded: &Loaded,
    (edit, dye): (&EditFile, Option<&[Dye]>),
    watch: &Watch,
    staging: &Staging,
) -> Result<Animated, EngineError> {
    let job = &animation.job;
    let kind = Kind::of(job.output)?;
    let report_to = job.report_to()?;
    let model = &loaded.model;
    let in_edit = |source| job.refused(source);
    let setup = edit.resolve(model).map_err(in_edit)?;
    let timeline = edit.timeline(&setup).map_err(in_edit)?;
    check_bends(job.file, model, &setup.method)?;
    let count = frame_count(timeline.duration(), animation.fps)?;
    let frames = Frames::of(job.output, count - 1);
    loaded.sources().for_each(|(what, path)| watch.note_read(what, path));
    for place in checked_places(job.output, count)? {
        // Only a glTF comes back whole with the animation, so only that may replace FILE.
        let edited = matches!(kind, Kind::Morphs).then_some(job.file);
        job.refuse_outputs(&place, edited, watch)?;
    }
    animation.frames.check(&frames)?;
    let start = Instant::now();
    let moving = match is_at_rest(edit, &timeline) {
        true => None,
        false => Some(prepare(job.file, model, &setup, job.budget, watch)?),
    };
    let is_morph = matches!(kind, Kind::Morphs);
    let colours = dye
        .map(|dye| with_dye(loaded, dye, job.output, is_morph))
        .unwrap_or_default();
    let files = AnimationFiles {
        loaded,
        output: job.output,
        name: animation.name,
        tolerance: animation.tolerance,
        fps: animation.fps,
        times: None,
        holds: false,
        count,
        moved: MovedVertices::Surface,
        inside_out: &setup.inside_out,
        colours: colours.colours.as_deref(),
        beside: report_to.as_ref(),
    };
    let mut run = Run {
        animation,
        loaded,
        setup: &setup,
        timeline: &timeline,
        watch,
        solve_ms: Vec::with_capacity(count),
        report: AnimationReport {
            bind_ms: ms_since(start),
            ..AnimationReport::at_start(loaded, setup.method.name(), animation.fps)
        },
    };
    run.report.warnings.extend(colours.lost);
    run.report.warnings.extend(frames.left_after());
    let staged = run.write(AnimationWriter::new(files, watch, staging)?, moving, count)?;
    if watch.cancel.is_cancelled() {
        return Err(EngineError::Interrupted);
    }
    Ok(Animated {
        staged,
        report: run.finished(),
    })
}

/// Returns true if no frame moves anything.
fn is_at_rest(edit: &EditFile, timeline: &Timeline) -> bool {
    let mut keyed = edit.keys.iter().flat_map(|key| key.handles.values());
    let is_keyed = edit.keys.iter().any(|key| key.strength.is_some());
    let moves = !keyed.all(pliant_editor::HandleTransform::is_identity) || !timeline.keeps_curves_and_weights();
    match edit.strength == 0.0 && !is_keyed {
        true => edit.changes_nothing(),
        false => edit.changes_nothing_in_full() && !moves,
    }
}

/// An animation that is being solved.
struct Run<'a> {
    animation: &'a Animate<'a>,
    loaded: &'a Loaded,
    setup: &'a Setup,
    timeline: &'a Timeline,
    watch: &'a Watch,
    /// The time of each frame's solve.
    solve_ms: Vec<f64>,
    report: AnimationReport,
}

impl Run<'_> {
    /// Solves all frames and writes them.
    fn write(
        &mut self,
        mut writer: AnimationWriter<'_>,
        mut moving: Option<Prepared>,
        count: usize,
    ) -> Result<Staged, EngineError> {
        let progress = self.watch.begin("animating");
        for frame in 0..count {
            writer.push(&self.frame(moving.as_mut(), frame)?)?;
            progress.set((frame + 1) as f32 / count as f32);
        }
        if let Some(Prepared { bound, .. }) = &moving {
            self.report.warnings.extend(self.setup.worded(bound.warnings()));
        }
        drop(moving);
        let (staged, written) = writer.finish()?;
        self.report.save_ms = written.save_ms;
        self.report.morph = written.morph;
        for warning in written.warnings {
            if !self.report.warnings.contains(&warning) {
                self.report.warnings.push(warning);
            }
        }
        Ok(staged)
    }

    /// The displacement of each surface vertex in a frame.
    fn frame(&mut self, moving: Option<&mut Prepared>, frame: usize) -> Result<Vec<DVec3>, EngineError> {
        if self.watch.cancel.is_cancelled() {
            return Err(EngineError::Interrupted);
        }
        let Some(Prepared { bound, .. }) = moving else {
            return Ok(vec![DVec3::ZERO; self.loaded.model.surface.positions.len()]);
        };
        let start = Instant::now();
        let solved = self.solved(bound, frame as f64 / self.animation.fps);
        self.solve_ms.push(ms_since(start));
        solved
    }

    /// The displacement of each surface vertex at a time.
    fn solved(&mut self, bound: &mut Bound, time: f64) -> Result<Vec<DVec3>, EngineError> {
        let cancel = &self.watch.cancel;
        let start = match &self.setup.kept {
            Some(kept) => Start::Kept(kept.clone()),
            None => Start::Shape(std::sync::Arc::new(vec![DVec3::ZERO; bound.vertex_count()])),
        };
        bound.set_cancel(cancel);
        let targets = self.setup.targets_during(self.timeline, time);
        let bent = start.bend_anew(bound, &targets, cancel);
        let bent = bent.map_err(|error| EngineError::Solve {
            file: self.animation.job.file.to_owned(),
            source: error.renumbered(|vertex| self.loaded.model.first_file_vertex(SurfaceVertex(vertex)).0),
        })?;
        if cancel.is_cancelled() {
            return Err(EngineError::Interrupted);
        }
        self.report.unsettled_frames += usize::from(!bent.step.converged);
        let rest = self.setup.rest.as_ref().map(|rest| &rest.displacements);
        Ok(sum_of_shapes(rest, &bent.shown).to_vec())
    }

    /// The report, at the end.
    fn finished(mut self) -> AnimationReport {
        self.report.frames = FrameTimes::of(&mut self.solve_ms, &mut []);
        self.report.warnings.extend(match self.report.unsettled_frames {
            0 => None,
            1 => Some("1 frame did not settle within the step limit: take another method".to_owned()),
            count => Some(format!(
                "{count} frames did not settle within the step limit: take another method"
            )),
        });
        self.report
    }
}
