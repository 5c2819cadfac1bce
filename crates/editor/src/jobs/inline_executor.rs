//! An executor without threads: jobs wait in a list until the caller runs them on its own thread.
//!
//! It is for tests and scripts. The caller chooses order and moment, so lateness, cancellation and stale results can be
//! tested without a clock.

use std::cell::RefCell;
use std::collections::VecDeque;
use std::rc::Rc;

use super::table::{Executor, Job, JobDone, JobKind, LARGE_MESH};

/// A list of waiting jobs. Clones share the list: one goes to the editor, one stays with the caller.
#[derive(Clone, Debug, Default)]
pub struct InlineExecutor {
    waiting: Rc<RefCell<VecDeque<Job>>>,
    /// The answer to [`Executor::large_mesh`], if it is not the usual one.
    large_mesh: Option<usize>,
}

impl InlineExecutor {
    /// An empty list.
    pub fn new() -> Self {
        Self::default()
    }

    /// An empty list, whose editor takes meshes of at least this many vertices for very large ones.
    pub fn with_large_mesh(vertices: usize) -> Self {
        Self {
            large_mesh: Some(vertices),
            ..Self::default()
        }
    }

    /// The kinds of the waiting jobs, in the order of their arrival.
    pub fn waiting(&self) -> Vec<JobKind> {
        self.waiting.borrow().iter().map(|job| job.kind).collect()
    }

    /// Runs the job with the longest wait.
    pub fn run_next(&self) -> Option<JobDone> {
        let job = self.waiting.borrow_mut().pop_front()?;
        Some(job.run())
    }

    /// Runs the job of this kind with the longest wait.
    pub fn run(&self, kind: JobKind) -> Option<JobDone> {
        self.take(kind).map(Job::run)
    }

    /// Removes the job of this kind with the longest wait from the list.
    pub fn take(&self, kind: JobKind) -> Option<Job> {
        let mut waiting = self.waiting.borrow_mut();
        let index = waiting.iter().position(|job| job.kind == kind)?;
        waiting.remove(index)
    }
}

impl Executor for InlineExecutor {
    fn start(&mut self, job: Job) {
        self.waiting.borrow_mut().push_back(job);
    }

    fn large_mesh(&self) -> usize {
        self.large_mesh.unwrap_or(LARGE_MESH)
    }
}
