//! What follows from the document and is computed beside the window: the jobs, their queues and their last results.

mod alternative;
mod both_sides;
mod bound_controls;
mod carried;
mod compared;
mod comparison;
mod computed;
mod inline_executor;
mod inspected;
mod inspection;
mod intersections;
mod job;
mod job_queue;
mod region;
mod rim;
mod scheduler;
mod solving;
mod work;

pub use alternative::Alternative;
pub use both_sides::{BothSides, Symmetry};
pub(crate) use bound_controls::BoundControls;
pub use compared::{Compared, Figures};
pub use comparison::Comparison;
pub(crate) use computed::Computed;
pub use inline_executor::InlineExecutor;
pub(crate) use inspected::Asked;
pub use inspected::{Inspectable, Inspected};
pub use intersections::{IntersectionPlace, Intersections};
pub(crate) use job::Pickable;
pub use job::{ControlPlaces, Descent, Executor, Job, JobDone, JobKind, JobOutcome, Revision, Solved};
pub use job_queue::{JobQueue, Running};
pub use region::{Counts, Region};
pub(crate) use region::{FileContacts, centroid, reach_length, region_input};
pub use rim::Rim;
pub(crate) use rim::bounded;
pub(crate) use scheduler::{Activity, Arrival, Finality, Jobs};
