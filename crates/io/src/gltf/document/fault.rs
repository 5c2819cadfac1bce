//! Errors of reading a glTF, before the file's name is added.

use pliant_mesh::Cancelled;

use crate::{Format, ReadError};

/// A reason to refuse a glTF.
#[derive(Debug)]
pub(crate) enum Fault {
    /// Something violates glTF.
    Malformed(String),
    /// The file asks for more than its bytes justify.
    TooLarge(String),
    /// A buffer's file can't be read.
    Neighbour {
        uri: String,
        reason: String,
    },
    Cancelled(Cancelled),
}

impl Fault {
    /// The error that names the file.
    pub fn of_file(self, name: &str, format: Format) -> ReadError {
        let name = name.to_owned();
        match self {
            Self::Malformed(reason) => ReadError::Malformed { name, format, reason },
            Self::TooLarge(what) => ReadError::TooLarge { name, what },
            Self::Neighbour { uri, reason } => ReadError::Neighbour { name, uri, reason },
            Self::Cancelled(cancelled) => ReadError::Cancelled(cancelled),
        }
    }
}

impl From<String> for Fault {
    fn from(reason: String) -> Self {
        Self::Malformed(reason)
    }
}

impl From<Cancelled> for Fault {
    fn from(cancelled: Cancelled) -> Self {
        Self::Cancelled(cancelled)
    }
}
