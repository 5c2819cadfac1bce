//! The bi-Laplacian method: its [`options`](Bilaplacian), its operator, its factored system and its frames. It is
//! linear: A d = 0, so a frame is a product with the handle bases [BK04, BS08].

mod columns;
mod declaration;
pub(crate) mod detail;
mod options;
mod parts;
mod plate;
pub(crate) mod solver;

pub(crate) use declaration::DECLARATION;
pub(crate) use options::STRETCHING;
pub use options::{Bilaplacian, BilaplacianOrder, Detail};
