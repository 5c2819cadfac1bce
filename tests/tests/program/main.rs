//! The program by its command line: files and edits go in, and files and reports come out.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "a test may panic")]

mod animate;
mod apply;
mod bad_files;
mod bare_points;
mod cli;
mod controls;
mod creases;
mod curves;
mod differences;
mod drags;
mod examples;
mod first_pages;
mod flow;
mod hostile;
mod identity;
mod limbs;
mod neighbours;
mod normals;
mod outputs;
mod places;
mod project;
mod scans;
mod sequence;
mod shown_normals;
mod sketches;
mod survey;
mod transfer;
mod trials;
mod view;
mod warnings;
