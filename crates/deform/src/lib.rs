//! The core solver: a surface, the roles of its vertices and a method in; displacements out.
//!
//! Rates of change are types: [`Ordering`] changes with the mesh, [`Bound`] with roles, stiffness and options, and a
//! [`Bound::step`] with the handles' transforms. There is no clock here, no file, no thread of its own: rayon's
//! current pool is the caller's, and every result is the same bit for bit whatever its size.
//!
//! Binding goes [`Problem`] → `partition` (who is solved for) → [`Laplacian`] → `assembly` → `cholesky` in the
//! restricted `ordering` → `shell` (`shell_operator`; check; `refine`) → `plate` ([`HandleBases`],
//! energies) → [`Bound`]. A frame is [`HandleBases`] and `follow`. The nonlinear `arap` shares `partition`,
//! [`Laplacian`], `cholesky` and `follow`, and takes as many steps as it needs.

mod arap;
mod assembly;
mod bases;
mod bilaplacian;
mod bound;
mod cholesky;
mod error;
mod etree;
mod face_terms;
mod follow;
mod forest;
mod front;
mod handle;
mod method;
mod multifrontal;
mod operators;
mod ordering;
mod partition;
mod plate;
mod problem;
mod reach;
mod refine;
mod rigid_fit;
mod shell;
mod shell_operator;
mod triangular;

pub use arap::{Arap, ArapEnergy};
pub use bases::HandleBases;
pub use bilaplacian::{Bilaplacian, Discretisation, ShellOrder};
pub use bound::{Bound, Step};
pub use error::{BindError, SolveError};
pub use method::Method;
pub use operators::Laplacian;
pub use ordering::Ordering;
pub use problem::{Loose, Problem, Role};
