//! The bi-Laplacian method: its [`options`](Bilaplacian), its operator, its factored system and its frames. It is
//! linear: A d = 0, so a frame is a product with the handle bases [BK04, BS08].

pub(crate) mod assembly;
mod boundaries;
mod capacitance;
mod columns;
mod continuity;
mod declaration;
pub(crate) mod detail;
pub(crate) mod elimination_plan;
pub(crate) mod factored;
mod held;
pub(crate) mod hubs;
pub(crate) mod loaded;
mod natural;
pub(crate) mod operator;
mod options;
mod parts;
mod plate;
pub(crate) mod refine;
pub(crate) mod setup;
mod solution;
pub(crate) mod solver;
mod springs;

pub(crate) use declaration::DECLARATION;
pub(crate) use options::STRETCHING;
pub use options::{Bilaplacian, BilaplacianOrder, Detail};
