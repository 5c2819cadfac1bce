//! The coarse level of a large surface: clusters of its vertices, and the problem on them.

pub(crate) mod clustered;
pub(crate) mod clusters;
pub(crate) mod domain;
