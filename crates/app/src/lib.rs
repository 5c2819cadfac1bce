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

/// The engine that both the command line and the window run.
pub use pliant_engine as engine;
pub use pliant_engine::EngineError as AppError;
pub use pliant_engine::{files, report, saving, watch};
pub use version::VERSION;

use pliant_engine::{control_mesh, examples, memory};
