//! The whole window, headless: pointer and keys go in, and the document and the picture come out.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "a test may panic")]

mod access;
mod bending;
mod cage;
mod desktop;
mod disk;
mod examples;
mod files;
mod flow;
mod frame;
mod mesh_changes;
mod pose;
mod sequences;
mod session;
mod slow_frames;
mod timeline;
mod unsaved_meshes;
mod window_rig;
