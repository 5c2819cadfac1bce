//! The program: the command line, the window, files, threads and the clock. `pliant` itself is a thin binary over it.

pub mod cli;
pub mod control_mesh;
pub mod drawing;
pub mod engine;
mod error;
mod examples;
pub mod files;
pub mod legend;
mod loading;
mod memory;
pub mod painting;
mod picture_file;
pub mod report;
pub mod saving;
pub mod sheet;
mod transfer;
mod version;
pub mod watch;
pub mod window;

pub use error::AppError;
pub use version::VERSION;
