//! The program's refusals: one sentence that names the culprit and the remedy.

use std::path::PathBuf;

use crate::file_error::FileError;
use crate::path_text::shown;

/// A refusal. Its text is one line for the person; [`EngineError::status`] is the program's exit status.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum EngineError {
    /// The arguments are wrong.
    #[error("{0}")]
    Arguments(String),
    /// Numbered files of an animation exist, and nobody allowed it to replace them.
    #[error(
        "--output would replace {count} numbered {}, the first of them {}: give another name, or --replace",
        if *.count == 1 { "file" } else { "files" },
        shown(.first)
    )]
    FramesExist {
        /// The first of them.
        first: PathBuf,
        /// Their number.
        count: usize,
    },
    /// A file could not be read or written.
    #[error(transparent)]
    File(#[from] FileError),
    /// The extension of FILE is of no known format.
    #[error(transparent)]
    Format(#[from] pliant_io::UnknownFormat),
    /// A file's content can't be read as its format; the text names the file.
    #[error(transparent)]
    Read(pliant_io::ReadError),
    /// A file without anything to edit.
    #[error("{} has no triangle and no point, so there is nothing to edit: choose a file with a shape", shown(.0))]
    Empty(PathBuf),
    /// The edit can't be read, or does not fit the file.
    #[error("{}: {source}", shown(.edit))]
    Edit {
        /// The edit's file.
        edit: PathBuf,
        /// Its fault.
        source: pliant_editor::EditError,
    },
    /// An example with other vertices or triangles.
    #[error(
        "{}: it has {what}, but {} has {expected}: give an example of the same vertices and triangles",
        shown(.example), shown(.file)
    )]
    Example {
        /// The example's file.
        example: PathBuf,
        /// Its counts.
        what: String,
        /// The bent file.
        file: PathBuf,
        /// The counts of that file.
        expected: String,
    },
    /// A project's mesh is missing or is another one.
    #[error(
        "{}: its mesh {} is {what}: put the original mesh there, or beside the project", shown(.project),
        shown(.mesh)
    )]
    ProjectMesh {
        /// The project's file.
        project: PathBuf,
        /// The expected place of its mesh.
        mesh: PathBuf,
        /// The fault there.
        what: &'static str,
    },
    /// A project in place of a mesh.
    #[error("{} is a project, but FILE must be a mesh: give the mesh, and the project as --edit", shown(.0))]
    ProjectAsFile(PathBuf),
    /// The problem could not be factored. Its vertices are the file's.
    #[error("{}: {source}", shown(.file))]
    Bind {
        /// The file to bend.
        file: PathBuf,
        /// The obstacle.
        source: pliant_deform::BindError,
    },
    /// A step could not be done. Its vertices are the file's.
    #[error("{}: {source}", shown(.file))]
    Solve {
        /// The file to bend.
        file: PathBuf,
        /// The obstacle.
        source: pliant_deform::SolveError,
    },
    /// A shape can't be cut, filled or joined. Its vertices are the file's.
    #[error("{}: {source}", shown(.file))]
    Stitch {
        /// The file.
        file: PathBuf,
        /// The obstacle.
        source: pliant_stitch::StitchError,
    },
    /// A flow can't be prepared or continued. Its vertices are the file's.
    #[error("{}: {source}", shown(.file))]
    Flow {
        /// The file.
        file: PathBuf,
        /// The obstacle.
        source: pliant_flow::FlowError,
    },
    /// The result can't be stored as requested.
    #[error("{}: {source}", shown(.file))]
    Save {
        /// The file to write.
        file: PathBuf,
        /// The obstacle.
        source: pliant_io::SaveError,
    },
    /// The written file does not read back correctly; nothing was replaced.
    #[error(
        "{}: the written file differs from the intended one ({what}), so nothing was replaced: the program or the \
         disk is at fault; save in another format, and report it with the file", shown(.file)
    )]
    ReadBack {
        /// The file to write.
        file: PathBuf,
        /// The difference, or the reason why it can't be read.
        what: String,
    },
    /// A file to be replaced differs from the one that was read.
    #[error(
        "{} was changed by another program since it was read, so nothing was written: run the command again, or give \
         another --output", shown(.0)
    )]
    Changed(PathBuf),
    /// Ctrl-C.
    #[error("the command was stopped, so nothing was written: run it again for a result")]
    Interrupted,
    /// A feature that this version does not have.
    #[error("{0}")]
    Unsupported(String),
    /// The system refused an operation on something other than a file.
    #[error("{0}")]
    System(String),
}

impl From<pliant_io::ReadError> for EngineError {
    fn from(error: pliant_io::ReadError) -> Self {
        match error {
            pliant_io::ReadError::Cancelled(_) => Self::Interrupted,
            error => Self::Read(error),
        }
    }
}

impl EngineError {
    /// The exit status: 2 for wrong arguments, 1 for everything else.
    pub fn status(&self) -> u8 {
        match self {
            Self::Arguments(_) | Self::FramesExist { .. } => 2,
            _ => 1,
        }
    }

    /// Its sentence for callers whose arguments have no dashes before their names.
    pub fn without_dashes(&self) -> String {
        let sentence = self.to_string();
        let (Self::Arguments(_) | Self::FramesExist { .. }) = self else {
            return sentence;
        };
        let names = [
            "output", "report", "edit", "joins", "delete", "mesh", "fps", "methods", "replace",
        ];
        names.iter().fold(sentence, |said, name| {
            [" ", ":", ","].iter().fold(said, |said, end| {
                said.replace(&format!("--{name}{end}"), &format!("{name}{end}"))
            })
        })
    }
}
