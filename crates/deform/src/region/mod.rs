//! What the roles mean on a surface: who is solved for, who is held and how firmly, who follows.

pub(crate) mod constraints;
pub(crate) mod follow;
mod owners;
pub(crate) mod partition;
