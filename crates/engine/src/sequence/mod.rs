//! Edits of a sequence of shapes with the same vertices and faces: every frame is bent on its own shape, by transforms
//! that follow its handles ([`pliant_editor::SequenceTimeline`]).
//!
//! Frames are read, solved, written and dropped, as many at a time as the pool has threads, so that a sequence need not
//! fit into memory. No frame depends on another one's solution.

mod bend;
mod cache;
mod folder;
mod frame;
mod report;
mod run;

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::time::Instant;

use pliant_deform::Budget;
use pliant_editor::{Beginning, EditFile, HandlePlace, Selector, SequenceTimeline, Setup};
use pliant_io::PointCacheFormat;
use pliant_mesh::{Drawn, Progress, SurfaceVertex, WeldOptions};
use rayon::prelude::*;

use self::bend::{Bending, place, vertices_of_handles};
use self::cache::Cache;
use self::folder::Folder;
use self::frame::Frame;
pub use self::report::SequenceReport;
use self::run::{Run, Source};
use crate::EngineError;
use crate::apply::{check_bends, check_not_empty, order};
use crate::files::{Destination, NewFile, OutputFolder, Share, Staging};
use crate::loading::{Loaded, load};
use crate::path_text::shown;
use crate::report::ms_since;
use crate::watch::Watch;

/// The input of [`sequence`].
#[derive(Clone, Copy, Debug)]
pub struct Sequence<'a> {
    /// The folder of the frames, or a point cache (pc2, mdd).
    pub frames: &'a Path,
    /// The mesh whose vertices a point cache moves.
    pub mesh: Option<&'a Path>,
    /// The edit, with keys at frames.
    pub edit: &'a Beginning,
    /// The place that the edit was read from, for messages.
    pub edit_path: &'a Path,
    /// The folder to write, in which frames keep their names; it is made if it is missing. For a point cache the cache to
    /// write, of the same kind.
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
    let kind = Kind::of(job)?;
    let weld = match job.weld {
        None => job.edit.weld_options(),
        distance => WeldOptions { distance },
    };
    let first = load(kind.mesh(), &weld, watch)?;
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
    let rest = first.model.rest();
    let (source, gap) = match kind {
        Kind::Folder(folder, _) => (Source::Folder(folder.frames), folder.gap),
        Kind::Cache { format, .. } => (Source::Cache(Cache::of(job.frames, format, &first)?), None),
    };
    let needed = edit.frames_with_places(source.count()).map_err(in_edit)?;
    let setup = edit.resolve(&first.model).map_err(in_edit)?;
    check_bends(&first.path, &first.model, &setup.method)?;
    let handles = vertices_of_handles(&setup);
    let timeline = timeline(edit, &setup, (&first, &rest, &source), &needed, &handles, watch)?.map_err(in_edit)?;
    let ordering = match needed.is_empty() {
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
    let mut report = SequenceReport {
        method: setup.method.name().to_owned(),
        vertices: rest.file_vertex_count,
        frames: source.count(),
        ..SequenceReport::default()
    };
    report.warn(first.scene.notes().iter().cloned().chain(gap));
    let run = Run {
        bending: &bending,
        first: &first,
        rest: &rest,
        source: &source,
        watch,
        staging,
    };
    let mut made = None;
    let mut staged = match &source {
        Source::Folder(frames) => {
            let output = OutputFolder::of(job.output, ("FOLDER", job.frames))?;
            made = Some(output.make(staging)?);
            // Alone, because frames may have neighbours, and for all frames at once.
            let held = staging.hold([(&output.inside(".frame")?, Share::Alone)], &watch.cancel)?;
            let staged = run.files(frames, &output, report_to.as_ref(), &mut report)?;
            staged.holding(held)
        }
        Source::Cache(cache) => run.cache(cache, &Destination::of(job.output)?, &mut report)?,
    };
    report.conclude(ms_since(begun));
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
    if let Some(made) = made {
        made.keep();
    }
    Ok(report)
}

/// The kind of a sequence.
enum Kind {
    /// A folder of frames, and the first of them.
    Folder(Folder, PathBuf),
    /// A point cache, and its mesh.
    Cache { format: PointCacheFormat, mesh: PathBuf },
}

impl Kind {
    fn of(job: &Sequence<'_>) -> Result<Self, EngineError> {
        let format = |path: &Path| PointCacheFormat::of_name(&path.to_string_lossy()).filter(|_| !path.is_dir());
        let Some(own) = format(job.frames) else {
            if job.mesh.is_some() {
                return Err(EngineError::Arguments(
                    "--mesh is for a point cache (.pc2 or .mdd), and frames in a folder need none: leave it out"
                        .to_owned(),
                ));
            }
            let folder = Folder::of(job.frames)?;
            let first = folder.frames[0].clone();
            return Ok(Self::Folder(folder, first));
        };
        if format(job.output) != Some(own) {
            return Err(EngineError::Arguments(format!(
                "--output {} must be a point cache of the same kind as {}: give it the same extension",
                shown(job.output),
                shown(job.frames)
            )));
        }
        let Some(mesh) = job.mesh else {
            return Err(EngineError::Arguments(format!(
                "{} holds only positions: give the mesh that it was made of as --mesh",
                shown(job.frames)
            )));
        };
        crate::files::refuse_shared(("--output", job.output), [("FILE", job.frames), ("--mesh", mesh)])?;
        Ok(Self::Cache {
            format: own,
            mesh: mesh.to_owned(),
        })
    }

    /// The file whose vertices and faces all frames have.
    fn mesh(&self) -> &Path {
        let (Self::Folder(_, mesh) | Self::Cache { mesh, .. }) = self;
        mesh
    }
}

/// The handles' motions by the keys and filters, which need the handles' places in the frames `needed`. The inner error is the edit's.
fn timeline(
    edit: &EditFile,
    setup: &Setup,
    (first, drawn, source): (&Loaded, &Drawn, &Source),
    needed: &[usize],
    handles: &[Vec<SurfaceVertex>],
    watch: &Watch,
) -> Result<Result<SequenceTimeline, pliant_editor::EditError>, EngineError> {
    let progress = watch.begin("following the handles");
    let rest = &first.model.surface.positions;
    let places_at = |positions: &[glam::DVec3]| -> Vec<HandlePlace> {
        handles
            .iter()
            .map(|vertices| place(vertices, rest, positions))
            .collect()
    };
    let places_in = |frame: usize| -> Result<(usize, Vec<HandlePlace>), EngineError> {
        watch.cancel.check().map_err(|_| EngineError::Interrupted)?;
        let positions = match source {
            Source::Folder(frames) => Frame::read(&frames[frame], first, drawn, watch)?.positions,
            Source::Cache(cache) => cache.frame(frame)?.positions,
        };
        Ok((frame, places_at(&positions)))
    };
    let mut places = BTreeMap::new();
    for group in needed.chunks(rayon::current_num_threads().max(1)) {
        let read: Vec<_> = group.par_iter().map(|frame| places_in(*frame)).collect();
        for read in read {
            let (frame, of_handles) = read?;
            places.insert(frame, of_handles);
        }
        progress.set(places.len() as f32 / needed.len() as f32);
    }
    Ok(edit.sequence_timeline(setup, &places_at(rest), |frame, handle| places[&frame][handle]))
}
