//! Files on disk: read whole, and written all or not at all.
//!
//! A save goes in this order. [`Destination`] says where a path leads and refuses what is no file. [`Staging`] takes a
//! lock on the folders that are written to, so that two saves there don't mix and what a killed one left can be cleared
//! away. [`placement`] finds a name for each neighbour under which nothing of somebody else's is lost. The bytes are
//! written beside their places, with the attributes of what they replace, and [`check`]ed by reading them back. Only
//! then are they renamed into place.

mod attributes;
pub mod check;
mod destination;
mod error;
mod identity;
mod leftovers;
mod lock;
mod neighbours;
pub mod placement;
mod read;
mod staging;

pub use destination::Destination;
pub use error::FileError;
pub use identity::{follow, is_same, refuse_shared};
pub(crate) use leftovers::passing_name;
pub use lock::Share;
pub use neighbours::{NEIGHBOUR_BYTES, Neighbours};
pub use read::{read, read_text};
pub use staging::{Bridge, Held, NewFile, Staged, Staging};

use std::path::Path;

/// The folder that a path stands in, "." for a bare name.
pub fn folder_of(path: &Path) -> &Path {
    match path.parent() {
        Some(parent) if !parent.as_os_str().is_empty() => parent,
        _ => Path::new("."),
    }
}

/// A path for a message: on one line, and nothing in it that steers a terminal.
pub fn shown(path: &Path) -> String {
    pliant_io::quoted(&path.to_string_lossy())
}
