//! Files on disk: read whole, and written all or not at all.
//!
//! The steps of a save: [`Destination`] resolves a path and refuses anything except a file. [`Staging`] locks the
//! folders of the save, so that two saves there don't mix and the leftovers of a killed save can be removed.
//! [`placement`] finds a name for each neighbour that overwrites no other file. The bytes are written to temporary
//! files beside their places, with the attributes of the files that they replace, and [`check`]ed by reading them back.
//! Only then are they renamed into place.

mod attributes;
pub mod check;
mod destination;
mod leftovers;
mod lock;
mod named;
mod neighbours;
mod output_folder;
pub mod placement;
mod read;
mod same_file;
mod staging;
mod stamp;

pub use destination::Destination;
pub(crate) use leftovers::passing_name;
pub use lock::Share;
pub use neighbours::{NEIGHBOUR_BYTES, Neighbours};
pub(crate) use output_folder::OutputFolder;
pub use read::{holds, read, read_stamped, read_text, read_text_stamped};
pub use same_file::{follow, is_same, refuse_shared};
pub use staging::{Bridge, Held, NewFile, Staged, Staging};
pub use stamp::{KnownFiles, Stamp};

pub use crate::file_error::FileError;
pub use crate::path_text::{folder_of, name_as_text, path_as_text, path_of_text, shown};
