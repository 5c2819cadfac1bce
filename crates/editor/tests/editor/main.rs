//! The editor without a window: gestures, commands and jobs on every class of mesh.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "a test may panic")]

mod animation;
mod comparison;
mod controls;
mod corrections;
mod curve_strokes;
mod curves;
mod edit_format;
mod examples;
mod flow;
mod habits;
mod inside_out;
mod inspection;
mod intersections;
mod joints;
mod kept_shape;
mod large_mesh;
mod lateness;
mod laws;
mod memory_limit;
mod mesh_changes;
mod objects;
mod pose;
mod poses;
mod project;
mod rig;
mod rigid_paint;
mod session;
mod smoothing;
mod strength;
mod symmetry;
mod tips;
mod view;
mod whole_limb;
mod work_pose;
