//! Work that must not block the window: its kinds, its start and its results.
//!
//! The app gives the editor an [`Executor`]. The editor starts at most one job of each [`JobKind`] at a time and keeps
//! at most one more pending, the newest ([`JobQueue`](crate::JobQueue)); every job is stamped with its revision, and a
//! result whose revision is no longer wanted is dropped.

use std::sync::Arc;

use glam::{DVec3, Mat3};
use pliant_deform::{Bound, Budget, Ordering};
use pliant_mesh::{Cancel, Joint, Progress, SurfaceVertex};

use super::both_sides::BothSides;
use super::carried::Carried;
use super::compared::Compared;
use super::inspected::{Inspectable, Inspected};
use super::intersections::Intersections;
use crate::pickable::Pickable;
use crate::region::Region;
use crate::revision::Revision;
use crate::warning::HandleWarning;

/// The jobs that the editor starts, by result.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub enum JobKind {
    /// The hierarchy for picking under the pointer, built or refitted to the present shape.
    Pick,
    /// The mesh's fill-reducing ordering, made once per mesh and operator power.
    Order,
    /// The vertices that each handle's reach sets free.
    Region,
    /// The factorisation for the present regions.
    Bind,
    /// The surface for the present handle transforms.
    Solve,
    /// The mirror image of a region.
    Mirror,
    /// The plane across which the shape is its own mirror image, and the pairs of vertices.
    Symmetry,
    /// The vertices inside an outline on the screen.
    Enclose,
    /// Another method's result for the edit.
    Compare,
    /// Weights or base of the present binding, for display.
    Inspect,
    /// The joint of the limb under the pointer.
    Joint,
    /// The places where the present shape passes through itself.
    Intersect,
}

impl JobKind {
    /// Every kind, in the order of their dependence.
    pub const ALL: [Self; 12] = [
        Self::Pick,
        Self::Order,
        Self::Region,
        Self::Bind,
        Self::Solve,
        Self::Mirror,
        Self::Symmetry,
        Self::Enclose,
        Self::Compare,
        Self::Inspect,
        Self::Joint,
        Self::Intersect,
    ];

    /// The job's activity, for the status line: "binding".
    pub fn doing(self) -> &'static str {
        match self {
            Self::Pick => "preparing the surface for the pointer",
            Self::Order => "ordering the equations",
            Self::Region => "measuring the region",
            Self::Bind => "binding",
            Self::Solve => "bending",
            Self::Mirror => "computing the mirror image",
            Self::Symmetry => "finding the plane of symmetry",
            Self::Enclose => "finding the enclosed vertices",
            Self::Compare => "comparing methods",
            Self::Inspect => "inspecting the binding",
            Self::Joint => "finding the joint",
            Self::Intersect => "finding places where the shape passes through itself",
        }
    }
}

/// A job's work, given a progress to report to and a flag that cancels it.
pub(crate) type Work = Box<dyn FnOnce(&Progress, &Cancel) -> JobOutcome + Send>;

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

/// The place where jobs run. The app's executor has threads; a test's has a list.
pub trait Executor {
    /// Takes a job and returns at once (or, for a tiny program, does the work first). The result comes back as
    /// [`Event::JobDone`](crate::Event::JobDone), never by calling the editor from here. The answer to a job that
    /// panics must be [`JobOutcome::Failed`].
    fn start(&mut self, job: Job);

    /// The memory that a binding may use, given a person's limit in bytes, if there is one; a job asks for it at its
    /// beginning, on its own thread.
    fn budget(&self) -> fn(Option<u64>) -> Budget {
        Budget::of_most
    }

    /// The time in milliseconds since some moment, only for figures that a person reads. It is constant in an executor
    /// that does not measure.
    fn clock_ms(&self) -> fn() -> f64 {
        || 0.0
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

/// The outcome of a job.
pub enum JobOutcome {
    /// The picking structure of a shape.
    Pick(Pickable),
    /// The mesh's ordering.
    Ordered(Arc<Ordering>),
    /// The region that the handles reach.
    Region(Region),
    /// A factorisation, ready for steps, and its parts that can be shown.
    Bound(Box<Bound>, Inspectable),
    /// A new shape.
    Solved(Solved),
    /// The positions of the control points.
    Controls(ControlPlaces),
    /// The vertices of a region's mirror image, ascending.
    Mirrored(Vec<usize>),
    /// Both sides of the plane of symmetry; `None` if the shape has none.
    Symmetry(Option<Arc<BothSides>>),
    /// The vertices inside an outline, ascending.
    Enclosed(Vec<SurfaceVertex>),
    /// A method's result for the edit.
    Compared(Box<Compared>),
    /// The values from the binding.
    Inspected(Inspected),
    /// The joint of a limb; `None` if there is none.
    Joint(Option<Arc<Joint>>),
    /// The places where the shape passes through itself.
    Intersections(Intersections),
    /// It was cancelled and has no result.
    Cancelled,
    /// It failed, with one sentence that names the culprit and the remedy.
    Failed(String),
}

impl std::fmt::Debug for JobOutcome {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::Pick(..) => "Pick",
            Self::Ordered(_) => "Ordered",
            Self::Region(_) => "Region",
            Self::Bound(..) => "Bound",
            Self::Solved(_) => "Solved",
            Self::Controls(_) => "Controls",
            Self::Mirrored(_) => "Mirrored",
            Self::Symmetry(_) => "Symmetry",
            Self::Enclosed(_) => "Enclosed",
            Self::Compared(_) => "Compared",
            Self::Inspected(_) => "Inspected",
            Self::Joint(_) => "Joint",
            Self::Intersections(_) => "Intersections",
            Self::Cancelled => "Cancelled",
            Self::Failed(sentence) => return write!(f, "Failed({sentence})"),
        })
    }
}

/// A solve's result, after as many steps as a frame has time for: displacements per surface vertex.
#[derive(Clone, Debug)]
pub struct Solved {
    /// Displacements from the present rest shape.
    pub from_rest: Arc<Vec<DVec3>>,
    /// Displacements from the file's shape, which are drawn. This is the same allocation if no shape was applied.
    pub from_file: Arc<Vec<DVec3>>,
    /// The Jacobian of the displacements at each surface vertex, if the method knows it and has made `from_file`:
    /// normals turn by it, independent of the triangles.
    pub jacobians: Option<Vec<Mat3>>,
    /// The positions of the method's control points; `None` if it has none.
    pub(crate) controls: Option<ControlPlaces>,
    /// The solution behind it, if it continues a kept shape.
    pub(crate) carried: Option<Carried>,
    /// The motions in these targets that the method can't follow.
    pub(crate) blind_to: Vec<HandleWarning>,
    /// The examples' weights that were used or found.
    pub(crate) example_weights: Vec<f64>,
    /// Whether further steps would not change it.
    pub finished: bool,
    /// The progress of an iterative method's descent; `None` for a method with a single step.
    pub descent: Option<Descent>,
}

/// The positions of control points.
#[derive(Clone, Debug)]
pub struct ControlPlaces {
    /// Moved by handles and by hand.
    pub(super) positions: Arc<Vec<DVec3>>,
    /// Moved by hand alone.
    pub(super) moved: Arc<Vec<DVec3>>,
}

impl ControlPlaces {
    /// The positions for the present targets of a binding; `None` for a method without control points.
    pub(super) fn of(bound: &Bound) -> Option<Self> {
        let (_, attachment) = bound.attachment()?;
        Some(Self {
            positions: Arc::new(bound.control_positions()),
            moved: Arc::clone(attachment.moved()?),
        })
    }
}

/// The progress of a descent.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Descent {
    /// The present shape's energy, without unit (see [`pliant_deform::Step::energy`]).
    pub energy: f64,
    /// Whether that is the minimum, to the method's tolerance.
    pub converged: bool,
    /// Whether no further step follows: it converged, or met the method's limit.
    pub finished: bool,
}
