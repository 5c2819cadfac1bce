//! Small numerical tools of several methods: descent directions, line searches, rotations and rigid motions that fit,
//! sums that do not depend on the number of threads.

pub(crate) mod dense;
pub(crate) mod eigen;
pub(crate) mod graph;
pub(crate) mod horn;
pub(crate) mod lane_fits;
pub(crate) mod lanes;
pub(crate) mod lbfgs;
pub(crate) mod line_search;
pub(crate) mod lists;
pub(crate) mod nearest;
pub(crate) mod prefetch;
pub(crate) mod quick_rotation;
pub(crate) mod rigid_fit;
pub(crate) mod rotation;
pub(crate) mod rows;
pub(crate) mod samples;
pub(crate) mod sums;
