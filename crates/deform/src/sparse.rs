//! Sparse symmetric systems: the order of elimination, the scaled matrix, its Cholesky factor and the solves with it.

mod assembly_tree;
mod bisection;
pub(crate) mod cholesky;
mod crumbs;
mod dissection;
mod elimination;
pub(crate) mod factor_error;
mod front;
pub(crate) mod graph;
pub(crate) mod hubs;
mod kernels;
mod labels;
mod leaf;
mod line;
pub(crate) mod low_rank;
pub(crate) mod matrix;
mod multifrontal;
mod ordering;
mod passes;
mod reuse;
pub(crate) mod substitution;
mod symbolic;
mod tiles;
mod triangular;

pub(crate) use elimination::Elimination;
pub use ordering::Ordering;
