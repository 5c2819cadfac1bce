//! How far a save is, and whether it is still wanted.

use pliant_mesh::{Cancel, Cancelled, Progress};

/// Elements between two looks: a few milliseconds of the slowest loop, which writes decimals.
pub(crate) const STEP: usize = 1 << 13;

/// A save's way, or a part of it.
#[derive(Clone)]
pub(crate) struct Course<'a> {
    pub progress: Progress,
    pub cancel: &'a Cancel,
}

impl<'a> Course<'a> {
    /// The whole of a job.
    pub fn new(progress: &Progress, cancel: &'a Cancel) -> Self {
        Self {
            progress: progress.clone(),
            cancel,
        }
    }

    /// The part from one share of this to another.
    pub fn part(&self, from: f32, to: f32) -> Self {
        Self::new(&self.progress.part(from, to), self.cancel)
    }

    /// The course before `share`, and what follows.
    pub fn split(&self, share: f32) -> (Self, Self) {
        (self.part(0.0, share), self.part(share, 1.0))
    }

    /// Says that `done` of `all` is done, unless nobody wants the rest.
    pub fn reach(&self, done: usize, all: usize) -> Result<(), Cancelled> {
        self.progress.set(done as f32 / all.max(1) as f32);
        self.cancel.check()
    }

    /// As [`Self::reach`], for each element of a loop: says and looks at every [`STEP`]th.
    pub fn pass(&self, element: usize, all: usize) -> Result<(), Cancelled> {
        if element.is_multiple_of(STEP) {
            self.reach(element, all)?;
        }
        Ok(())
    }
}
