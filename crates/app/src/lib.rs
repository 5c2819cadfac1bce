//! The program: the command line, the window, threads and the clock, over the engine. `pliant` itself is a thin binary
//! over it.
//!
//! The command line, with its output kept in memory:
//!
//! ```
//! use pliant_app::cli::{Console, run};
//!
//! let folder = tempfile::tempdir()?;
//! let file = folder.path().join("triangle.off");
//! std::fs::write(&file, "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n")?;
//! let (mut out, mut err) = (Vec::new(), Vec::new());
//! let mut console = Console {
//!     out: &mut out,
//!     err: &mut err,
//!     watch: Default::default(),
//!     staging: Default::default(),
//! };
//! let arguments = vec!["pliant".into(), "info".into(), file.into(), "--json".into()];
//!
//! assert_eq!(run(arguments, &mut console), 0);
//! let told: serde_json::Value = serde_json::from_slice(&out)?;
//! assert_eq!(told["triangles"], 1);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

pub mod cli;
mod files;
mod version;
pub mod window;

pub use version::VERSION;
