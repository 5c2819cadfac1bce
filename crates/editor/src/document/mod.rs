//! What a person edits, and how it is undone: paint, handles, options, the shape they have brought about.

mod access;
mod content;
mod handle;
mod handle_colour;
mod handle_motion;
mod handle_transform;
mod history;
mod kept_shape;
mod mirror_plane;
mod polar;
mod sparse;
mod state;
mod strength;
mod transaction;
mod turn;
mod version;
mod vertex_access;

pub use access::{Access, ObjectAction, object_name};
pub(crate) use content::sum_of_shapes;
pub use content::{Content, Paint, Tips};
pub use handle::{Handle, HandleId, PivotPlace, Reach, Twin};
pub use handle_colour::HANDLE_COLOURS;
pub use handle_transform::HandleTransform;
pub use history::{HISTORY_BYTES, History};
pub use kept_shape::KeptShape;
pub use mirror_plane::MirrorPlane;
pub(crate) use sparse::bits_equal;
pub use state::Document;
pub(crate) use state::Repainted;
pub(crate) use strength::attachment_part;
pub(crate) use transaction::Transaction;
pub(crate) use turn::{accumulated, followed, means, rotation_of};
pub(crate) use version::{Aspect, Version, Versions};
pub(crate) use vertex_access::VertexAccess;
