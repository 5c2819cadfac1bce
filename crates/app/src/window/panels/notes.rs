//! Sentences for the person that are no part of the editor's status: about files and what became of them.

/// What the person is told beside the status line.
#[derive(Debug, Default)]
pub struct Notes {
    /// The newest thing that went well or wrong with a file, in a sentence.
    pub headline: Option<Note>,
    /// What is to be known about the open file, a sentence each.
    pub about_file: Vec<String>,
}

/// A sentence for the person.
#[derive(Clone, PartialEq, Debug)]
pub enum Note {
    /// Something was done.
    Done(String),
    /// Something could not be done.
    Failed(String),
}
