//! Sentences for the person that are not part of the editor's status: about files and the results of requests.

use std::path::PathBuf;

/// The person's information beside the status line.
#[derive(Debug, Default)]
pub struct Notes {
    /// The newest success or failure with a file, in a sentence.
    pub headline: Option<Note>,
    /// Information about the open file, a sentence each.
    pub about_file: Vec<String>,
    /// A vertex, numbered as in the file, of each border that a note says stays open.
    pub open_borders: Vec<u32>,
}

/// A sentence for the person.
#[derive(Clone, PartialEq, Debug)]
pub enum Note {
    /// A success.
    Done(String),
    /// A file was saved under this path.
    Saved(String, PathBuf),
    /// A failure.
    Failed(String),
}
