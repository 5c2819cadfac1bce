//! The roles applied to a surface: solved vertices, held vertices with the strength of the hold, and followers.

pub(crate) mod boundary_problem;
pub(crate) mod constraints;
pub(crate) mod demands;
pub(crate) mod follow;
mod images;
pub(crate) mod limbs;
pub(crate) mod nodes;
mod owners;
pub(crate) mod partition;
mod partition_warnings;
pub(crate) mod patch;
pub(crate) mod size;
pub(crate) mod slender;
mod strays;
