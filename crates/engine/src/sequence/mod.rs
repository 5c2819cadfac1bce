//! Edits of a sequence of shapes with the same vertices and faces: every frame is bent on its own shape, by transforms
//! that follow its handles ([`pliant_editor::SequenceTimeline`]).
//!
//! Frames are read, solved, written and dropped, as many at a time as the pool has threads, so that a sequence need not
//! fit into memory. No frame depends on another one's solution.

mod bend;
mod folder;
mod frame;
mod report;

use std::collections::BTreeMap;
use std::path::Path;
use std::time::Instant;

use pliant_deform::Budget;
use pliant_editor::{Beginning, EditFile, HandlePlace, Selector, SequenceTimeline, Setup};
use pliant_mesh::{Drawn, Progress, SurfaceVertex, WeldOptions};
use rayon::prelude::*;

use self::bend::{Bending, Bent, place, vertices_of_handles};
use self::folder::Folder;
use self::frame::Frame;
pub use self::report::SequenceReport;
use crate::EngineError;
use crate::apply::{check_bends, check_not_empty, order};
use crate::files::{Destination, NewFile, OutputFolder, Share, Staged, Staging};
use crate::loading::{Loaded, load};
use crate::path_text::shown;
use crate::report::ms_since;
use crate::saving::{self, Original, SaveAs};
use crate::watch::Watch;

/// The input of [`sequence`].
#[derive(Clone, Copy, Debug)]
pub struct Sequence<'a> {
    /// The folder of the frames.
    pub frames: &'a Path,
    /// The edit, with keys at frames.
    pub edit: &'a Beginning,
    /// The place that the edit was read from, for messages.
    pub edit_path: &'a Path,
    /// The folder to write, in which frames keep their names. It is made if it is missing.
    pub output: &'a Path,
    /// The file for the report, if one is wanted.
    pub report: Option<&'a Path>,
    /// The distance within which vertices of the first frame are joined, in world units; `None` is the edit's own.
    pub weld: Option<f64>,
    /// The memory that the binding of a frame may use.
    pub budget: Budget,
}

/// Bends the frames of a sequence and writes all of them and the report, or nothing at all.
///
/// # Errors
/// Any refusal of a frame, of the edit or of a result. Nothing is written then.
pub fn sequence(job: &Sequence<'_>, watch: &Watch, staging: &Staging) -> Result<SequenceReport, EngineError> {
    let begun = Instant::now();
    let report_to = job.report.map(Destination::of).transpose()?;
    let Beginning::Edit(edit) = job.edit else {
        return Err(EngineError::Arguments(
            "--edit: a project has no keys: save it as an edit and give that keys".to_owned(),
        ));
    };
    let folder = Folder::of(job.frames)?;
    let output = OutputFolder::of(job.output, ("FOLDER", job.frames))?;
    let weld = match job.weld {
        None => job.edit.weld_options(),
        distance => WeldOptions { distance },
    };
    let first = load(&folder.frames[0], &weld, watch)?;
    check_not_empty(&first.path, &first.model)?;
    let in_edit = |source| EngineError::Edit {
        edit: job.edit_path.to_owned(),
        source,
    };
    if edit.inside_out != Selector::None {
        let edit = shown(job.edit_path);
        return Err(EngineError::Unsupported(format!(
            "{edit}: a sequence does not turn parts inside out: remove `inside_out`, and turn them in each file"
        )));
    }
    let key_frames = edit.key_frames(folder.frames.len()).map_err(in_edit)?;
    let setup = edit.resolve(&first.model).map_err(in_edit)?;
    check_bends(&first.path, &first.model, &setup.method)?;
    let rest = first.model.rest();
    let handles = vertices_of_handles(&setup);
    let keyed = Keyed {
        edit,
        setup: &setup,
        first: &first,
        rest: &rest,
    };
    let timeline = keyed
        .timeline(&folder, &key_frames, &handles, watch)?
        .map_err(in_edit)?;
    let ordering = match key_frames.is_empty() {
        true => None,
        false => order(
            &first.model,
            &setup,
            job.budget,
            &watch.begin("ordering"),
            &watch.cancel,
        )?,
    };
    let bending = Bending {
        model: &first.model,
        setup: &setup,
        timeline: &timeline,
        ordering: ordering.as_ref(),
        budget: job.budget,
        handles: &handles,
    };
    let made = output.make(staging)?;
    // Alone, because frames may have neighbours, and for all frames at once.
    let held = staging.hold([(&output.inside(".frame")?, Share::Alone)], &watch.cancel)?;
    let mut report = SequenceReport {
        method: setup.method.name().to_owned(),
        vertices: rest.file_vertex_count,
        frames: folder.frames.len(),
        ..SequenceReport::default()
    };
    report.warn(first.scene.notes().iter().cloned().chain(folder.gap.clone()));
    let run = Run {
        bending: &bending,
        first: &first,
        rest: &rest,
        output: &output,
        watch,
        staging,
    };
    let mut staged = run.all(&folder, report_to.as_ref(), &mut report)?.holding(held);
    report.warn(unsettled(report.unsettled_frames));
    report.total_ms = ms_since(begun);
    if let Some(to) = report_to {
        let text = report.to_json();
        let file = NewFile {
            to,
            bytes: text.as_bytes(),
        };
        staged = staged.and(staging.stage_watched(&[file], None, &Progress::new(), &watch.cancel)?);
    }
    if watch.cancel.is_cancelled() {
        return Err(EngineError::Interrupted);
    }
    staged.commit()?;
    made.keep();
    Ok(report)
}

fn unsettled(count: usize) -> Option<String> {
    match count {
        0 => None,
        1 => Some("1 frame did not settle within the step limit: take another method".to_owned()),
        count => Some(format!(
            "{count} frames did not settle within the step limit: take another method"
        )),
    }
}

/// The edit's keys on the frames that have some.
struct Keyed<'a> {
    edit: &'a EditFile,
    setup: &'a Setup,
    first: &'a Loaded,
    rest: &'a Drawn,
}

impl Keyed<'_> {
    /// The handles' motions. The inner error is the edit's.
    fn timeline(
        &self,
        folder: &Folder,
        key_frames: &[usize],
        handles: &[Vec<SurfaceVertex>],
        watch: &Watch,
    ) -> Result<Result<SequenceTimeline, pliant_editor::EditError>, EngineError> {
        let progress = watch.begin("reading the frames with keys");
        let first = &self.first.model.surface.positions;
        let places_at = |positions: &[glam::DVec3]| -> Vec<HandlePlace> {
            handles
                .iter()
                .map(|vertices| place(vertices, first, positions))
                .collect()
        };
        let mut places: BTreeMap<usize, Vec<HandlePlace>> = BTreeMap::from([(0, places_at(first))]);
        for (done, &frame) in key_frames.iter().enumerate() {
            watch.cancel.check().map_err(|_| EngineError::Interrupted)?;
            let read = Frame::read(&folder.frames[frame], self.first, self.rest, watch)?;
            places.insert(frame, places_at(&read.positions));
            progress.set(done as f32 / key_frames.len() as f32);
        }
        Ok(self
            .edit
            .sequence_timeline(self.setup, |frame, handle| places[&frame][handle]))
    }
}

/// A sequence that is being written.
struct Run<'a> {
    bending: &'a Bending<'a>,
    first: &'a Loaded,
    rest: &'a Drawn,
    output: &'a OutputFolder,
    watch: &'a Watch,
    staging: &'a Staging,
}

/// A frame that is written beside its place.
struct Done {
    staged: Staged,
    bent: Option<Bent>,
    warnings: Vec<String>,
}

impl Run<'_> {
    /// All frames, side by side in groups as large as the pool.
    fn all(
        &self,
        folder: &Folder,
        beside: Option<&Destination>,
        report: &mut SequenceReport,
    ) -> Result<Staged, EngineError> {
        let progress = self.watch.begin("editing the sequence");
        let count = folder.frames.len();
        let numbered: Vec<(usize, &Path)> = folder.frames.iter().map(|path| &**path).enumerate().collect();
        let mut staged: Option<Staged> = None;
        for group in numbered.chunks(rayon::current_num_threads().max(1)) {
            let done = group.par_iter().map(|&(frame, path)| self.frame(frame, path, beside));
            let done: Vec<Result<Done, EngineError>> = done.collect();
            for done in done {
                // The first refusal in the order of frames, whatever the number of threads.
                let Done {
                    staged: frame,
                    bent,
                    warnings,
                } = done?;
                if let Some(bent) = bent {
                    report.bent_frames += 1;
                    report.unsettled_frames += usize::from(!bent.is_settled);
                    report.warn(bent.warnings);
                }
                report.warn(warnings);
                staged = Some(match staged {
                    Some(staged) => staged.and(frame),
                    None => frame,
                });
            }
            let last = group.last().map_or(0, |(frame, _)| frame + 1);
            progress.set(last as f32 / count as f32);
        }
        staged.ok_or(EngineError::Interrupted)
    }

    /// Reads, bends and stages a frame.
    fn frame(&self, frame: usize, path: &Path, beside: Option<&Destination>) -> Result<Done, EngineError> {
        let cancel = &self.watch.cancel;
        cancel.check().map_err(|_| EngineError::Interrupted)?;
        let read = Frame::read(path, self.first, self.rest, self.watch)?;
        let bent = self.bending.frame(frame, path, &read.positions, self.watch)?;
        let positions = match &bent {
            Some(bent) => read.displaced(&bent.displacements),
            None => read.file.drawn.positions.clone(),
        };
        let original = Original {
            path: &read.path,
            scene: &read.file.scene,
            drawn: &read.file.drawn,
            turned: &[],
        };
        let output = self.output.inside(path.file_name().unwrap_or_default())?;
        let save = SaveAs {
            beside: beside.map(|report| ("--report", report)),
            ..SaveAs::shape(&positions, &output.given)
        };
        let saved = saving::stage_of(&original, &save, self.staging, &Progress::new(), cancel)?;
        Ok(Done {
            staged: saved.staged,
            bent,
            warnings: saved.warnings,
        })
    }
}
