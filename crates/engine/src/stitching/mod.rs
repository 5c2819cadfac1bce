//! Changes of topology: files in, a new file out. Cutting, filling and joining are the crate `stitch`'s; here they get
//! files, appearances and reports.

mod append;
mod cut;
mod fill;
mod look;
mod merge;
mod prepared;
mod remade;
mod shape_report;

use std::path::Path;

use pliant_editor::Selection;
use pliant_mesh::{Model, WeldOptions};
use pliant_stitch::{Age, NewShape};
use serde_json::Value;

use crate::EngineError;
use crate::files::placement::placement;
use crate::files::{self, Destination, NewFile, Staged, Staging};
use crate::loading::{Loaded, check_not_empty, load};
use crate::saving;
use crate::watch::Watch;
use look::Dressed;
use shape_report::Change;

pub use cut::{Cut, CutAlong, cut, read_cut_curve, read_selector};
pub use fill::{Fill, fill};
pub use merge::{Merge, merge, read_joins};
pub use pliant_stitch::{Holes, Keep, Plane};
pub use remade::{Present, Remade, remake};
pub use shape_report::ShapeCounts;

/// Whether a new shape may take the place of the file that it was made from.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub enum Replace {
    /// It is refused.
    #[default]
    Never,
    /// It may; the caller keeps the original.
    WithOriginalKept,
}

impl Replace {
    /// Refuses an output that is the file that was read, unless it may be replaced.
    ///
    /// # Errors
    /// [`EngineError::Arguments`], naming the output.
    pub fn check(self, file: &Path, output: &Path) -> Result<(), EngineError> {
        if self == Self::Never && files::is_same(file, output) {
            return Err(EngineError::Arguments(format!(
                "--output {} is the file that is read: give another name, or --replace, which keeps the original beside \
                 it",
                files::shown(output)
            )));
        }
        Ok(())
    }
}

/// The receiver of the figures about a new shape.
#[derive(Clone, Copy, Debug, Default)]
pub enum ReportTo<'a> {
    /// Nobody: the shape is not judged.
    #[default]
    Nobody,
    /// The caller, with the result.
    Caller,
    /// This file, and the caller.
    File(&'a Path),
}

impl<'a> ReportTo<'a> {
    /// The file that is written.
    fn file(self) -> Option<&'a Path> {
        match self {
            Self::File(path) => Some(path),
            Self::Nobody | Self::Caller => None,
        }
    }

    /// Calls `judge` if somebody gets the figures.
    fn wanted<T, E>(self, judge: impl FnOnce() -> Result<T, E>) -> Result<Option<T>, E> {
        match self {
            Self::Nobody => Ok(None),
            Self::Caller | Self::File(_) => judge().map(Some),
        }
    }
}

impl<'a> From<Option<&'a Path>> for ReportTo<'a> {
    fn from(file: Option<&'a Path>) -> Self {
        file.map_or(Self::Nobody, Self::File)
    }
}

/// A new shape that is written beside its place, ready to be committed.
#[derive(Debug)]
pub struct Stitched {
    /// The files that were read: the first is the one that may be replaced.
    pub loaded: Vec<Loaded>,
    /// The written files.
    pub staged: Staged,
    /// A sentence that says how much was done.
    pub done: String,
    /// The report's members, if somebody gets them.
    pub report: Option<Value>,
    /// Sentences that a person should know.
    pub warnings: Vec<String>,
}

impl Stitched {
    /// The same with the files that were read for it.
    fn from(self, loaded: Vec<Loaded>) -> Self {
        Self { loaded, ..self }
    }

    /// Commits the files after those of `first`: originals that are kept.
    ///
    /// # Errors
    /// An input that another program has changed meanwhile and that would be replaced; a file that can't be renamed.
    pub fn commit(self, first: Option<Staged>) -> Result<(), EngineError> {
        for loaded in &self.loaded {
            loaded.refuse_changed(&self.staged)?;
        }
        let staged = match first {
            Some(first) => first.and(self.staged),
            None => self.staged,
        };
        Ok(staged.commit()?)
    }
}

/// The file that a new shape is made from, and the places of the shape and of the report about it.
#[derive(Clone, Copy, Debug)]
pub struct Remaking<'a> {
    /// The file to read; the first, if there are several.
    pub file: &'a Path,
    /// The file to write.
    pub output: &'a Path,
    /// The receiver of the report.
    pub report: ReportTo<'a>,
    /// Whether the output may be the file that is read.
    pub replace: Replace,
    /// The joining of vertices on reading.
    pub weld: WeldOptions,
}

impl Remaking<'_> {
    /// Refuses places that are no files, before anything is read.
    fn check_paths(&self) -> Result<(), EngineError> {
        Destination::of(self.output)?;
        self.report.file().map(Destination::of).transpose()?;
        Ok(())
    }

    /// Reads files that have triangles, and refuses places of files that were read.
    fn load<const N: usize>(&self, paths: [&Path; N], watch: &Watch) -> Result<[Loaded; N], EngineError> {
        let mut loaded = Vec::with_capacity(N);
        for path in paths {
            loaded.push(load(path, &self.weld, watch)?);
        }
        for (path, loaded) in paths.iter().zip(&loaded) {
            check_not_empty(path, &loaded.model)?;
        }
        self.refuse_inputs(watch)?;
        loaded.try_into().map_err(|_| EngineError::Interrupted)
    }

    /// Refuses places of files that were read.
    fn refuse_inputs(&self, watch: &Watch) -> Result<(), EngineError> {
        let file = self.file;
        let report = self.report.file().map(|report| ("--report", report));
        let outputs: Vec<(&str, &Path)> = [("--output", self.output)].into_iter().chain(report).collect();
        self.replace.check(file, self.output)?;
        watch.refuse_outputs(&outputs, Some(file))
    }

    /// Writes a shape and the report beside their places. `report` makes the report's members from the warnings.
    fn stage(
        &self,
        made: &Made,
        report: impl FnOnce(&[String]) -> Value,
        staging: &Staging,
        watch: &Watch,
    ) -> Result<Stitched, EngineError> {
        let progress = watch.begin("saving");
        let report_to = self.report.file().map(Destination::of).transpose()?;
        let beside = report_to.as_ref().map(|to| ("--report", to));
        let place = placement(self.file, &Destination::of(self.output)?);
        let unsaved = made.dressed.unsaved(&made.shape, place);
        let saved = saving::stage_new(&unsaved, self.output, beside, staging, &progress, &watch.cancel)?;
        let warnings: Vec<String> = made.warnings.iter().cloned().chain(saved.warnings).collect();
        let mut staged = saved.staged;
        let report = self.report.wanted(|| Ok::<_, EngineError>(report(&warnings)))?;
        if let Some((to, report)) = report_to.zip(report.as_ref()) {
            let text = format!("{report:#}\n");
            let file = NewFile {
                to,
                bytes: text.as_bytes(),
            };
            let progress = pliant_mesh::Progress::new();
            staged = staged.and(staging.stage_watched(&[file], None, &progress, &watch.cancel)?);
        }
        if watch.cancel.is_cancelled() {
            return Err(EngineError::Interrupted);
        }
        Ok(Stitched {
            loaded: Vec::new(),
            staged,
            done: made.done.clone(),
            report,
            warnings,
        })
    }
}

/// A shape that was made from one file.
struct Made {
    shape: NewShape,
    dressed: Dressed,
    /// Its numbers, and how many pairs of triangles now pass through each other, if somebody gets them.
    after: Option<(ShapeCounts, usize)>,
    /// Sentences that a person should know.
    warnings: Vec<String>,
    /// A vertex, numbered as in the file, of each border that a warning says stays open.
    left_open: Vec<u32>,
    /// A sentence that says how much was done.
    done: String,
}

/// What became of each triangle of a shape that was made from one file.
fn change_of(shape: &NewShape) -> impl Fn(usize) -> Change {
    |place| match shape.triangle_sources[place].age {
        Age::New => Change::Changed,
        Age::Old => Change::OfPart(0),
    }
}

/// A flag for each welded vertex of a model: whether it is selected.
fn flags(selection: &Selection, model: &Model) -> Vec<bool> {
    let mut flags = vec![false; model.surface.positions.len()];
    selection.iter().for_each(|vertex| flags[vertex.index()] = true);
    flags
}

/// The refusal of a stitch, which names its file.
fn refused(file: &Path, error: pliant_stitch::StitchError) -> EngineError {
    match error {
        pliant_stitch::StitchError::Cancelled(_) => EngineError::Interrupted,
        source => EngineError::Stitch {
            file: file.to_owned(),
            source,
        },
    }
}

/// The sentences about the parts of a file that a new shape loses.
fn lost(loaded: &Loaded, dressed: &Dressed, output: &Path) -> Result<Vec<String>, EngineError> {
    let format = pliant_io::Format::of_name(&output.to_string_lossy())?;
    let has_own_names = format == pliant_io::Format::Obj && dressed.has_obj_names();
    let mut sentences = loaded.scene.lost_in_new_shape(format, has_own_names);
    let broken = loaded.model.findings.non_finite_triangles.count;
    if broken > 0 {
        let triangles = counted(broken, "triangle", "triangles");
        let were = if broken == 1 { "was" } else { "were" };
        sentences.push(format!(
            "{triangles} with coordinates that are not numbers {were} left out of the new shape"
        ));
    }
    Ok(sentences)
}

/// A count and its noun.
fn counted(count: usize, one: &str, many: &str) -> String {
    match count {
        1 => format!("1 {one}"),
        count => format!("{count} {many}"),
    }
}
