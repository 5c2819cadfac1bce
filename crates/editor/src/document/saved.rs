//! The state of the document in each file.
//!
//! A save takes time, while the person continues to work. So it has a [`SaveMark`] from the moment at which it began,
//! and when it has ended the state of that moment counts as saved, even after later changes. A shape that arrives
//! later, because the descent continued or the save did not wait for it, differs from the file's.

use super::version::Version;

/// The part of the document in a file.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum SavedAs {
    /// Only the bent mesh.
    Model,
    /// The whole document.
    Project,
}

/// The state of the document at the moment at which a save began.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct SaveMark {
    /// The history's state.
    pub(super) state: u64,
    /// The shape that was shown.
    pub(super) shape: Version,
    /// True if no other shape can arrive for this state.
    pub(super) is_final: bool,
}

/// The states that the files have.
#[derive(Clone, Copy, Debug)]
pub(super) struct Saved {
    model: InFile,
    project: InFile,
    /// The file without which changes are lost.
    needed: SavedAs,
}

/// The state in a file.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
enum InFile {
    /// No known state.
    Nothing,
    /// The state that the document was opened with.
    Opened(u64),
    /// A state that was written, with its shape.
    Written(u64),
}

impl Saved {
    /// The document was opened with this state.
    pub(super) fn opened(state: u64) -> Self {
        Self {
            model: InFile::Opened(state),
            project: InFile::Opened(state),
            needed: SavedAs::Model,
        }
    }

    /// Changes are lost unless this file has them.
    pub(super) fn need(&mut self, needed: SavedAs) {
        self.needed = needed;
    }

    /// No file has any state, and this one is needed.
    pub(super) fn forget(&mut self, needed: SavedAs) {
        *self = Self {
            model: InFile::Nothing,
            project: InFile::Nothing,
            needed,
        };
    }

    /// Returns true if the file without which changes are lost has this state.
    pub(super) fn has(&self, state: u64) -> bool {
        let file = match self.needed {
            SavedAs::Model => self.model,
            SavedAs::Project => self.project,
        };
        file == InFile::Opened(state) || file == InFile::Written(state)
    }

    /// A file was written with the state of the mark; a project also saves the model's changes.
    pub(super) fn written(&mut self, what: SavedAs, mark: SaveMark, now: (u64, Version)) {
        // Without a final shape only the present state is known to be the file's.
        let is_as_written = mark.is_final || now == (mark.state, mark.shape);
        let file = if is_as_written {
            InFile::Written(mark.state)
        } else {
            InFile::Nothing
        };
        match what {
            SavedAs::Model => self.model = file,
            SavedAs::Project => {
                self.project = file;
                self.needed = SavedAs::Project;
            }
        }
    }

    /// Another shape has arrived for this state.
    pub(super) fn reshaped(&mut self, state: u64) {
        for file in [&mut self.model, &mut self.project] {
            if *file == InFile::Written(state) {
                *file = InFile::Nothing;
            }
        }
    }
}
