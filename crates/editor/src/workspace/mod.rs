//! What is done to the document, and what follows from it.

mod colours;
mod consequences;
mod dirty_colours;
mod following;
mod handle_values;
mod handles;
mod mirror;
mod objects;
mod regions;
mod snapshot;

pub use colours::stiffness_colour;
pub(crate) use consequences::is_other_problem;
pub(crate) use dirty_colours::DirtyColours;
pub(crate) use mirror::{Mirroring, Purpose};
pub use regions::RegionAction;
pub use snapshot::{Snapshot, SnapshotKey};
