//! The laws of surfaces and their geometry, on every class of mesh.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "a test may panic")]

mod bare_points;
mod curves;
mod drawn_set;
mod findings;
mod geometry;
mod hierarchy;
mod limbs;
mod symmetry;
mod threads;
mod topology;
mod welding;
