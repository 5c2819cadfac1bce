//! The linear shell: `bilaplacian`'s [`options`](Bilaplacian), its operator, its factored system and its frames.

pub(crate) mod assembly;
pub(crate) mod bases;
mod bilaplacian;
mod continuity;
mod declaration;
pub(crate) mod factored;
pub(crate) mod hubs;
pub(crate) mod operator;
pub(crate) mod plate;
mod refine;
mod slender;
mod springs;

pub use bases::HandleBases;
pub use bilaplacian::{Bilaplacian, Discretisation, ShellOrder, Triangulation};
pub(crate) use declaration::DECLARATION;
