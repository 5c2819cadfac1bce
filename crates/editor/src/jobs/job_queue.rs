//! One job running and the newest pending: the policy for one kind of work.

use pliant_mesh::{Cancel, Progress};

use crate::revision::Revision;

/// One kind's queue. `W` is the data for starting the work; the queue starts nothing itself, its owner starts the work
/// that [`JobQueue::start_next`] returns.
#[derive(Debug)]
pub struct JobQueue<W> {
    running: Option<Running>,
    pending: Option<(Revision, W)>,
}

/// A started job.
#[derive(Clone, Debug)]
pub struct Running {
    /// The revision for which it was made.
    pub stamp: Revision,
    /// Its progress.
    pub progress: Progress,
    /// The flag that stops it.
    pub cancel: Cancel,
}

impl<W> Default for JobQueue<W> {
    fn default() -> Self {
        Self {
            running: None,
            pending: None,
        }
    }
}

impl<W> JobQueue<W> {
    /// Asks for work. It replaces pending work; running work continues.
    pub fn request(&mut self, stamp: Revision, work: W) {
        self.pending = Some((stamp, work));
    }

    /// The pending work, if nothing runs: from now on it counts as running, and the caller must start it.
    pub fn start_next(&mut self) -> Option<(Running, W)> {
        if self.running.is_some() {
            return None;
        }
        let (stamp, work) = self.pending.take()?;
        let running = Running {
            stamp,
            progress: Progress::new(),
            cancel: Cancel::new(),
        };
        self.running = Some(running.clone());
        Some((running, work))
    }

    /// Notes that the job with `stamp` has ended, and returns its record; `None` if no such job was running.
    pub fn finish(&mut self, stamp: Revision) -> Option<Running> {
        self.running.take_if(|running| running.stamp == stamp)
    }

    /// Asks the running job to stop and forgets the pending one.
    pub fn cancel(&mut self) {
        self.pending = None;
        if let Some(running) = &self.running {
            running.cancel.cancel();
        }
    }

    /// The job that runs, unless it was asked to stop.
    pub fn running(&self) -> Option<&Running> {
        self.running.as_ref().filter(|running| !running.cancel.is_cancelled())
    }

    /// Whether the newest wanted job, running or pending, is the one with this stamp.
    pub fn wants(&self, stamp: Revision) -> bool {
        match &self.pending {
            Some((pending, _)) => *pending == stamp,
            None => self.running().is_some_and(|running| running.stamp == stamp),
        }
    }

    /// Whether anything wanted is running or pending.
    pub fn is_busy(&self) -> bool {
        self.pending.is_some() || self.running().is_some()
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test that can't go on fails")]
mod tests {
    use super::JobQueue;
    use crate::Revision;

    #[test]
    fn one_runs_and_the_newest_waits() {
        let mut queue = JobQueue::default();
        queue.request(Revision(1), "a");
        assert_eq!(queue.start_next().unwrap().1, "a");
        queue.request(Revision(2), "b");
        queue.request(Revision(3), "c");
        assert!(queue.start_next().is_none(), "one at a time");
        assert!(queue.finish(Revision(2)).is_none(), "it never ran");
        assert!(queue.finish(Revision(1)).is_some());
        assert_eq!(queue.start_next().unwrap().1, "c");
        assert!(queue.wants(Revision(3)) && !queue.wants(Revision(2)));
    }

    #[test]
    fn a_cancelled_job_is_told_and_is_no_longer_busy_but_keeps_its_place_until_it_ends() {
        let mut queue = JobQueue::default();
        queue.request(Revision(1), ());
        let (running, ()) = queue.start_next().unwrap();
        queue.cancel();
        assert!(running.cancel.is_cancelled() && !queue.is_busy());
        queue.request(Revision(2), ());
        assert!(queue.start_next().is_none());
        assert!(queue.finish(Revision(1)).is_some());
        assert!(queue.start_next().is_some());
    }
}
