//! The names that the program gives files, and the originals that it keeps: shared by the command line and the window.

pub(crate) mod names;
pub(crate) mod original;
