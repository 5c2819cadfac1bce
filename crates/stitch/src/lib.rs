//! Changes of topology: cutting, filling holes, and joining two surfaces.

mod borders;
mod crossing;
mod error;
mod fill;

pub use borders::{Border, Borders};
pub use error::{BorderFault, StitchError};
pub use fill::{Filled, FilledHole, Holes, fill};
