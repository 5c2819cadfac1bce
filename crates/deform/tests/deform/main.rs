//! The solver's laws, on every class of mesh.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "a test may panic")]

mod anisotropy;
mod arap;
mod bare_points;
mod bilaplacian;
mod bodies;
mod cage;
mod cage_coordinates;
mod components;
mod continuity;
mod controls;
mod detail;
mod differential;
mod energies;
mod frames;
mod hubs;
mod laplacian;
mod lattice;
mod laws;
mod mls;
mod nonlinear;
mod operators;
mod ordering;
mod plate;
mod poisson;
mod primo;
mod rbf;
mod rebind;
mod rig;
mod robust;
mod shared;
mod shells;
mod soft;
mod soup;
mod space;
mod strip;
