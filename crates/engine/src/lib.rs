//! The engine: from files and an edit to files. The command line, the window and the Python package run it.
//!
//! It reads a file with its neighbours and welds it (`loading`), binds and bends it
//! (`apply`), puts a pose of one mesh onto another (`transfer`), and writes all of a result or nothing (`saving`,
//! [`files`]). It starts no threads: long loops run on the caller's rayon pool, and a [`Watch`](watch::Watch) tells the
//! caller's other threads how far they are.

mod apply;
pub mod control_mesh;
mod error;
pub mod examples;
pub mod files;
mod loading;
pub mod memory;
pub mod report;
pub mod saving;
mod transfer;
pub mod watch;

pub use apply::{Apply, Prepared, Solved, apply, bind, check_bends, check_not_empty, order, prepare, settle, solved};
pub use error::EngineError;
pub use loading::{Loaded, is_project, load, load_bytes, open};
pub use transfer::{Transfer, transfer};
