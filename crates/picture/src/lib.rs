//! Pictures of mesh files without a window, as PNG or as pixels. The window draws with the same parts.
//!
//! ```no_run
//! use pliant_engine::watch::Watch;
//! use pliant_picture::{OfFile, StillOptions, draw_file, picture_file};
//!
//! let job = OfFile {
//!     file: "scan.glb".as_ref(),
//!     edit: None,
//!     weld: None,
//!     options: &StillOptions::default(),
//! };
//! let mut pngs = Vec::new();
//! draw_file(&job, &[], &Watch::default(), |picture| {
//!     pngs.push(picture_file::png(picture)?);
//!     Ok(())
//! })?;
//! # Ok::<(), pliant_engine::EngineError>(())
//! ```

mod camera;
mod choice;
mod comparison;
pub mod drawing;
pub mod legend;
mod of_file;
mod options;
pub mod painting;
pub mod picture_file;
mod shape;
pub mod sheet;
mod still;
mod subject;
mod uploaded;

pub use choice::{Choice, named};
pub use comparison::{Asked, Compared, Comparison, compare};
pub use of_file::{OfFile, check_png, draw_file, outputs};
pub use options::{LookOptions, PictureSize, ProjectionName, Shading, StillOptions, Up, View};
pub use shape::{Posed, Shape};
pub use still::draw;
pub use subject::{Resolved, Subject, resolved, with_edit};
