//! Background computation from the document: the jobs, their queues and their last results.

mod allowance;
mod alternative;
mod both_sides;
mod bound_controls;
mod compared;
mod comparison;
mod computed;
mod inline_executor;
mod inspected;
mod inspection;
mod intersections;
mod job_queue;
mod present_binding;
mod requests;
mod scheduler;
mod slot;
mod solved;
mod solving;
mod table;
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
pub use job_queue::{JobQueue, Running};
pub use present_binding::PresentBinding;
pub(crate) use scheduler::{Activity, Arrival, Finality, Jobs};
pub use slot::Unfinished;
pub use solved::{ControlPlaces, Descent, SolveResult, Solved};
pub use table::{Executor, Job, JobDone, JobKind, JobOutcome, JobResult};
