//! Lets dye flow along a file's surface: a file in, the same file with other vertex colours out.

mod coloured_files;
mod colours;
mod flowing;
mod played;
mod report;

use std::collections::BTreeSet;
use std::path::Path;
use std::time::Instant;

use pliant_deform::Budget;
use pliant_editor::FlowFile;
use pliant_io::{Format, SaveError};
use pliant_mesh::{Progress, WeldOptions};

use crate::EngineError;
use crate::files::{self, Destination, NewFile, Staging};
use crate::frames::Frames;
use crate::loading::{check_not_empty, load};
use crate::report::{FrameTimes, ms_since};
use crate::watch::Watch;
use coloured_files::ColouredFiles;

pub use colours::{ColoursToSave, colour_hash, with_dye};
pub use flowing::Flowing;
pub use played::{PlayedFlow, StagedFlow, flow_frames_path, stage_played_flow};
pub use report::{FlowReport, FromTo};

/// The input of [`flow`].
#[derive(Clone, Copy, Debug)]
pub struct FlowJob<'a> {
    /// The file along whose surface dye flows.
    pub file: &'a Path,
    /// The flow.
    pub flow: &'a FlowFile,
    /// The place that the flow was read from, for messages.
    pub flow_path: &'a Path,
    /// The file to write. A name that ends in `-####` before its extension is written for the start and for each step,
    /// with the step's number in place of the `#`s.
    pub output: &'a Path,
    /// The file for the report, if one is wanted.
    pub report: Option<&'a Path>,
    /// The joining of FILE's vertices.
    pub weld: WeldOptions,
    /// The memory that the Laplacian's factor may take.
    pub budget: Budget,
}

/// Reads the file of a flow.
///
/// # Errors
/// A file that can't be read, or a member that its format does not have, naming the file.
pub fn read_flow(path: &Path, watch: &Watch) -> Result<FlowFile, EngineError> {
    watch.note_read("--flow", path);
    FlowFile::parse(&files::read_text(path)?).map_err(|source| EngineError::Edit {
        edit: path.to_owned(),
        source,
    })
}

/// Runs a flow and writes the coloured file, or a file for each step, and the report, or nothing at all.
///
/// # Errors
/// Any refusal of the file, of the flow or of the result. Nothing is written then.
pub fn flow(job: &FlowJob<'_>, watch: &Watch, staging: &Staging) -> Result<FlowReport, EngineError> {
    let frames = Frames::of(job.output, job.flow.steps());
    for place in frames.all() {
        Destination::of(&place)?;
    }
    refuse_format(job.output)?;
    let report_to = job.report.map(Destination::of).transpose()?;
    let start = Instant::now();
    let loaded = load(job.file, &job.weld, watch)?;
    let load_ms = ms_since(start);
    check_not_empty(job.file, &loaded.model)?;
    refuse_inputs(job, &frames, watch)?;
    let start = job.flow.resolve(&loaded.model).map_err(|source| EngineError::Edit {
        edit: job.flow_path.to_owned(),
        source,
    })?;
    let begun = Instant::now();
    let mut flow = Flowing::begin((job.file, &loaded.model), (job.flow, &start), job.budget, watch)?;
    let bind_ms = ms_since(begun);
    let positions = loaded.model.rest_positions();
    let beside = report_to.as_ref();
    let mut run = Run {
        job,
        files: ColouredFiles::new(&loaded, &positions, const { &BTreeSet::new() }, beside, staging),
        watch,
    };
    let mut report = FlowReport::at_start(&loaded, job.flow, flow.flow());
    (report.load_ms, report.bind_ms) = (load_ms, bind_ms);
    report.steps = run.all_steps(&mut flow, &frames)?;
    report.at_end(flow.flow());
    let files = run.files;
    report.save_ms = files.save_ms;
    report.warnings = flow.warning().into_iter().chain(files.warnings).collect();
    let mut staged = files.staged;
    if let Some(to) = report_to {
        let text = report.to_json();
        let file = NewFile {
            to,
            bytes: text.as_bytes(),
        };
        let written = staging.stage_watched(&[file], None, &Progress::new(), &watch.cancel)?;
        staged = Some(coloured_files::joined(staged, written));
    }
    if watch.cancel.is_cancelled() {
        return Err(EngineError::Interrupted);
    }
    if let Some(staged) = staged {
        loaded.refuse_changed(&staged)?;
        staged.commit()?;
    }
    Ok(report)
}

/// A flow that is being written.
struct Run<'a> {
    job: &'a FlowJob<'a>,
    files: ColouredFiles<'a>,
    watch: &'a Watch,
}

impl Run<'_> {
    /// Takes all steps and writes the frames. Returns the steps' times.
    fn all_steps(&mut self, flow: &mut Flowing<'_>, frames: &Frames) -> Result<FrameTimes, EngineError> {
        let job = self.job;
        let count = job.flow.steps();
        let mut times = Vec::with_capacity(count);
        let mut progress = self.watch.begin("flowing");
        for step in 0..=count {
            if step > 0 {
                let start = Instant::now();
                flow.step(&self.watch.cancel)?;
                times.push(ms_since(start));
            }
            if self.watch.cancel.is_cancelled() {
                return Err(EngineError::Interrupted);
            }
            progress.set(step as f32 / count.max(1) as f32);
            if let Some(place) = frames.at(step) {
                if step == count {
                    progress = self.watch.begin("saving");
                }
                self.files.write(&flow.flow().dyes(), &place, self.watch)?;
            }
        }
        Ok(FrameTimes::of(&mut times, &mut []))
    }
}

/// Refuses a format without colours before anything is computed.
fn refuse_format(output: &Path) -> Result<(), EngineError> {
    match Format::of_name(&output.to_string_lossy())? {
        Format::Stl => Err(EngineError::Save {
            file: output.to_owned(),
            source: SaveError::without_colours(),
        }),
        _ => Ok(()),
    }
}

/// Refuses outputs that are files that were read; a single OUT may be FILE. Frames have different names, so they are not
/// compared with each other.
fn refuse_inputs(job: &FlowJob<'_>, frames: &Frames, watch: &Watch) -> Result<(), EngineError> {
    let replaced = matches!(frames, Frames::Last(..)).then_some(job.file);
    for place in frames.all() {
        let output = ("--output", &*place);
        watch.refuse_outputs(&[output], replaced)?;
        if let Some(report) = job.report {
            files::refuse_shared(("--report", report), [output])?;
        }
    }
    match job.report {
        Some(report) => watch.refuse_outputs(&[("--report", report)], None),
        None => Ok(()),
    }
}
