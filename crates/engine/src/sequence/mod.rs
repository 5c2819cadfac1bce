//! Edits of a sequence of shapes with the same vertices and faces: every frame is bent on its own shape, by transforms
//! that follow its handles ([`pliant_editor::SequenceTimeline`]).
//!
//! Frames are read, solved, written and dropped, as many at a time as the pool has threads, so that a sequence need not
//! fit into memory. No frame depends on another one's solution.

mod applied;
mod bend;
mod bent;
mod cache;
mod folder;
mod followed;
mod frame;
mod frame_times;
mod held;
mod kind;
mod leaders;
mod leading;
mod morphs;
mod open;
mod report;
mod run;
mod side_by_side;
mod source;

use std::collections::BTreeSet;
use std::path::Path;
use std::time::Instant;

use self::bend::{Bending, vertices_of_handles};
use self::cache::Cache;
use self::followed::{Followed, Handles};
use self::held::HeldShapes;
use self::kind::Kind;
use self::leading::leading_sequence;
use self::morphs::Morphs;
pub use self::open::OpenSequence;
pub use self::report::SequenceReport;
use self::run::{Run, To};
use self::source::Source;
use crate::EngineError;
use crate::animate::{AnimationFiles, MORPH_TOLERANCE, MovedVertices};
use crate::binding::{check_bends, order};
use crate::edit_job::{EditJob, with_keys};
use crate::files::Staging;
use crate::frames::{ExistingFrames, Frames, checked_places};
use crate::loading::Loaded;
use crate::watch::Watch;

/// The input of [`sequence`].
#[derive(Clone, Copy, Debug)]
pub struct Sequence<'a> {
    /// The edit, which has keys at frames, and its files. The output is the folder to write, in which frames keep their
    /// names; it is made if it is missing. For a point cache it is the cache to write, of the same kind. For a glTF it is
    /// an animation: a glTF, a point cache, or numbered files.
    pub job: EditJob<'a>,
    /// The mesh whose vertices a point cache moves.
    pub mesh: Option<&'a Path>,
    /// The frames a second of a glTF's animation; without them every key of the animation is a frame.
    pub fps: Option<f64>,
    /// The name of the animation in a written glTF.
    pub name: &'a str,
    /// Whether numbered files of a glTF's animation may replace others.
    pub frames: ExistingFrames,
}

/// Bends the frames of a sequence and writes all of them and the report, or nothing at all.
///
/// # Errors
/// Any refusal of a frame, of the edit or of a result. Nothing is written then.
pub fn sequence(sequence: &Sequence<'_>, watch: &Watch, staging: &Staging) -> Result<SequenceReport, EngineError> {
    let begun = Instant::now();
    let job = &sequence.job;
    let report_to = job.report_to()?;
    let edit = with_keys(job.edit)?;
    let kind = Kind::of(job, sequence.mesh)?;
    let (first, _) = job.load(kind.mesh(), watch)?;
    let rest = first.model.rest();
    let times: Vec<f64>;
    let (source, to, note) = match kind {
        Kind::Folder { folder, output, .. } => (Source::Folder(folder.frames), To::Folder(output), folder.gap),
        Kind::Cache { format, to, .. } => (Source::Cache(Cache::of(job.file, format, &first)?), To::File(to), None),
        Kind::Animation { .. } => {
            let morphs = Morphs::of(&first, sequence.fps, watch)?;
            morphs.check_steady(job.output)?;
            times = morphs.times().to_vec();
            let files = AnimationFiles {
                holds: morphs.holds(),
                ..sequence.animation_files(&first, (&times, morphs.fps()), watch)?
            };
            let choice = morphs.choice();
            (Source::Morphs(morphs), To::Animation(files), choice)
        }
    };
    let in_edit = |source| job.refused(source);
    let needed = edit.frames_with_places(source.count()).map_err(in_edit)?;
    let setup = edit.resolve(&first.model).map_err(in_edit)?;
    check_bends(&first.path, &first.model, &setup.method)?;
    let handles = vertices_of_handles(&setup);
    let footprints = edit.footprints_of_handles().map_err(in_edit)?;
    let led = edit.led_handles().map_err(in_edit)?;
    let other = leading_sequence(job, edit, (&first, source.count()))?;
    let ways = Handles {
        vertices: &handles,
        path: edit.part_of_path().map_err(in_edit)?,
        led: &led,
    };
    let sources = (&source, other.as_ref());
    let followed = Followed::of(&needed, (&first, &rest), sources, (edit, &ways), watch)?;
    let timeline = followed.timeline(edit, &setup, &led).map_err(in_edit)?;
    let footprints = followed.footprints(&footprints);
    // A path alone bends nothing.
    let may_bend = !footprints.is_empty() || (0..source.count()).any(|frame| timeline.reaches(frame));
    let ordering = match may_bend {
        false => None,
        true => {
            let progress = watch.begin("ordering");
            order(&first.model, &setup, job.budget, &progress, &watch.cancel)?
        }
    };
    let held_shapes = HeldShapes::of(&footprints, &handles, &source, (&first, &rest));
    let bending = Bending {
        model: &first.model,
        setup: &setup,
        timeline: &timeline,
        footprints: &footprints,
        held_shapes: &held_shapes,
        ordering: ordering.as_ref(),
        budget: job.budget,
        handles: &handles,
        body: &followed.body,
    };
    let mut report = SequenceReport {
        method: setup.method.name().to_owned(),
        vertices: rest.file_vertex_count,
        frames: source.count(),
        footprints: footprints.iter().map(|own| own.footprints.count()).sum(),
        ..SequenceReport::default()
    };
    report.warn(first.scene.notes().iter().cloned().chain(note));
    let run = Run {
        bending: &bending,
        first: &first,
        rest: &rest,
        source: &source,
        watch,
        staging,
    };
    run.write(&to, report_to, begun, &mut report)?;
    Ok(report)
}

impl Sequence<'_> {
    /// The animation to write for a glTF with these frames.
    fn animation_files<'b>(
        &'b self,
        loaded: &'b Loaded,
        (times, fps): (&'b [f64], f64),
        watch: &Watch,
    ) -> Result<AnimationFiles<'b>, EngineError> {
        let count = times.len();
        loaded.sources().for_each(|(what, path)| watch.note_read(what, path));
        for place in checked_places(self.job.output, count)? {
            self.job.refuse_outputs(&place, None, watch)?;
        }
        self.frames
            .check(&Frames::of(self.job.output, count.saturating_sub(1)))?;
        Ok(AnimationFiles {
            loaded,
            output: self.job.output,
            name: self.name,
            tolerance: MORPH_TOLERANCE,
            fps,
            count,
            times: Some(times),
            holds: false,
            moved: MovedVertices::Drawn,
            inside_out: const { &BTreeSet::new() },
            colours: None,
            beside: None,
        })
    }
}
