//! Sparse symmetric systems [Dav06]: `ordering`, `symbolic` and `numeric` factorisation, and `solve`, which is forward
//! and backward substitution. `cholesky` is the factor that joins them, `refactorisation` a factor that reuses parts of
//! the last one.

pub(crate) mod cholesky;
pub(crate) mod factor_error;
pub(crate) mod line;
pub(crate) mod low_rank;
pub(crate) mod matrix;
pub(crate) mod numeric;
pub(crate) mod ordering;
pub(crate) mod refactorisation;
pub(crate) mod scaled_substitution;
pub(crate) mod solve;
pub(crate) mod symbolic;
pub(crate) mod system_error;

pub use ordering::Ordering;
pub(crate) use ordering::elimination::Elimination;
