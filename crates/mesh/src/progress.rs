//! A long job reports its progress here, and learns that its result is no longer wanted.
//!
//! Both are cheap handles to shared atomics: the caller keeps a clone, the job gets a reference.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU32, AtomicUsize, Ordering};

/// The progress of a job, from 0 to 1. Cloning shares the counter.
#[derive(Clone, Debug)]
pub struct Progress {
    counter: Arc<AtomicU32>,
    /// The job's range on the counter.
    from: f32,
    to: f32,
}

impl Default for Progress {
    fn default() -> Self {
        Self {
            counter: Arc::default(),
            from: 0.0,
            to: 1.0,
        }
    }
}

impl Progress {
    /// A fresh counter at 0.
    pub fn new() -> Self {
        Self::default()
    }

    /// The part of this job from the share `from` to the share `to`, as a job of its own on the same counter.
    #[must_use]
    pub fn part(&self, from: f32, to: f32) -> Self {
        let at = |share: f32| self.from + (self.to - self.from) * share.clamp(0.0, 1.0);
        Self {
            counter: Arc::clone(&self.counter),
            from: at(from),
            to: at(to),
        }
    }

    /// Says that `fraction` (0 to 1, clamped) of the job is done.
    pub fn set(&self, fraction: f32) {
        let at = self.from + (self.to - self.from) * fraction.clamp(0.0, 1.0);
        self.counter.store(at.to_bits(), Ordering::Relaxed);
    }

    /// The last fraction of the whole that was reported, 0 to 1, also if this is a part of it.
    pub fn get(&self) -> f32 {
        f32::from_bits(self.counter.load(Ordering::Relaxed))
    }
}

/// A request to stop, which a job checks between its steps. Cloning shares the flag.
#[derive(Clone, Debug, Default)]
pub struct Cancel(Arc<Flag>);

#[derive(Debug, Default)]
struct Flag {
    is_raised: AtomicBool,
    /// The number of further checks after which it raises itself.
    looks_left: Option<AtomicUsize>,
}

/// The job was cancelled: there is no result and nothing was changed.
#[derive(Clone, Copy, PartialEq, Eq, Debug, thiserror::Error)]
#[error("the job was cancelled")]
pub struct Cancelled;

impl Cancel {
    /// A flag that nobody has raised.
    pub fn new() -> Self {
        Self::default()
    }

    /// A flag that raises itself after it was checked `looks` times, so that a test can stop a job at every place where
    /// it can be stopped, independent of time.
    pub fn after_looks(looks: usize) -> Self {
        Self(Arc::new(Flag {
            is_raised: AtomicBool::new(false),
            looks_left: Some(AtomicUsize::new(looks)),
        }))
    }

    /// Asks every job that holds a clone to stop.
    pub fn cancel(&self) {
        self.0.is_raised.store(true, Ordering::Relaxed);
    }

    /// Returns true if the flag is raised.
    pub fn is_cancelled(&self) -> bool {
        if let Some(left) = &self.0.looks_left
            && left
                .fetch_update(Ordering::Relaxed, Ordering::Relaxed, |left| left.checked_sub(1))
                .is_err()
        {
            self.cancel();
        }
        self.0.is_raised.load(Ordering::Relaxed)
    }

    /// Leaves a job by `?` once the flag is raised.
    pub fn check(&self) -> Result<(), Cancelled> {
        if self.is_cancelled() { Err(Cancelled) } else { Ok(()) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_part_tells_its_share_of_the_whole() {
        let whole = Progress::new();
        let half = whole.part(0.5, 1.0);
        assert_eq!(whole.get(), 0.0, "to make a part says nothing yet");
        half.part(0.5, 0.75).set(1.0);
        assert_eq!((whole.get(), half.get()), (0.875, 0.875));
        half.set(7.0);
        assert_eq!(whole.get(), 1.0);
    }

    #[test]
    fn a_flag_raises_itself_after_its_looks_and_stays_up() {
        for looks in 0..4 {
            let cancel = Cancel::after_looks(looks);
            let other = cancel.clone();
            let seen: Vec<bool> = (0..6).map(|k| [&cancel, &other][k % 2].is_cancelled()).collect();
            assert_eq!(seen, (0..6).map(|k| k >= looks).collect::<Vec<_>>());
        }
    }
}
