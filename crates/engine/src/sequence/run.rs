//! A sequence that is being written.

use std::io::Write;
use std::path::{Path, PathBuf};
use std::time::Instant;

use glam::DVec3;
use pliant_mesh::{Drawn, Progress};
use rayon::prelude::*;

use super::bend::Bending;
use super::bent::{Bent, Unbent};
use super::cache::Cache;
use super::frame::Frame;
use super::leaders::Leaders;
use super::morphs::Morphs;
use super::report::SequenceReport;
use super::source::Source;
use crate::EngineError;
use crate::animate::{AnimationFiles, AnimationWriter};
use crate::file_error::FileError;
use crate::files::{Destination, NewFile, OutputFolder, Share, Staged, Staging};
use crate::loading::Loaded;
use crate::report::ms_since;
use crate::saving::{self, Original, SaveAs};
use crate::watch::Watch;

/// A sequence that is being written.
pub(super) struct Run<'a> {
    pub bending: &'a Bending<'a>,
    /// The file whose vertices and faces all frames have.
    pub first: &'a Loaded,
    /// Its geometry.
    pub rest: &'a Drawn,
    pub source: &'a Source,
    pub watch: &'a Watch,
    pub staging: &'a Staging,
}

/// A frame that is done: its file or its bytes, and the notes about it.
struct Done<T> {
    result: T,
    bent: Option<Bent>,
    warnings: Vec<String>,
}

/// The place of the result.
pub(super) enum To<'a> {
    /// A file for each frame.
    Folder(OutputFolder),
    /// One file.
    File(Destination),
    /// An animation: one file, or a file for each frame.
    Animation(AnimationFiles<'a>),
}

impl Run<'_> {
    /// Writes all frames, and the report if there is a place for it, or nothing at all.
    ///
    /// # Errors
    /// Any refusal of a frame, and a file that can't be written.
    pub fn write(
        &self,
        to: &To<'_>,
        report_to: Option<Destination>,
        begun: Instant,
        report: &mut SequenceReport,
    ) -> Result<(), EngineError> {
        let mut made = None;
        let mut staged = match (self.source, to) {
            (Source::Folder(frames), To::Folder(output)) => {
                made = Some(output.make(self.staging)?);
                // Alone, because frames may have neighbours, and for all frames at once.
                let folder = output.inside(".frame")?;
                let held = self.staging.hold([(&folder, Share::Alone)], &self.watch.cancel)?;
                self.files(frames, output, report_to.as_ref(), report)?.holding(held)
            }
            (Source::Cache(cache), To::File(to)) => self.cache(cache, to, report)?,
            (Source::Morphs(morphs), To::Animation(files)) => {
                self.animation(morphs, files, report_to.as_ref(), report)?
            }
            _ => {
                return Err(EngineError::Unsupported(
                    "a folder of frames becomes a folder, and a point cache a point cache: give such an --output"
                        .to_owned(),
                ));
            }
        };
        report.conclude(ms_since(begun));
        if let Some(to) = report_to {
            let text = report.to_json();
            let file = NewFile {
                to,
                bytes: text.as_bytes(),
            };
            let (progress, cancel) = (Progress::new(), &self.watch.cancel);
            staged = staged.and(self.staging.stage_watched(&[file], None, &progress, cancel)?);
        }
        self.watch.cancel.check().map_err(|_| EngineError::Interrupted)?;
        staged.commit()?;
        if let Some(made) = made {
            made.keep();
        }
        Ok(())
    }

    /// A file for each frame.
    fn files(
        &self,
        frames: &[PathBuf],
        output: &OutputFolder,
        beside: Option<&Destination>,
        report: &mut SequenceReport,
    ) -> Result<Staged, EngineError> {
        let mut staged: Option<Staged> = None;
        let of_frame = |frame: usize, leaders: &Leaders| self.file((frame, &frames[frame]), leaders, output, beside);
        self.each(of_frame, report, |frame| {
            staged = Some(match staged.take() {
                Some(staged) => staged.and(frame),
                None => frame,
            });
            Ok(())
        })?;
        staged.ok_or(EngineError::Interrupted)
    }

    /// One cache, written frame by frame.
    fn cache(&self, cache: &Cache, to: &Destination, report: &mut SequenceReport) -> Result<Staged, EngineError> {
        self.staging.stage_pieces(to, &self.watch.cancel, |file| {
            let refuse = |error| EngineError::from(FileError::writing(&to.given, error));
            file.write_all(&cache.header()?).map_err(refuse)?;
            let of_frame = |frame: usize, leaders: &Leaders| self.piece(frame, leaders, cache);
            self.each(of_frame, report, |bytes| file.write_all(&bytes).map_err(refuse))
        })
    }

    /// An animation, written frame by frame. If no frame is bent, the file's own one is it.
    fn animation(
        &self,
        morphs: &Morphs,
        files: &AnimationFiles<'_>,
        beside: Option<&Destination>,
        report: &mut SequenceReport,
    ) -> Result<Staged, EngineError> {
        let files = AnimationFiles { beside, ..*files };
        let mut writer = AnimationWriter::new(files, self.watch, self.staging)?;
        let of_frame = |frame: usize, leaders: &Leaders| self.displacements(frame, leaders, morphs);
        self.each(of_frame, report, |displacements| writer.push(&displacements))?;
        let (staged, written) = match report.bent_frames {
            0 => writer.finish_unchanged()?,
            _ => writer.finish()?,
        };
        report.warn(written.warnings);
        report.morph = written.morph;
        Ok(staged)
    }

    /// Bends a frame of an animation, and gives the displacements of its drawn vertices since rest.
    fn displacements(&self, frame: usize, leaders: &Leaders, morphs: &Morphs) -> Result<Done<Vec<DVec3>>, EngineError> {
        self.watch.cancel.check().map_err(|_| EngineError::Interrupted)?;
        let mut result = morphs.displacements(frame, self.rest.positions.len());
        let positions = morphs.positions(self.first, &result)?;
        let bent = self.bend(frame, &self.first.path, &positions, leaders)?;
        if let Some(bent) = &bent {
            let drawn = self.first.model.drawn.surface_vertices();
            for (way, vertex) in result.iter_mut().zip(drawn) {
                *way += vertex.map_or(DVec3::ZERO, |vertex| bent.displacements[vertex.index()]);
            }
        }
        Ok(Done {
            result,
            bent,
            warnings: Vec::new(),
        })
    }

    /// Bends a frame.
    fn bend(
        &self,
        frame: usize,
        file: &Path,
        positions: &[DVec3],
        leaders: &Leaders,
    ) -> Result<Option<Bent>, EngineError> {
        let unbent = Unbent { frame, file, positions };
        self.bending.frame(&unbent, leaders, self.watch)
    }

    /// The end of a leader. A refusal is not told here: the frame itself tells it when its turn comes.
    fn leader(&self, frame: usize) -> Option<Bent> {
        self.watch.cancel.check().ok()?;
        let mesh = (self.first, self.rest);
        let unbent = Unbent {
            frame,
            file: &self.first.path,
            positions: &self.source.positions(frame, mesh, self.watch).ok()?,
        };
        self.bending.bent(&unbent, None, self.watch).ok()?
    }

    /// Does all frames, side by side in groups as large as the pool, and takes the results in order.
    fn each<T: Send>(
        &self,
        of_frame: impl Fn(usize, &Leaders) -> Result<Done<T>, EngineError> + Sync,
        report: &mut SequenceReport,
        mut take: impl FnMut(T) -> Result<(), EngineError>,
    ) -> Result<(), EngineError> {
        let progress = self.watch.begin("editing the sequence");
        let count = self.source.count();
        let side_by_side = rayon::current_num_threads().max(1);
        let mut leaders = Leaders::default();
        let mut led = 0..0;
        for start in (0..count).step_by(side_by_side) {
            if self.bending.is_led() && start >= led.end {
                led = start..count.min(start + Leaders::span(side_by_side));
                leaders = Leaders::of(led.clone(), count, |frame| self.leader(frame));
            }
            let group = start..count.min(start + side_by_side);
            let done = group.clone().into_par_iter().map(|frame| of_frame(frame, &leaders));
            let done: Vec<Result<Done<T>, EngineError>> = done.collect();
            for done in done {
                // The first refusal in the order of frames, whatever the number of threads.
                let done = done?;
                if let Some(bent) = done.bent {
                    report.bent_frames += 1;
                    report.unsettled_frames += usize::from(!bent.is_settled);
                    report.warn(bent.warnings);
                }
                report.warn(done.warnings);
                take(done.result)?;
            }
            progress.set(group.end as f32 / count as f32);
        }
        Ok(())
    }

    /// Reads, bends and stages a file.
    fn file(
        &self,
        (frame, path): (usize, &Path),
        leaders: &Leaders,
        output: &OutputFolder,
        beside: Option<&Destination>,
    ) -> Result<Done<Staged>, EngineError> {
        let cancel = &self.watch.cancel;
        cancel.check().map_err(|_| EngineError::Interrupted)?;
        let read = Frame::read(path, self.first, self.rest, self.watch)?;
        let bent = self.bend(frame, path, &read.positions, leaders)?;
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
        let output = output.inside(path.file_name().unwrap_or_default())?;
        let save = SaveAs {
            beside: beside.map(|report| ("--report", report)),
            ..SaveAs::shape(&positions, &output.given)
        };
        let saved = saving::stage_of(&original, &save, self.staging, &Progress::new(), cancel)?;
        Ok(Done {
            result: saved.staged,
            bent,
            warnings: saved.warnings,
        })
    }

    /// Reads and bends a frame of a cache.
    fn piece(&self, frame: usize, leaders: &Leaders, cache: &Cache) -> Result<Done<Vec<u8>>, EngineError> {
        self.watch.cancel.check().map_err(|_| EngineError::Interrupted)?;
        let read = cache.frame(frame)?;
        let bent = self.bend(frame, &self.first.path, &read.positions, leaders)?;
        let result = match &bent {
            Some(bent) => cache.displaced(read, &bent.displacements),
            None => read.bytes,
        };
        Ok(Done {
            result,
            bent,
            warnings: Vec::new(),
        })
    }
}
