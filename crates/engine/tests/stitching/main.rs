//! The laws of new shapes from files.
#![allow(clippy::unwrap_used, reason = "a test that can't go on fails")]

mod appended;
mod files;
mod made;
mod materials;
mod obj_names;
mod smoothing_groups;
mod stopped;
