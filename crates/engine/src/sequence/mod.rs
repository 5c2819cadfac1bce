//! Edits of a sequence of shapes with the same vertices and faces: every frame is bent on its own shape, by transforms
//! that follow its handles ([`pliant_editor::SequenceTimeline`]).
//!
//! Frames are read, solved, written and dropped, as many at a time as the pool has threads, so that a sequence need not
//! fit into memory. No frame depends on another one's solution.

mod bend;
mod cache;
mod folder;
mod followed;
mod footprints;
mod frame;
mod report;
mod run;

use std::path::{Path, PathBuf};
use std::time::Instant;

use pliant_deform::Budget;
use pliant_editor::Beginning;
use pliant_io::PointCacheFormat;
use pliant_mesh::WeldOptions;

use self::bend::{Bending, vertices_of_handles};
use self::cache::Cache;
use self::folder::Folder;
use self::followed::Followed;
pub use self::report::SequenceReport;
use self::run::{Run, Source, To};
use crate::EngineError;
use crate::apply::{check_bends, check_not_empty, order};
use crate::files::{Destination, OutputFolder, Staging, refuse_shared};
use crate::loading::load;
use crate::path_text::shown;
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
    let rest = first.model.rest();
    let (source, to, gap) = match kind {
        Kind::Folder { folder, output, .. } => (Source::Folder(folder.frames), To::Folder(output), folder.gap),
        Kind::Cache { format, to, .. } => (
            Source::Cache(Cache::of(job.frames, format, &first)?),
            To::File(to),
            None,
        ),
    };
    let in_edit = |source| EngineError::Edit {
        edit: job.edit_path.to_owned(),
        source,
    };
    let needed = edit.frames_with_places(source.count()).map_err(in_edit)?;
    let setup = edit.resolve(&first.model).map_err(in_edit)?;
    check_bends(&first.path, &first.model, &setup.method)?;
    let handles = vertices_of_handles(&setup);
    let footprints = edit.footprints_of_handles().map_err(in_edit)?;
    let followed = Followed::of(&needed, (&first, &rest, &source), (&handles, &footprints), watch)?;
    let timeline = followed.timeline(edit, &setup).map_err(in_edit)?;
    let footprints = followed.footprints(&footprints);
    let ordering = match needed.is_empty() {
        true => None,
        false => {
            let progress = watch.begin("ordering");
            order(&first.model, &setup, job.budget, &progress, &watch.cancel)?
        }
    };
    let bending = Bending {
        model: &first.model,
        setup: &setup,
        timeline: &timeline,
        footprints: &footprints,
        ordering: ordering.as_ref(),
        budget: job.budget,
        handles: &handles,
    };
    let mut report = SequenceReport {
        method: setup.method.name().to_owned(),
        vertices: rest.file_vertex_count,
        frames: source.count(),
        footprints: footprints.iter().map(|own| own.count).sum(),
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
    run.write(&to, report_to, begun, &mut report)?;
    Ok(report)
}

/// The kind of a sequence.
enum Kind {
    /// A folder of frames, the first of them, and the folder to write.
    Folder {
        folder: Folder,
        mesh: PathBuf,
        output: OutputFolder,
    },
    /// A point cache, its mesh, and the cache to write.
    Cache {
        format: PointCacheFormat,
        mesh: PathBuf,
        to: Destination,
    },
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
            return Ok(Self::Folder {
                mesh: folder.frames[0].clone(),
                folder,
                output: OutputFolder::of(job.output, ("FOLDER", job.frames))?,
            });
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
        refuse_shared(
            ("--output", job.output),
            [("FOLDER_OR_FILE", job.frames), ("--mesh", mesh)],
        )?;
        Ok(Self::Cache {
            format: own,
            mesh: mesh.to_owned(),
            to: Destination::of(job.output)?,
        })
    }

    /// The file whose vertices and faces all frames have.
    fn mesh(&self) -> &Path {
        let (Self::Folder { mesh, .. } | Self::Cache { mesh, .. }) = self;
        mesh
    }
}
