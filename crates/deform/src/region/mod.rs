//! The roles applied to a surface: what is solved for, what is held and how firmly, what follows.

pub(crate) mod clustered;
pub(crate) mod constraints;
pub(crate) mod follow;
mod images;
pub(crate) mod nodes;
mod owners;
pub(crate) mod partition;
pub(crate) mod patch;
pub(crate) mod slender;
mod strays;
