//! What a person edits, and how it is undone: paint, handles, options, the shape they have brought about.

mod access;
mod handle_colour;
mod handle_motion;
mod handle_transform;
mod history;
mod polar;
mod state;
mod transaction;
mod turn;

pub(crate) use access::Masks;
pub use access::{Access, ObjectAction, object_name};
pub use handle_colour::HANDLE_COLOURS;
pub use handle_transform::HandleTransform;
pub(crate) use history::{Change, Sparse, bits_equal};
pub use history::{HISTORY_BYTES, History};
pub(crate) use state::sum_of_shapes;
pub use state::{Document, Handle, HandleId, MirrorPlane, Paint, PivotPlace, Twin};
pub(crate) use transaction::Transaction;
pub(crate) use turn::{accumulated, followed, means, rotation_of};
