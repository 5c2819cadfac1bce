//! Hostile cases by the hundred thousand: a folder with a model, an edit or a project, with links and unrelated files,
//! broken at random according to their structure; the program's commands run on it, and laws must hold for any content
//! of the folder.
//!
//! A [`Case`] follows from its number alone. The test `hostile` runs a few hundred; the example `hostile` runs a given
//! number, each command under a limit of memory and time.

mod bytes;
mod case;
mod edits;
mod exercise;
mod formats;
mod gltf;
mod json_text;
mod laws;
mod links;
mod meshes;
mod models;
mod named;
mod names;
mod neighbours;
mod pictures;
mod projects;
mod sessions;
mod shapes;
mod strangers;
mod tree;

pub use case::{Case, Kind, Size};
pub use exercise::{Exercised, Meter, Unmetered, Used, exercise, listen_for_panics};
pub use laws::{Law, Violation};
pub use tree::lay;
