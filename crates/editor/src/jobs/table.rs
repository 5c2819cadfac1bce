//! The table of background jobs. A new job is a row here, and the place that requests it and reads its result.
//!
//! The app gives the editor an [`Executor`]. The editor starts at most one job of each [`JobKind`] at a time and keeps
//! at most one more pending, the newest ([`JobQueue`](crate::JobQueue)); every job is stamped with its revision, and a
//! result whose revision is no longer wanted is dropped.

use std::sync::Arc;

use pliant_deform::{Budget, Ordering};
use pliant_mesh::{Cancel, Progress};

use super::both_sides::BothSides;
use super::compared::Compared;
use super::enclosed::Enclosed;
use super::flowed::Flowed;
use super::inspected::Inspected;
use super::intersections::Intersections;
use super::present_binding::PresentBinding;
use super::skinned::Skinned;
use super::slot::{Ended, Scheduled, Slot, Unfinished};
use super::solved::SolveResult;
use crate::pickable::Pickable;
use crate::region::{FoundLimb, Region};
use crate::revision::Revision;

/// A row: what the window says about a kind of job, and who waits for it.
struct Row {
    /// The job's activity, for the status line: "binding".
    doing: &'static str,
    /// Whether shape and regions are final only after it.
    is_awaited: bool,
    /// Whether the status line names it.
    is_named: bool,
    /// The state for which its result is.
    input: Input,
}

/// The state for which a job's result is: a change of it makes running jobs useless.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Input {
    /// Its request alone, or changes that only its own code knows.
    Request,
    /// Paint, reach, rest shape, stiffness and options.
    Problem,
    /// The drawn shape.
    Shape,
    /// The drawn shape; the last one's result is of use until the next one's has come.
    LastShape,
}

/// Makes the kinds of jobs, their results, and the slots from the rows: `slot: Kind(result) = row`.
macro_rules! jobs {
    ($($(#[$doc:meta])* $slot:ident: $kind:ident($result:ty) = $row:expr;)+) => {
        /// The jobs that the editor starts, by result.
        #[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
        pub enum JobKind {
            $($(#[$doc])* $kind,)+
        }

        impl JobKind {
            /// Every kind, in the order of the table.
            pub const ALL: &'static [Self] = &[$(Self::$kind),+];

            fn row(self) -> Row {
                match self {
                    $(Self::$kind => $row,)+
                }
            }
        }

        /// The result of a job.
        pub enum JobResult {
            $($(#[$doc])* $kind($result),)+
        }

        impl std::fmt::Debug for JobResult {
            fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                f.write_str(match self {
                    $(Self::$kind(_) => stringify!($kind),)+
                })
            }
        }

        /// All jobs, with their last results.
        #[derive(Default)]
        pub(crate) struct Slots {
            $($(#[$doc])* pub(crate) $slot: Slot<$result>,)+
        }

        impl Slots {
            pub(super) fn of(&self, kind: JobKind) -> &dyn Scheduled {
                match kind {
                    $(JobKind::$kind => &self.$slot,)+
                }
            }

            pub(super) fn of_mut(&mut self, kind: JobKind) -> &mut dyn Scheduled {
                match kind {
                    $(JobKind::$kind => &mut self.$slot,)+
                }
            }

            /// Another file: every job is cancelled, and every result dropped.
            pub(super) fn reset(&mut self, revision: Revision) {
                $(self.$slot.reset(revision);)+
            }

            /// A change of this state: jobs that use it are cancelled, and their results dropped.
            pub(super) fn renew(&mut self, input: Input, revision: Revision) {
                $(if JobKind::$kind.row().input == input {
                    self.$slot.renew(revision);
                })+
            }

            /// A change of this state: jobs that use it are of use until those for the new state have ended.
            pub(super) fn follow(&mut self, input: Input, revision: Revision) {
                $(if JobKind::$kind.row().input == input {
                    self.$slot.follow(revision);
                })+
            }

            /// Starts the waiting jobs that can start.
            pub(super) fn start(&mut self, executor: &mut dyn Executor) {
                $(if let Some((running, work)) = self.$slot.start_next() {
                    let (progress, cancel) = (running.progress.clone(), running.cancel.clone());
                    executor.start(Job {
                        kind: JobKind::$kind,
                        stamp: running.stamp,
                        progress: running.progress,
                        cancel: running.cancel,
                        work: Box::new(move || work(&progress, &cancel).map(JobResult::$kind)),
                    });
                })+
            }

            /// Stores the outcome of a job.
            pub(super) fn finish(&mut self, done: JobDone) -> Ended {
                match (done.kind, done.outcome) {
                    $((JobKind::$kind, Ok(JobResult::$kind(result))) => self.$slot.finish(done.stamp, Ok(result)),)+
                    $((JobKind::$kind, Err(unfinished)) => self.$slot.finish(done.stamp, Err(unfinished)),)+
                    // An executor gives a job's own result back.
                    _ => Ended::Dropped,
                }
            }
        }
    };
}

jobs! {
    /// The hierarchy for picking under the pointer, built or refitted to the present shape.
    pick: Pick(Pickable) = Row {
        doing: "preparing the surface for the pointer",
        is_awaited: false,
        is_named: true,
        input: Input::LastShape,
    };
    /// The mesh's fill-reducing ordering, made once per mesh and operator power.
    order: Order(Arc<Ordering>) = Row {
        doing: "ordering the equations",
        is_awaited: true,
        is_named: true,
        input: Input::Request,
    };
    /// The vertices that each handle's reach sets free.
    region: Region(Region) = Row {
        doing: "measuring the region",
        is_awaited: true,
        is_named: true,
        input: Input::Problem,
    };
    /// The factorisation for the present regions, ready for steps.
    bind: Bind(Box<PresentBinding>) = Row {
        doing: "binding",
        is_awaited: true,
        is_named: true,
        input: Input::Problem,
    };
    /// The surface, or the control points alone, for the present handle transforms.
    solve: Solve(SolveResult) = Row {
        doing: "bending",
        is_awaited: true,
        is_named: false,
        input: Input::Request,
    };
    /// The vertices of a region's mirror image, ascending.
    mirror: Mirror(Vec<usize>) = Row {
        doing: "computing the mirror image",
        is_awaited: true,
        is_named: true,
        input: Input::Request,
    };
    /// The plane across which the shape is its own mirror image, and the pairs of vertices; `None` if it has none.
    symmetry: Symmetry(Option<Arc<BothSides>>) = Row {
        doing: "finding the plane of symmetry",
        is_awaited: true,
        is_named: true,
        input: Input::Request,
    };
    /// The vertices inside an outline on the screen, or along a line.
    enclose: Enclose(Enclosed) = Row {
        doing: "finding the enclosed vertices",
        is_awaited: true,
        is_named: true,
        input: Input::Request,
    };
    /// Another method's result for the edit.
    compare: Compare(Box<Compared>) = Row {
        doing: "comparing methods",
        is_awaited: false,
        is_named: false,
        input: Input::Request,
    };
    /// Weights or base of the present binding, for display.
    inspect: Inspect(Inspected) = Row {
        doing: "inspecting the binding",
        is_awaited: true,
        is_named: false,
        input: Input::Request,
    };
    /// The joint of the limb under the pointer; `None` if there is none.
    joint: Joint(Option<FoundLimb>) = Row {
        doing: "finding the joint",
        is_awaited: false,
        is_named: false,
        input: Input::Request,
    };
    /// The shapes of the moments around the shown one.
    skins: Skins(Box<Skinned>) = Row {
        doing: "solving the moments around",
        is_awaited: false,
        is_named: false,
        input: Input::Request,
    };
    /// A step of the flow on the surface.
    flow: Flow(Box<Flowed>) = Row {
        doing: "flowing",
        is_awaited: false,
        is_named: false,
        input: Input::Request,
    };
    /// The places where the present shape passes through itself.
    intersect: Intersect(Intersections) = Row {
        doing: "finding places where the shape passes through itself",
        is_awaited: false,
        is_named: false,
        input: Input::Shape,
    };
}

impl JobKind {
    /// The job's activity, for the status line: "binding".
    pub fn doing(self) -> &'static str {
        self.row().doing
    }

    /// Whether shape and regions are final only after it. An ordering is awaited only if something is bent.
    pub fn is_awaited(self) -> bool {
        self.row().is_awaited
    }

    /// Whether the status line names it.
    pub(crate) fn is_named(self) -> bool {
        self.row().is_named
    }
}

/// A piece of work for the executor. The executor calls `work` once, off the window's thread, and sends every outcome
/// back as [`Event::JobDone`](crate::Event::JobDone) with the same kind and stamp.
pub struct Job {
    /// The kind of the result.
    pub kind: JobKind,
    /// The revision for which it was made.
    pub stamp: Revision,
    /// Its progress; shared with the work.
    pub progress: Progress,
    /// Raised by the editor when the result is no longer wanted; shared with the work.
    pub cancel: Cancel,
    /// The work itself.
    pub work: Box<dyn FnOnce() -> JobOutcome + Send>,
}

/// The outcome of a job.
pub type JobOutcome = Result<JobResult, Unfinished>;

impl Job {
    /// Does the work on the caller's thread.
    pub fn run(self) -> JobDone {
        let Self { kind, stamp, work, .. } = self;
        JobDone {
            kind,
            stamp,
            outcome: work(),
        }
    }
}

impl std::fmt::Debug for Job {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Job")
            .field("kind", &self.kind)
            .field("stamp", &self.stamp)
            .finish_non_exhaustive()
    }
}

/// The end of a job.
#[derive(Debug)]
pub struct JobDone {
    /// The kind of the job.
    pub kind: JobKind,
    /// The revision for which it was made.
    pub stamp: Revision,
    /// Its outcome.
    pub outcome: JobOutcome,
}

/// The answer to [`Executor::large_mesh`] of an executor that has no other.
pub(super) const LARGE_MESH: usize = 1_000_000;

/// The place where jobs run. The app's executor has threads; a test's has a list.
pub trait Executor {
    /// Takes a job and returns at once (or, for a tiny program, does the work first). The result comes back as
    /// [`Event::JobDone`](crate::Event::JobDone), never by calling the editor from here. The answer to a job that
    /// panics must be [`Unfinished::Failed`].
    fn start(&mut self, job: Job);

    /// The memory that a binding may use, given a person's limit in bytes, if there is one; a job asks for it at its
    /// beginning, on its own thread.
    fn budget(&self) -> fn(Option<u64>) -> Budget {
        Budget::of_most
    }

    /// The fewest vertices of a mesh whose equations are ordered by region, because ordering all of them would take
    /// longer than everything else.
    fn large_mesh(&self) -> usize {
        LARGE_MESH
    }

    /// The time in milliseconds since some moment, for figures that a person reads, the pace of frames and the speed of a
    /// stroke of the flow brush. It is constant in an executor that does not measure.
    fn clock_ms(&self) -> fn() -> f64 {
        || 0.0
    }
}
