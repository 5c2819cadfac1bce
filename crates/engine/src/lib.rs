//! The engine turns files and an edit into files. The command line, the window and the Python package run it.
//!
//! It reads a file with its neighbours and welds it (`loading`), binds and bends it (`apply`), puts a pose of one mesh
//! onto another (`transfer`), cuts, fills and joins shapes (`stitching`), and writes all of a result or nothing (`saving`, [`files`]). It starts no threads: long
//! loops run on the caller's rayon pool, and a [`Watch`](watch::Watch) shows their progress to the caller's other
//! threads.
//!
//! `pliant apply` without its arguments: the upper edge of a strip is lifted, and the rest follows:
//!
//! ```
//! use pliant_editor::Beginning;
//! use pliant_engine::{Apply, EditJob, apply, files::Staging, load, memory, watch::Watch};
//! use pliant_mesh::WeldOptions;
//!
//! let folder = tempfile::tempdir()?;
//! let [file, output] = ["strip.off", "bent.off"].map(|name| folder.path().join(name));
//! let strip = "OFF\n6 4 0\n0 0 0\n1 0 0\n0 1 0\n1 1 0\n0 2 0\n1 2 0\n\
//!              3 0 1 3\n3 0 3 2\n3 2 3 5\n3 2 5 4\n";
//! std::fs::write(&file, strip)?;
//! let edit = r#"{
//!     "version": 1,
//!     "method": { "name": "bilaplacian" },
//!     "fixed": { "vertices": [0, 1] },
//!     "handles": [
//!         { "name": "edge", "select": { "vertices": [4, 5] }, "transform": { "translation": [0, 0, 1] } }
//!     ]
//! }"#;
//! let job = EditJob {
//!     file: &file,
//!     edit: &Beginning::parse(edit)?,
//!     edit_path: "edit.json".as_ref(),
//!     output: &output,
//!     report: None,
//!     weld: None,
//!     budget: memory::budget(),
//! };
//! let job = Apply {
//!     job,
//!     frames: None,
//!     deltas: pliant_io::MorphDeltas::WhereFarOff,
//!     morph: None,
//! };
//! let report = apply(&job, &Watch::default(), &Staging::default())?;
//!
//! assert_eq!((report.free_vertices, report.converged), (2, true));
//! let bent = load(&output, &WeldOptions::default(), &Watch::default())?.model.rest_positions();
//! assert_eq!([bent[0].z, bent[4].z], [0.0, 1.0]);
//! assert!(bent[2].z > 0.0 && bent[2].z < 1.0);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod animate;
mod apply;
mod binding;
mod coloured;
pub mod control_mesh;
mod difference;
mod edit;
mod edit_job;
mod error;
pub mod examples;
mod file_error;
pub mod files;
pub mod flow;
mod frames;
mod given;
mod inspected;
mod loading;
pub mod memory;
mod path_text;
pub mod report;
pub mod saving;
mod sequence;
mod solution;
pub mod stitching;
mod transfer;
pub mod watch;

pub use animate::{
    Animate, Animated, AnimationReport, MORPH_TOLERANCE, MorphReport, animate, animation_path, stage_animation,
};
pub use apply::{Apply, Solved, apply, solved};
pub use binding::{Prepared, bind, check_bends, order, prepare};
pub use difference::{Compared, differences};
pub use edit::read_edit;
pub use edit_job::EditJob;
pub use error::EngineError;
pub use flow::{FlowJob, FlowReport, Flowing, FromTo, flow, read_flow};
pub use frames::ExistingFrames;
pub use given::Given;
pub use inspected::{Inspected, inspect};
pub use loading::{Loaded, check_not_empty, is_project, load, load_bytes, open};
pub use sequence::{OpenSequence, Sequence, SequenceReport, sequence};
pub use transfer::{Transfer, transfer, transferred};

pub use pliant_io::{Difference, MorphDeltas, MorphTarget, What};
