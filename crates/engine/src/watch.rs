//! The stage and progress of long work, and its cancel flag.

use std::sync::{Arc, Mutex, PoisonError};

use pliant_mesh::{Cancel, Progress};

/// Shared between the work and its watcher. Cloning shares it.
#[derive(Clone, Debug, Default)]
pub struct Watch {
    /// Raised when the result is no longer wanted.
    pub cancel: Cancel,
    stage: Arc<Mutex<Option<(&'static str, Progress)>>>,
}

impl Watch {
    /// A watch over work that stops when `cancel` is raised.
    pub fn cancelled_by(cancel: &Cancel) -> Self {
        Self {
            cancel: cancel.clone(),
            stage: Arc::default(),
        }
    }

    /// Begins the stage `doing` ("reading", "binding"); the work reports its progress to the result.
    pub fn begin(&self, doing: &'static str) -> Progress {
        let progress = Progress::new();
        *self.stage.lock().unwrap_or_else(PoisonError::into_inner) = Some((doing, progress.clone()));
        progress
    }

    /// What is being done, and its share from 0 to 1.
    pub fn now(&self) -> Option<(&'static str, f32)> {
        let stage = self.stage.lock().unwrap_or_else(PoisonError::into_inner);
        stage.as_ref().map(|(doing, progress)| (*doing, progress.get()))
    }
}
