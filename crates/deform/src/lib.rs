//! The core solver: a surface, the roles of its vertices and a method in; displacements out.
//!
//! Rates of change are types: [`Ordering`] changes with the mesh, [`Bound`] with roles, stiffness and options, and a
//! [`Bound::step`] with the handles' transforms. There is no clock here, no file, no thread of its own: rayon's
//! current pool is the caller's, and every result is the same bit for bit whatever its size.
//!
//! Binding goes [`Problem`] → `partition` (who is solved for) → [`Laplacian`] (`operators`) → a matrix in the
//! restricted [`Ordering`], factored (`sparse`) → the method: `shell` gives [`HandleBases`], so that a frame is a
//! product with them and `follow`; `arap` shares everything up to the factor and takes as many steps as it needs.

mod arap;
mod blend;
mod bound;
mod budget;
mod constraints;
mod error;
mod follow;
mod handle;
#[cfg(feature = "identity-method")]
mod identity;
mod lanes;
mod lbfgs;
mod method;
mod operators;
mod owners;
mod partition;
mod prefetch;
mod primo;
mod problem;
mod rigid_fit;
mod rotation;
mod shell;
mod sparse;
#[doc(hidden)]
pub mod stages;
mod sums;

pub use arap::{Arap, ArapEnergy};
pub use bound::{Bound, ReusableFactor, Step};
pub use budget::Budget;
pub use constraints::{CONTINUITY_RANGE, Constraints};
pub use error::{BindError, Crowded, SolveError};
pub use method::{
    ConstraintKind, METHODS, Method, MethodDeclaration, Needs, OptionDeclaration, OptionKind, OptionRefused,
    OptionValue, Solve,
};
pub use operators::Laplacian;
pub use primo::Primo;
pub use problem::{Loose, Problem, Role};
pub use shell::{Bilaplacian, Discretisation, HandleBases, ShellOrder, Triangulation};
pub use sparse::Ordering;
