//! Why the program refuses: one sentence that names the culprit and the remedy.

use std::path::PathBuf;

use crate::files::FileError;

/// A refusal. Its text is one line for the person; [`AppError::status`] is the program's exit status.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum AppError {
    /// The arguments are wrong.
    #[error("{0}")]
    Arguments(String),
    /// A file could not be read or written.
    #[error(transparent)]
    File(#[from] FileError),
    /// The extension of FILE tells no known format.
    #[error(transparent)]
    Format(#[from] pliant_io::UnknownFormat),
    /// A file's content can't be read as its format; the file is named in it.
    #[error(transparent)]
    Read(pliant_io::ReadError),
    /// A file that holds nothing to edit.
    #[error("{} holds no triangle, so there is nothing to edit: choose a file with a surface", .0.display())]
    NoTriangles(PathBuf),
    /// The edit can't be read, or does not fit the file.
    #[error("{}: {source}", .edit.display())]
    Edit {
        /// The edit's file.
        edit: PathBuf,
        /// What is wrong with it.
        source: pliant_editor::EditError,
    },
    /// The edit's file is one that this version can't read.
    #[error("{} is a project, and this version reads edits only: give an EDIT.json", .0.display())]
    ProjectAsEdit(PathBuf),
    /// The problem could not be factored.
    #[error("{}: {source}", .file.display())]
    Bind {
        /// The file that was to be bent.
        file: PathBuf,
        /// What stands in the way.
        source: pliant_deform::BindError,
    },
    /// A step could not be done.
    #[error("{}: {source}", .file.display())]
    Solve {
        /// The file that was to be bent.
        file: PathBuf,
        /// What stands in the way.
        source: pliant_deform::SolveError,
    },
    /// The result can't be stored as asked.
    #[error("{}: {source}", .file.display())]
    Save {
        /// The file that was to be written.
        file: PathBuf,
        /// What stands in the way.
        source: pliant_io::SaveError,
    },
    /// Ctrl-C.
    #[error("stopped before the end, so nothing was written: run the command again for a result")]
    Interrupted,
    /// Something that this version does not do.
    #[error("{0}")]
    Unsupported(String),
    /// The system refused something that is no file.
    #[error("{0}")]
    System(String),
}

impl AppError {
    /// The exit status: 2 for wrong arguments, 1 for everything else.
    pub fn status(&self) -> u8 {
        match self {
            Self::Arguments(_) => 2,
            _ => 1,
        }
    }
}
