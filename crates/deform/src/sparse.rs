//! Sparse symmetric systems: the order of elimination, the scaled matrix, its Cholesky factor and the solves with it.

pub(crate) mod cholesky;
mod etree;
mod forest;
mod front;
pub(crate) mod graph;
pub(crate) mod matrix;
mod multifrontal;
mod ordering;
pub(crate) mod reach;
pub(crate) mod substitution;
mod triangular;

pub use ordering::Ordering;
