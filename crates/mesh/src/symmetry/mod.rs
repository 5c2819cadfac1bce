//! Mirror symmetry: a plane, the shape's own plane, and the vertices that are each other's images across it.

mod counterparts;
mod grown;
mod of_points;
mod plane;
mod search;

pub use counterparts::{Counterparts, image_of};
pub use of_points::mirror_planes;
pub use plane::MirrorPlane;
pub use search::symmetry_plane;
