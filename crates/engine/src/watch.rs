//! The stage and progress of long work, its cancel flag, and the files that it has read.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};

use pliant_mesh::{Cancel, Progress};

use crate::EngineError;
use crate::files::refuse_shared;

/// The state shared between the work and its watcher. Cloning shares it.
#[derive(Clone, Debug, Default)]
pub struct Watch {
    /// Raised when the result is no longer wanted.
    pub cancel: Cancel,
    stage: Arc<Mutex<Option<(&'static str, Progress)>>>,
    /// Every file that was read, or that one of these names, with its description.
    read: Arc<Mutex<BTreeMap<PathBuf, &'static str>>>,
}

impl Watch {
    /// A watch over work that stops when `cancel` is raised.
    pub fn cancelled_by(cancel: &Cancel) -> Self {
        Self {
            cancel: cancel.clone(),
            ..Self::default()
        }
    }

    /// A watch over other work, which stops when `cancel` is raised, that knows the files that were read under this one.
    pub fn of_next(&self, cancel: &Cancel) -> Self {
        Self {
            read: Arc::clone(&self.read),
            ..Self::cancelled_by(cancel)
        }
    }

    /// The same state for work that stops when `cancel` is raised.
    #[must_use]
    pub fn stopped_by(&self, cancel: &Cancel) -> Self {
        Self {
            cancel: cancel.clone(),
            ..self.clone()
        }
    }

    /// Begins the stage `doing` ("reading", "binding"); the work reports its progress to the result.
    pub fn begin(&self, doing: &'static str) -> Progress {
        let progress = Progress::new();
        *self.stage.lock().unwrap_or_else(PoisonError::into_inner) = Some((doing, progress.clone()));
        progress
    }

    /// The present activity, and its share from 0 to 1.
    pub fn now(&self) -> Option<(&'static str, f32)> {
        let stage = self.stage.lock().unwrap_or_else(PoisonError::into_inner);
        stage.as_ref().map(|(doing, progress)| (*doing, progress.get()))
    }

    /// Notes a file that is read or named, and its description for a person; the last one counts.
    pub(crate) fn note_read(&self, what: &'static str, path: &Path) {
        let mut read = self.read.lock().unwrap_or_else(PoisonError::into_inner);
        read.insert(path.to_owned(), what);
    }

    /// Refuses outputs, each with its argument's name, if one is the same as another, or as any file that was
    /// read or named: meshes, the files that these and an edit name, and edits. `edited` is the file that the first output may
    /// replace.
    ///
    /// # Errors
    /// [`EngineError::Arguments`], naming the output.
    pub fn refuse_outputs(&self, outputs: &[(&str, &Path)], edited: Option<&Path>) -> Result<(), EngineError> {
        let read = self.read.lock().unwrap_or_else(PoisonError::into_inner).clone();
        for (number, output) in outputs.iter().enumerate() {
            refuse_shared(*output, outputs[..number].iter().copied())?;
            let is_free = |path: &PathBuf| number == 0 && edited == Some(path);
            let others = read.iter().filter(|(path, _)| !is_free(path));
            refuse_shared(*output, others.map(|(path, what)| (*what, &**path)))?;
        }
        Ok(())
    }
}
