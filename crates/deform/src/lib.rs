//! The core solver: a surface, the roles of its vertices and a method in; displacements out.
//!
//! Rates of change are types: [`Ordering`] changes with the mesh, [`Bound`] with roles, stiffness and options, and a
//! [`Bound::step`] with the handles' transforms. There is no clock here, no file, no thread of its own: rayon's
//! current pool is the caller's, and every result is the same bit for bit whatever its size.

mod bases;
mod bound;
mod error;
mod method;
mod ordering;
mod problem;

pub use bases::HandleBases;
pub use bound::{Bound, Step};
pub use error::{BindError, SolveError};
pub use method::{Bilaplacian, Method};
pub use ordering::Ordering;
pub use problem::{Loose, Problem, Role};
