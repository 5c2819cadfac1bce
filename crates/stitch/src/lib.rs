//! Changes of topology: cutting, filling holes, and joining two surfaces.

mod borders;
mod crossing;
mod cut;
mod dress;
mod error;
mod fill;
mod filled_shape;
mod merge;
mod part;
mod shape;

pub use borders::{Border, Borders};
pub use error::{BorderFault, StitchError};
pub use fill::{Filled, FilledHole, Holes, fill};
pub use merge::{Joins, MergeError, Merged, Pair, PlacementOfB, Seam, merge};
pub use part::{Attributes, Part};
pub use shape::{Age, NewShape, TriangleSource, VertexSource};
