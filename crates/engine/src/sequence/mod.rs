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
mod leading;
mod morphs;
mod report;
mod run;
mod source;

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::time::Instant;

use pliant_io::{Format, PointCacheFormat};

use self::bend::{Bending, vertices_of_handles};
use self::cache::Cache;
use self::folder::Folder;
use self::followed::{Followed, Handles};
use self::leading::leading_sequence;
use self::morphs::Morphs;
pub use self::report::SequenceReport;
use self::run::{Run, To};
use self::source::{Source, cache_format};
use crate::EngineError;
use crate::animate::{AnimationFiles, ExistingFrames, MORPH_TOLERANCE, MovedVertices, check_output, places};
use crate::apply::{check_bends, order};
use crate::edit_job::{EditJob, with_keys};
use crate::files::{Destination, OutputFolder, Staging, refuse_shared};
use crate::frames::Frames;
use crate::loading::Loaded;
use crate::path_text::shown;
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
    /// The frames a second of a glTF's animation.
    pub fps: f64,
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
    let kind = Kind::of(sequence)?;
    let (first, _) = job.load(kind.mesh(), watch)?;
    let rest = first.model.rest();
    let (source, to, note) = match kind {
        Kind::Folder { folder, output, .. } => (Source::Folder(folder.frames), To::Folder(output), folder.gap),
        Kind::Cache { format, to, .. } => (Source::Cache(Cache::of(job.file, format, &first)?), To::File(to), None),
        Kind::Animation { .. } => {
            let morphs = Morphs::of(&first, sequence.fps, watch)?;
            let files = sequence.animation_files(&first, morphs.count(), watch)?;
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
        footprints: &footprints,
        path: edit.handle_of_path().map_err(in_edit)?,
        led: &led,
    };
    let sources = (&source, other.as_ref());
    let followed = Followed::of(&needed, (&first, &rest), sources, (edit, &ways), watch)?;
    let timeline = followed.timeline(edit, &setup, &led).map_err(in_edit)?;
    let (footprints, body) = followed.footprints(&footprints);
    // A path alone bends nothing.
    let may_bend = !footprints.is_empty() || (0..source.count()).any(|frame| timeline.reaches(frame));
    let ordering = match may_bend {
        false => None,
        true => {
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
        body: &body,
    };
    let mut report = SequenceReport {
        method: setup.method.name().to_owned(),
        vertices: rest.file_vertex_count,
        frames: source.count(),
        footprints: footprints.iter().map(|own| own.count).sum(),
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
    /// The animation to write for a glTF of `count` frames.
    fn animation_files<'b>(
        &'b self,
        loaded: &'b Loaded,
        count: usize,
        watch: &Watch,
    ) -> Result<AnimationFiles<'b>, EngineError> {
        loaded.sources().for_each(|(what, path)| watch.note_read(what, path));
        for place in places(self.job.output, count)? {
            self.job.refuse_outputs(&place, None, watch)?;
        }
        self.frames
            .check(&Frames::of(self.job.output, count.saturating_sub(1)))?;
        Ok(AnimationFiles {
            loaded,
            output: self.job.output,
            name: self.name,
            tolerance: MORPH_TOLERANCE,
            fps: self.fps,
            count,
            moved: MovedVertices::Drawn,
            inside_out: const { &BTreeSet::new() },
            colours: None,
            beside: None,
        })
    }
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
    /// A glTF with an animation of morph targets.
    Animation { mesh: PathBuf },
}

impl Kind {
    fn of(sequence: &Sequence<'_>) -> Result<Self, EngineError> {
        let job = &sequence.job;
        let Some(own) = cache_format(job.file) else {
            if sequence.mesh.is_some() {
                return Err(EngineError::Arguments(
                    "--mesh is for a point cache (.pc2 or .mdd), and other sequences need none: leave it out"
                        .to_owned(),
                ));
            }
            let format = Format::of_name(&job.file.to_string_lossy());
            if matches!(format, Ok(Format::Glb | Format::Gltf)) && job.file.is_file() {
                check_output(job.output)?;
                let mesh = job.file.to_owned();
                return Ok(Self::Animation { mesh });
            }
            let folder = Folder::of(job.file)?;
            return Ok(Self::Folder {
                mesh: folder.frames[0].clone(),
                folder,
                output: OutputFolder::of(job.output, ("FOLDER", job.file))?,
            });
        };
        if cache_format(job.output) != Some(own) {
            return Err(EngineError::Arguments(format!(
                "--output {} must be a point cache of the same kind as {}: give it the same extension",
                shown(job.output),
                shown(job.file)
            )));
        }
        let Some(mesh) = sequence.mesh else {
            return Err(EngineError::Arguments(format!(
                "{} holds only positions: give the mesh that it was made of as --mesh",
                shown(job.file)
            )));
        };
        refuse_shared(
            ("--output", job.output),
            [("FOLDER_OR_FILE", job.file), ("--mesh", mesh)],
        )?;
        Ok(Self::Cache {
            format: own,
            mesh: mesh.to_owned(),
            to: Destination::of(job.output)?,
        })
    }

    /// The file whose vertices and faces all frames have.
    fn mesh(&self) -> &Path {
        let (Self::Folder { mesh, .. } | Self::Cache { mesh, .. } | Self::Animation { mesh }) = self;
        mesh
    }
}
