//! Pictures of mesh files without a window, as PNG or as pixels. The window draws with the same parts.
//!
//! ```
//! use pliant_engine::EngineError;
//! use pliant_engine::watch::Watch;
//! use pliant_picture::{OfFile, PictureSize, StillOptions, draw_file, picture_file};
//!
//! let folder = tempfile::tempdir()?;
//! let file = folder.path().join("triangle.off");
//! std::fs::write(&file, "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n")?;
//! let options = StillOptions {
//!     size: PictureSize { width: 64, height: 48 },
//!     ..StillOptions::default()
//! };
//! let job = OfFile {
//!     file: &file,
//!     edit: None,
//!     weld: None,
//!     options: &options,
//! };
//! let mut pngs = Vec::new();
//! let drawn = draw_file(&job, &[], &Watch::default(), |picture| {
//!     assert_eq!((picture.width, picture.height), (64, 48));
//!     pngs.push(picture_file::png(picture)?);
//!     Ok(())
//! });
//! match drawn {
//!     Ok(_) => assert!(pngs[0].starts_with(b"\x89PNG")),
//!     // A machine without a graphics driver says so.
//!     Err(EngineError::System(sentence)) => println!("{sentence}"),
//!     Err(other) => return Err(other.into()),
//! }
//! # Ok::<(), Box<dyn std::error::Error>>(())
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
