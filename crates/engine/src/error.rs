//! Why the program refuses: one sentence that names the culprit and the remedy.

use std::path::PathBuf;

use crate::files::{FileError, shown};

/// A refusal. Its text is one line for the person; [`EngineError::status`] is the program's exit status.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum EngineError {
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
    #[error("{} holds no triangle and no point, so there is nothing to edit: choose a file with a shape", shown(.0))]
    Empty(PathBuf),
    /// The edit can't be read, or does not fit the file.
    #[error("{}: {source}", shown(.edit))]
    Edit {
        /// The edit's file.
        edit: PathBuf,
        /// What is wrong with it.
        source: pliant_editor::EditError,
    },
    /// An example of other vertices or triangles.
    #[error(
        "{}: it has {what}, and {} has {expected}: give an example of the same vertices and triangles",
        shown(.example), shown(.file)
    )]
    Example {
        /// The example's file.
        example: PathBuf,
        /// What it has.
        what: String,
        /// The file that is bent.
        file: PathBuf,
        /// What that has.
        expected: String,
    },
    /// A project's mesh is not where it was, or is another one.
    #[error(
        "{}: its mesh {} is {what}: put the one it was made on there, or beside the project", shown(.project),
        shown(.mesh)
    )]
    ProjectMesh {
        /// The project's file.
        project: PathBuf,
        /// Where its mesh should be.
        mesh: PathBuf,
        /// What is there.
        what: &'static str,
    },
    /// A project where a mesh is asked for.
    #[error("{} is a project, and FILE must be a mesh: give the mesh, and the project as --edit", shown(.0))]
    ProjectAsFile(PathBuf),
    /// The problem could not be factored. Its vertices are the file's.
    #[error("{}: {source}", shown(.file))]
    Bind {
        /// The file that was to be bent.
        file: PathBuf,
        /// What stands in the way.
        source: pliant_deform::BindError,
    },
    /// A step could not be done. Its vertices are the file's.
    #[error("{}: {source}", shown(.file))]
    Solve {
        /// The file that was to be bent.
        file: PathBuf,
        /// What stands in the way.
        source: pliant_deform::SolveError,
    },
    /// The result can't be stored as asked.
    #[error("{}: {source}", shown(.file))]
    Save {
        /// The file that was to be written.
        file: PathBuf,
        /// What stands in the way.
        source: pliant_io::SaveError,
    },
    /// What was written does not read back as it should; nothing was replaced.
    #[error(
        "{}: what was written does not read back as it was to be saved ({what}), so nothing was replaced: this is a \
         fault of the program or the disk; save as another kind, and report it with the file", shown(.file)
    )]
    ReadBack {
        /// The file that was to be written.
        file: PathBuf,
        /// What differs, or why it can't be read.
        what: String,
    },
    /// A file that was to be replaced is another one than was read.
    #[error(
        "{} was changed by another program since it was read, so nothing was written: run the command again, or give \
         another --output", shown(.0)
    )]
    Changed(PathBuf),
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

impl EngineError {
    /// The exit status: 2 for wrong arguments, 1 for everything else.
    pub fn status(&self) -> u8 {
        match self {
            Self::Arguments(_) => 2,
            _ => 1,
        }
    }
}
