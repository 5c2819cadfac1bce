//! One kind of job with its last result, and the states for which both were made.

use pliant_mesh::{Cancel, Cancelled, Progress};

use super::job_queue::{JobQueue, Running};
use crate::revision::Revision;

/// A job's work, given a progress to report to and a flag that cancels it.
pub(crate) type Work<T> = Box<dyn FnOnce(&Progress, &Cancel) -> Result<T, Unfinished> + Send>;

/// The reason why a job has no result.
#[derive(Clone, PartialEq, Eq, Debug)]
pub enum Unfinished {
    /// It was cancelled.
    Cancelled,
    /// It failed, with one sentence that names the culprit and the remedy.
    Failed(String),
}

impl From<Cancelled> for Unfinished {
    fn from(_: Cancelled) -> Self {
        Self::Cancelled
    }
}

/// The end of a job, as its slot sees it.
pub(super) enum Ended {
    /// The slot has a new result.
    Stored,
    /// The result was for a past state.
    Dropped,
    /// Nobody here cancelled it, yet it was; requesting it again at once could go on for ever.
    Stopped,
    /// It failed for the present state, in one sentence.
    Failed(String),
}

/// One kind of job: its queue, its last result, and the states for which they are.
pub(crate) struct Slot<T> {
    queue: JobQueue<Work<T>>,
    /// The state for which a job would be made now.
    wanted: Revision,
    /// Results for earlier states are dropped.
    floor: Revision,
    /// The state whose job failed or was stopped by the person, which is not tried again.
    given_up: Option<Revision>,
    /// The state of the last result.
    made: Revision,
    last: Option<T>,
}

impl<T> Default for Slot<T> {
    fn default() -> Self {
        Self {
            queue: JobQueue::default(),
            wanted: Revision(0),
            floor: Revision(0),
            given_up: None,
            made: Revision(0),
            last: None,
        }
    }
}

/// The states.
impl<T> Slot<T> {
    /// Another state: what is under way is still of use until its own job has ended.
    pub(super) fn follow(&mut self, revision: Revision) {
        self.wanted = revision;
    }

    /// Another state, for which the jobs under way are of no use: they are cancelled, and their results dropped.
    pub(super) fn renew(&mut self, revision: Revision) {
        self.queue.cancel();
        self.wanted = revision;
        self.floor = revision;
    }

    /// Another file: as [`renew`](Self::renew), and the last result is dropped too.
    pub(super) fn reset(&mut self, revision: Revision) {
        self.renew(revision);
        (self.given_up, self.made, self.last) = (None, Revision(0), None);
    }

    /// The state for which a job would be made now.
    pub(super) fn wanted(&self) -> Revision {
        self.wanted
    }

    /// The state of the last result, also after that was taken.
    pub(super) fn made(&self) -> Revision {
        self.made
    }

    /// Whether the last result is for the present state.
    pub(super) fn is_current(&self) -> bool {
        self.made == self.wanted
    }

    /// Whether a job for the present state neither runs nor waits, nor was given up.
    pub(super) fn may_request(&self) -> bool {
        !self.queue.wants(self.wanted) && !self.has_given_up()
    }

    /// Whether the job for the present state failed or was stopped.
    pub(super) fn has_given_up(&self) -> bool {
        self.given_up == Some(self.wanted)
    }

    /// Lets a job that failed or was stopped be requested again.
    pub(super) fn try_again(&mut self) {
        self.given_up = None;
    }
}

/// The jobs.
impl<T> Slot<T> {
    /// Requests a job for the present state. It replaces a waiting one.
    pub(super) fn request(&mut self, work: Work<T>) {
        self.queue.request(self.wanted, work);
    }

    /// The waiting job, if it can start; the caller must start it.
    pub(super) fn start_next(&mut self) -> Option<(Running, Work<T>)> {
        self.queue.start_next()
    }

    /// Stores the outcome of a job for this state.
    pub(super) fn finish(&mut self, stamp: Revision, outcome: Result<T, Unfinished>) -> Ended {
        let Some(running) = self.queue.finish(stamp) else {
            return Ended::Dropped;
        };
        match outcome {
            Ok(result) if stamp >= self.floor => {
                self.made = stamp;
                self.last = Some(result);
                Ended::Stored
            }
            Err(unfinished) if !running.cancel.is_cancelled() => {
                self.given_up = Some(stamp);
                match unfinished {
                    Unfinished::Cancelled => Ended::Stopped,
                    Unfinished::Failed(sentence) if stamp == self.wanted => Ended::Failed(sentence),
                    Unfinished::Failed(_) => Ended::Dropped,
                }
            }
            _ => Ended::Dropped,
        }
    }
}

/// The last result.
impl<T> Slot<T> {
    /// The last result, for any state.
    pub(crate) fn last(&self) -> Option<&T> {
        self.last.as_ref()
    }

    /// The last result, for any state.
    pub(super) fn last_mut(&mut self) -> Option<&mut T> {
        self.last.as_mut()
    }

    /// The last result, which is then no longer here.
    pub(crate) fn take(&mut self) -> Option<T> {
        self.last.take()
    }

    /// The result for the present state.
    pub(crate) fn current(&self) -> Option<&T> {
        self.last.as_ref().filter(|_| self.is_current())
    }
}

/// The part of a slot that does not depend on its result.
pub(super) trait Scheduled {
    /// Cancels the running job and forgets the waiting one; a result that has already been sent still counts.
    fn cancel(&mut self);

    /// Cancels the jobs under way; they are requested again only in another state.
    fn give_up(&mut self);

    /// Whether a job runs or waits.
    fn is_busy(&self) -> bool;

    /// The running job, unless it was cancelled.
    fn running(&self) -> Option<&Running>;
}

impl<T> Scheduled for Slot<T> {
    fn cancel(&mut self) {
        self.queue.cancel();
    }

    fn give_up(&mut self) {
        if self.queue.is_busy() {
            self.queue.cancel();
            self.given_up = Some(self.wanted);
        }
    }

    fn is_busy(&self) -> bool {
        self.queue.is_busy()
    }

    fn running(&self) -> Option<&Running> {
        self.queue.running()
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test that can't go on fails")]
mod tests {
    use super::{Ended, Scheduled, Slot, Unfinished};
    use crate::Revision;

    /// A slot whose job for the first state runs.
    fn running() -> Slot<u32> {
        let mut slot = Slot::default();
        slot.follow(Revision(1));
        slot.request(Box::new(|_, _| Ok(1)));
        assert!(slot.start_next().is_some());
        slot
    }

    #[test]
    fn a_result_for_a_followed_state_counts_and_one_for_a_renewed_state_is_dropped() {
        let mut followed = running();
        followed.follow(Revision(2));
        assert!(matches!(followed.finish(Revision(1), Ok(1)), Ended::Stored));
        assert!(followed.last() == Some(&1) && followed.current().is_none() && followed.may_request());

        let mut renewed = running();
        renewed.renew(Revision(2));
        assert!(matches!(renewed.finish(Revision(1), Ok(1)), Ended::Dropped));
        assert!(renewed.last().is_none());
    }

    #[test]
    fn a_failed_or_stopped_job_is_requested_again_only_in_another_state() {
        let failure = || Err(Unfinished::Failed("it broke".to_owned()));
        let mut failed = running();
        assert!(matches!(failed.finish(Revision(1), failure()), Ended::Failed(_)));
        let mut stopped = running();
        stopped.give_up();
        assert!(matches!(stopped.finish(Revision(1), failure()), Ended::Dropped));
        for slot in [&mut failed, &mut stopped] {
            assert!(slot.has_given_up() && !slot.may_request());
            slot.follow(Revision(2));
            assert!(!slot.has_given_up() && slot.may_request());
        }
    }
}
