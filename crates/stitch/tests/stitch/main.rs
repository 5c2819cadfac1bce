//! The laws of cutting, filling and merging, on made surfaces.
#![allow(clippy::unwrap_used, clippy::expect_used, reason = "a test that can't go on fails")]

mod charts;
mod curve;
mod fill;
mod made;
mod merge;
mod open;
mod plane;
mod tube;
