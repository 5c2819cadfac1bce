//! The program: the command line, the window, threads and the clock, over the engine. `pliant` itself is a thin binary
//! over it.

pub mod cli;
pub mod drawing;
pub mod legend;
pub mod painting;
mod picture_file;
pub mod sheet;
mod version;
pub mod window;

pub use version::VERSION;
