//! The part that all jobs have in common which apply an edit to files.

use std::path::Path;
use std::time::Instant;

use pliant_deform::Budget;
use pliant_editor::{Beginning, EditError, EditFile};
use pliant_mesh::WeldOptions;

use crate::EngineError;
use crate::examples;
use crate::files::Destination;
use crate::loading::{Loaded, check_not_empty, load};
use crate::report::ms_since;
use crate::watch::Watch;

/// An edit, the files that it is for, and the limits of its computation.
#[derive(Clone, Copy, Debug)]
pub struct EditJob<'a> {
    /// The file to bend; for a sequence the folder of its frames, or its point cache (pc2, mdd).
    pub file: &'a Path,
    /// The edit.
    pub edit: &'a Beginning,
    /// The place that the edit was read from, for messages.
    pub edit_path: &'a Path,
    /// The file or files to write; each job says which.
    pub output: &'a Path,
    /// The file for the report, if one is wanted.
    pub report: Option<&'a Path>,
    /// The distance within which vertices of the file are joined, in world units; `None` is the edit's own.
    pub weld: Option<f64>,
    /// The memory that binding may use.
    pub budget: Budget,
}

impl EditJob<'_> {
    /// The file for the report.
    ///
    /// # Errors
    /// A path that is not a file.
    pub(crate) fn report_to(&self) -> Result<Option<Destination>, EngineError> {
        Ok(self.report.map(Destination::of).transpose()?)
    }

    /// Reads a file of the job, with the welding that it or its edit asks for, and the time that this took, in
    /// milliseconds.
    ///
    /// # Errors
    /// A file that can't be read, or that is empty.
    pub(crate) fn load(&self, file: &Path, watch: &Watch) -> Result<(Loaded, f64), EngineError> {
        let weld = match self.weld {
            None => self.edit.weld_options(),
            distance => WeldOptions { distance },
        };
        let start = Instant::now();
        let loaded = load(file, &weld, watch)?;
        let load_ms = ms_since(start);
        check_not_empty(file, &loaded.model)?;
        Ok((loaded, load_ms))
    }

    /// The edit with the examples that it names by files.
    ///
    /// # Errors
    /// An example that can't be read.
    pub(crate) fn edit_with_examples(&self, loaded: &Loaded, watch: &Watch) -> Result<Beginning, EngineError> {
        let mut edit = self.edit.clone();
        examples::bring(&mut edit, self.edit_path, loaded, watch)?;
        Ok(edit)
    }

    /// A refusal of the edit, which names its place.
    pub(crate) fn refused(&self, source: EditError) -> EngineError {
        EngineError::Edit {
            edit: self.edit_path.to_owned(),
            source,
        }
    }

    /// Refuses to write over a file that was read; only `edited` may be replaced.
    ///
    /// # Errors
    /// Names both files.
    pub(crate) fn refuse_outputs(
        &self,
        output: &Path,
        edited: Option<&Path>,
        watch: &Watch,
    ) -> Result<(), EngineError> {
        let report = self.report.map(|report| ("--report", report));
        let outputs: Vec<(&str, &Path)> = [("--output", output)].into_iter().chain(report).collect();
        watch.refuse_outputs(&outputs, edited)
    }
}

/// The edit of a file of keys, which a project does not have.
///
/// # Errors
/// A project.
pub(crate) fn with_keys(edit: &Beginning) -> Result<&EditFile, EngineError> {
    match edit {
        Beginning::Edit(edit) => Ok(edit),
        Beginning::Sequence(_) | Beginning::Project(_) => Err(EngineError::Arguments(
            "--edit: a project can't be animated: export its edit from the window, and give that".to_owned(),
        )),
    }
}
