//! The progress of a save, and its cancellation.

use pliant_mesh::{Cancel, Cancelled, Progress};

/// Elements between two checks for cancelling: a few milliseconds of the slowest loop, which writes decimals.
pub(crate) const STEP: usize = 1 << 13;

/// The progress of a save, or of a part of it.
#[derive(Clone)]
pub(crate) struct Course<'a> {
    pub progress: Progress,
    pub cancel: &'a Cancel,
}

impl<'a> Course<'a> {
    /// The complete job.
    pub fn new(progress: &Progress, cancel: &'a Cancel) -> Self {
        Self {
            progress: progress.clone(),
            cancel,
        }
    }

    /// The part between two shares of this one.
    pub fn part(&self, from: f32, to: f32) -> Self {
        Self::new(&self.progress.part(from, to), self.cancel)
    }

    /// Splits this into the part before `share` and the part after it.
    pub fn split(&self, share: f32) -> (Self, Self) {
        (self.part(0.0, share), self.part(share, 1.0))
    }

    /// Reports that `done` of `all` are done. Fails if the save was cancelled.
    pub fn reach(&self, done: usize, all: usize) -> Result<(), Cancelled> {
        self.progress.set(done as f32 / all.max(1) as f32);
        self.cancel.check()
    }

    /// Like [`Self::reach`], for each element of a loop: reports and checks at every [`STEP`]th element.
    pub fn pass(&self, element: usize, all: usize) -> Result<(), Cancelled> {
        if element.is_multiple_of(STEP) {
            self.reach(element, all)?;
        }
        Ok(())
    }
}
