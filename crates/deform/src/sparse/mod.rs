//! Sparse symmetric systems: the order of elimination, the scaled matrix, its Cholesky factor and the solves with it.

pub(crate) mod cholesky;
pub(crate) mod factor_error;
pub(crate) mod low_rank;
pub(crate) mod matrix;
pub(crate) mod numeric;
pub(crate) mod ordering;
pub(crate) mod solve;
pub(crate) mod symbolic;

pub use ordering::Ordering;
pub(crate) use ordering::elimination::Elimination;
