//! Work that must not hold up the window: what it is, how it is handed out and how its results come back.
//!
//! The app gives the editor an [`Executor`]. The editor starts at most one job of each [`JobKind`] at a time and keeps
//! at most one more pending, the newest ([`JobQueue`](crate::JobQueue)); every job is stamped with the revision it was
//! made for, and a result whose revision is no longer wanted is dropped.

use std::sync::Arc;

use glam::{DVec3, Mat3};
use pliant_deform::{Bound, Budget, Ordering};
use pliant_mesh::{Bvh, Cancel, Joint, Progress, SurfaceVertex};

use super::both_sides::BothSides;
use super::carried::Carried;
use super::compared::Compared;
use super::inspected::{Inspectable, Inspected};
use super::intersections::Intersections;
use super::region::Region;
use crate::warning::HandleWarning;

/// The jobs the editor hands out, by what they make.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub enum JobKind {
    /// The structure that answers "what is under the pointer", built or refitted to the present shape.
    Pick,
    /// The mesh's fill-reducing ordering, made once per mesh and operator power.
    Order,
    /// Which vertices each handle's reach sets free.
    Region,
    /// The factorisation for the present regions.
    Bind,
    /// The surface for the present handle transforms.
    Solve,
    /// The mirror image of a region.
    Mirror,
    /// The plane across which the shape is its own mirror image, and what goes with what.
    Symmetry,
    /// The vertices that an outline on the screen holds.
    Enclose,
    /// What another method makes of the edit.
    Compare,
    /// Weights or base of the present binding, to be looked at.
    Inspect,
    /// The joint of the limb under the pointer.
    Joint,
    /// Where the present shape passes through itself.
    Intersect,
}

impl JobKind {
    /// Every kind, in the order in which their results build on one another.
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

    /// What the job does, for the status line: "binding".
    pub fn doing(self) -> &'static str {
        match self {
            Self::Pick => "getting the surface ready for the pointer",
            Self::Order => "ordering the equations",
            Self::Region => "measuring the region",
            Self::Bind => "binding",
            Self::Solve => "bending",
            Self::Mirror => "looking for the mirror image",
            Self::Symmetry => "looking for the plane of symmetry",
            Self::Enclose => "looking for what is inside",
            Self::Compare => "comparing methods",
            Self::Inspect => "looking into the binding",
            Self::Joint => "looking for the joint",
            Self::Intersect => "looking for where the shape passes through itself",
        }
    }
}

/// The number of the state that a job was made for. Numbers only grow; none is used twice.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug, Default)]
pub struct Revision(pub u64);

/// What a job does, given where to tell its way and what stops it.
pub(crate) type Work = Box<dyn FnOnce(&Progress, &Cancel) -> JobOutcome + Send>;

/// A piece of work for the executor. `work` is to be called once, off the window's thread, and its outcome sent back
/// as [`Event::JobDone`](crate::Event::JobDone) with the same kind and stamp, whatever the outcome.
pub struct Job {
    /// What the job makes.
    pub kind: JobKind,
    /// The revision it was made for.
    pub stamp: Revision,
    /// How far it is; shared with the work.
    pub progress: Progress,
    /// Raised by the editor when the result is no longer wanted; shared with the work.
    pub cancel: Cancel,
    /// The work itself.
    pub work: Box<dyn FnOnce() -> JobOutcome + Send>,
}

impl Job {
    /// Does the work here and now.
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

/// Where jobs run. The app's executor has threads; a test's has a list.
pub trait Executor {
    /// Takes a job and returns at once (or, for a tiny program, does the work first). The result comes back as
    /// [`Event::JobDone`](crate::Event::JobDone), never by calling the editor from here. A job that panics is to be
    /// answered with [`JobOutcome::Failed`].
    fn start(&mut self, job: Job);

    /// Tells how much memory a binding may take, given the most bytes that a person allows, if one has said so; a job
    /// asks it when it begins, on the thread that it runs on.
    fn budget(&self) -> fn(Option<u64>) -> Budget {
        Budget::of_most
    }

    /// Tells the time in milliseconds since some moment, for figures that a person reads and for nothing else. It stands
    /// still where nobody measures.
    fn clock_ms(&self) -> fn() -> f64 {
        || 0.0
    }
}

/// What rays are answered from.
#[derive(Clone)]
pub struct Pickable {
    /// The hierarchy over the triangles that are shown, in their shape.
    pub(crate) bvh: Bvh,
    /// Which of the surface's triangles it is over.
    pub(crate) shown: ShownTriangles,
}

/// Triangles of the surface that rays may meet.
#[derive(Clone, Default)]
pub(crate) struct ShownTriangles {
    /// Another one for every other set of triangles.
    pub(super) revision: Revision,
    /// Their numbers, ascending; `None` is all of them.
    pub(crate) triangles: Option<Arc<Vec<u32>>>,
}

/// The end of a job.
#[derive(Debug)]
pub struct JobDone {
    /// What the job made.
    pub kind: JobKind,
    /// The revision it was made for.
    pub stamp: Revision,
    /// What came of it.
    pub outcome: JobOutcome,
}

/// What came of a job.
pub enum JobOutcome {
    /// The picking structure of a shape.
    Pick(Pickable),
    /// The mesh's ordering.
    Ordered(Arc<Ordering>),
    /// The region that the handles reach.
    Region(Region),
    /// A factorisation, ready to be stepped, and what of it can be looked at.
    Bound(Box<Bound>, Inspectable),
    /// A new shape.
    Solved(Solved),
    /// Where the control points are.
    Controls(ControlPlaces),
    /// The vertices of a region's mirror image, ascending.
    Mirrored(Vec<usize>),
    /// Both sides of the plane of symmetry; `None` where the shape has none.
    Symmetry(Option<Arc<BothSides>>),
    /// The vertices that an outline holds, ascending.
    Enclosed(Vec<SurfaceVertex>),
    /// What a method makes of the edit.
    Compared(Box<Compared>),
    /// What was found in the binding.
    Inspected(Inspected),
    /// The joint of a limb; `None` where there is none.
    Joint(Option<Arc<Joint>>),
    /// Where the shape passes through itself.
    Intersections(Intersections),
    /// It was cancelled, and nothing is owed.
    Cancelled,
    /// It failed; one sentence that names the culprit and the remedy.
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
    /// From the present rest shape.
    pub from_rest: Arc<Vec<DVec3>>,
    /// From the file's shape: what is drawn. The same allocation while nothing was applied.
    pub from_file: Arc<Vec<DVec3>>,
    /// The Jacobian of the displacements at each surface vertex, where the method knows it and `from_file` is what it has
    /// made: normals turn by it, whatever the triangles are.
    pub jacobians: Option<Vec<Mat3>>,
    /// Where the method's control points are; `None` if it has none.
    pub(crate) controls: Option<ControlPlaces>,
    /// The solution behind it, where it carries what was seen before along.
    pub(crate) carried: Option<Carried>,
    /// What the method can't follow of these targets.
    pub(crate) blind_to: Vec<HandleWarning>,
    /// The examples' weights that were taken or found.
    pub(crate) example_weights: Vec<f64>,
    /// Whether further steps would leave it as it is.
    pub finished: bool,
    /// How far an iterative method's descent is; `None` for a method that is done in one step.
    pub descent: Option<Descent>,
}

/// Where control points are.
#[derive(Clone, Debug)]
pub struct ControlPlaces {
    /// Moved by handles and by hand.
    pub(super) positions: Arc<Vec<DVec3>>,
    /// Where the hand alone has moved them.
    pub(super) moved: Arc<Vec<DVec3>>,
}

impl ControlPlaces {
    /// With the present targets of a binding; `None` for a method without control points.
    pub(super) fn of(bound: &Bound) -> Option<Self> {
        let (_, attachment) = bound.attachment()?;
        Some(Self {
            positions: Arc::new(bound.control_positions()),
            moved: Arc::clone(attachment.moved()?),
        })
    }
}

/// How far a descent is.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Descent {
    /// The present shape's energy, without unit (see [`pliant_deform::Step::energy`]).
    pub energy: f64,
    /// Whether that is the least, to the method's tolerance.
    pub converged: bool,
    /// Whether no further step is taken: it converged, or met the method's limit.
    pub finished: bool,
}
