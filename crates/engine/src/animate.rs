//! Animations: an edit with keys over time, as numbered files or as a point cache.
//!
//! Every frame is solved for the handles' transforms at its time, and starts from the same shape, so that a frame is the
//! same wherever a run begins.

use std::path::Path;

use glam::DVec3;
use pliant_deform::{Bound, Budget};
use pliant_editor::{Beginning, EditFile, Setup, Start, Timeline, Until, sum_of_shapes};
use pliant_io::{Format, PointCache, PointCacheFormat};
use pliant_mesh::{DrawnVertex, Model, Progress, SurfaceVertex, WeldOptions};

use crate::EngineError;
use crate::apply::{Prepared, check_bends, check_not_empty, prepare};
use crate::examples;
use crate::files::{Destination, NewFile, Staged, Staging};
use crate::frames::Frames;
use crate::loading::{Loaded, load};
use crate::saving::{self, SaveAs};
use crate::watch::Watch;

/// The most frames of an animation: more than an hour at 24 frames a second.
const MOST_FRAMES: f64 = 100_000.0;

/// A time this many frames before a whole frame still counts as that frame.
const ROUNDING: f64 = 1e-6;

/// The input of [`animate`].
#[derive(Clone, Copy, Debug)]
pub struct Animate<'a> {
    /// The file to bend.
    pub file: &'a Path,
    /// The edit, with keys.
    pub edit: &'a Beginning,
    /// The place that the edit was read from, for messages.
    pub edit_path: &'a Path,
    /// The files to write: a point cache (pc2, mdd), or a name that ends in `-####` before its extension, with the
    /// frame's number in place of the `#`s.
    pub output: &'a Path,
    /// The frames a second.
    pub fps: f64,
    /// The distance within which vertices of the file are joined, in world units; `None` is the edit's own.
    pub weld: Option<f64>,
    /// The memory that binding may use.
    pub budget: Budget,
}

/// Solves every frame of an animation and writes it, or nothing at all. Returns warnings.
///
/// # Errors
/// Any refusal of the file, of the edit or of a frame. Nothing is written then.
pub fn animate(job: &Animate<'_>, watch: &Watch, staging: &Staging) -> Result<Vec<String>, EngineError> {
    let kind = Kind::of(job.output)?;
    let weld = match job.weld {
        None => job.edit.weld_options(),
        distance => WeldOptions { distance },
    };
    let loaded = load(job.file, &weld, watch)?;
    let model = &loaded.model;
    check_not_empty(job.file, model)?;
    let mut edit = job.edit.clone();
    examples::bring(&mut edit, job.edit_path, &loaded, watch)?;
    let in_edit = |source| EngineError::Edit {
        edit: job.edit_path.to_owned(),
        source,
    };
    let Beginning::Edit(edit) = &edit else {
        return Err(EngineError::Arguments(
            "--edit: a project has no keys: save it as an edit and give that keys".to_owned(),
        ));
    };
    let setup = edit.resolve(model).map_err(in_edit)?;
    let timeline = edit.timeline(&setup).map_err(in_edit)?;
    check_bends(job.file, model, &setup.method)?;
    let count = frame_count(timeline.duration(), job.fps)?;
    let frames = Frames::of(job.output, count - 1);
    for place in frames.all() {
        Destination::of(&place)?;
        watch.refuse_outputs(&[("--output", &place)], None)?;
    }
    let moving = match is_at_rest(edit) {
        true => None,
        false => Some(prepare(job.file, model, &setup, job.budget, watch)?),
    };
    let mut run = Run {
        job,
        loaded: &loaded,
        setup: &setup,
        timeline: &timeline,
        watch,
        warnings: loaded.scene.notes().to_vec(),
        unsettled: 0,
    };
    let staged = match kind {
        Kind::Cache(format) => run.cache(moving, format, count, staging)?,
        Kind::Files => run.files(moving, &frames, staging)?,
    };
    if watch.cancel.is_cancelled() {
        return Err(EngineError::Interrupted);
    }
    let warnings = run.all_warnings();
    if let Some(staged) = staged {
        loaded.refuse_changed(&staged)?;
        staged.commit()?;
    }
    Ok(warnings)
}

/// The kind of an output.
enum Kind {
    Cache(PointCacheFormat),
    /// A file for each frame.
    Files,
}

impl Kind {
    fn of(output: &Path) -> Result<Self, EngineError> {
        let name = output.to_string_lossy();
        if let Some(format) = PointCacheFormat::of_name(&name) {
            return Ok(Self::Cache(format));
        }
        Format::of_name(&name).map_err(|error| EngineError::Arguments(format!("--output: {error}")))?;
        match Frames::of(output, 1) {
            Frames::Each { .. } => Ok(Self::Files),
            Frames::Last(..) => Err(EngineError::Arguments(format!(
                "--output {name} is one file: end its name in -#### for numbered files, or write a .pc2 or .mdd cache"
            ))),
        }
    }
}

/// The number of frames up to a time, both ends included.
fn frame_count(duration: f64, fps: f64) -> Result<usize, EngineError> {
    let last = (duration * fps + ROUNDING).floor();
    if last >= MOST_FRAMES {
        return Err(EngineError::Arguments(format!(
            "--fps {fps} gives {last} frames, more than {MOST_FRAMES}: lower it, or the times of the keys"
        )));
    }
    Ok(last as usize + 1)
}

/// Returns true if no frame moves anything.
fn is_at_rest(edit: &EditFile) -> bool {
    let mut keyed = edit.keys.iter().flat_map(|key| key.handles.values());
    edit.changes_nothing() && (edit.strength == 0.0 || keyed.all(pliant_editor::HandleTransform::is_identity))
}

/// An animation that is being written.
struct Run<'a> {
    job: &'a Animate<'a>,
    loaded: &'a Loaded,
    setup: &'a Setup,
    timeline: &'a Timeline,
    watch: &'a Watch,
    warnings: Vec<String>,
    /// The number of frames that did not settle.
    unsettled: usize,
}

impl Run<'_> {
    fn model(&self) -> &Model {
        &self.loaded.model
    }

    /// Writes a file for each frame.
    fn files(
        &mut self,
        mut moving: Option<Prepared>,
        frames: &Frames,
        staging: &Staging,
    ) -> Result<Option<Staged>, EngineError> {
        let mut staged: Option<Staged> = None;
        let count = frames.all().count();
        let progress = self.watch.begin("animating");
        for (frame, place) in frames.all().enumerate() {
            let positions = self.frame(moving.as_mut(), frame)?;
            let save = SaveAs {
                inside_out: &self.setup.inside_out,
                ..SaveAs::shape(&positions, &place)
            };
            let saved = saving::stage(self.loaded, &save, staging, &Progress::new(), &self.watch.cancel)?;
            for warning in saved.warnings {
                if !self.warnings.contains(&warning) {
                    self.warnings.push(warning);
                }
            }
            staged = Some(match staged {
                Some(staged) => staged.and(saved.staged),
                None => saved.staged,
            });
            progress.set((frame + 1) as f32 / count as f32);
        }
        self.warn_of(moving.as_ref());
        Ok(staged)
    }

    /// Writes a point cache of the file's vertices.
    fn cache(
        &mut self,
        mut moving: Option<Prepared>,
        format: PointCacheFormat,
        count: usize,
        staging: &Staging,
    ) -> Result<Option<Staged>, EngineError> {
        let drawn = &self.model().drawn;
        // A vertex of the file that is seen through several nodes is at the first of its places.
        let mut shown_at = vec![None; drawn.file_vertex_count()];
        for (vertex, file_vertex) in (0..).zip(drawn.file_vertices()) {
            shown_at[file_vertex.index()].get_or_insert(DrawnVertex(vertex));
        }
        let points = u32::try_from(shown_at.len()).unwrap_or(u32::MAX);
        let mut cache = PointCache::new(format, count as u32, points, self.job.fps);
        let progress = self.watch.begin("animating");
        for frame in 0..count {
            let positions = self.frame(moving.as_mut(), frame)?;
            let place = |shown: &Option<DrawnVertex>| shown.map_or(DVec3::ZERO, |vertex| positions[vertex.index()]);
            cache.push(shown_at.iter().map(place));
            progress.set((frame + 1) as f32 / count as f32);
        }
        self.warn_of(moving.as_ref());
        let file = NewFile {
            to: Destination::of(self.job.output)?,
            bytes: &cache.into_bytes(),
        };
        staging
            .stage_watched(&[file], None, &Progress::new(), &self.watch.cancel)
            .map(Some)
    }

    /// The position of each drawn vertex in a frame.
    fn frame(&mut self, moving: Option<&mut Prepared>, frame: usize) -> Result<Vec<DVec3>, EngineError> {
        if self.watch.cancel.is_cancelled() {
            return Err(EngineError::Interrupted);
        }
        let Some(Prepared { bound, .. }) = moving else {
            return Ok(self.model().rest_positions());
        };
        let time = frame as f64 / self.job.fps;
        let shown = self.solved(bound, time)?;
        let mut positions = Vec::new();
        self.model().drawn_positions(&shown, &mut positions);
        Ok(positions)
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
        let bent = start.bend(bound, &targets, Until::End, cancel);
        let bent = bent.map_err(|error| EngineError::Solve {
            file: self.job.file.to_owned(),
            source: error.renumbered(|vertex| self.loaded.model.first_file_vertex(SurfaceVertex(vertex)).0),
        })?;
        if cancel.is_cancelled() {
            return Err(EngineError::Interrupted);
        }
        self.unsettled += usize::from(!bent.step.converged);
        let rest = self.setup.rest.as_ref().map(|rest| &rest.displacements);
        Ok(sum_of_shapes(rest, &bent.shown).to_vec())
    }

    /// Notes the warnings of the binding.
    fn warn_of(&mut self, moving: Option<&Prepared>) {
        if let Some(Prepared { bound, .. }) = moving {
            self.warnings.extend(self.setup.worded(bound.warnings()));
        }
    }

    /// The warnings, at the end.
    fn all_warnings(self) -> Vec<String> {
        let unsettled = match self.unsettled {
            0 => None,
            1 => Some("1 frame did not settle within the step limit: take another method".to_owned()),
            count => Some(format!(
                "{count} frames did not settle within the step limit: take another method"
            )),
        };
        self.warnings.into_iter().chain(unsettled).collect()
    }
}
