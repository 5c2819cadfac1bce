//! Refusals as Python's exceptions: each is one sentence that names the culprit and the remedy.

use std::fmt::Display;

use std::io::ErrorKind;

use pliant_editor::EditError;
use pliant_engine::EngineError;
use pliant_engine::files::FileError;
use pyo3::PyErr;
use pyo3::exceptions::{PyKeyboardInterrupt, PyOSError, PyValueError};

use crate::origin::Origin;

/// A `ValueError`.
pub fn refused(sentence: impl Display) -> PyErr {
    PyValueError::new_err(sentence.to_string())
}

/// The engine's refusal: an `OSError` for a failure of the disk, and a `ValueError` otherwise.
pub fn of_engine(error: &EngineError) -> PyErr {
    match error {
        EngineError::File(error) => of_file(error),
        EngineError::System(_) => PyOSError::new_err(error.to_string()),
        EngineError::Interrupted => PyKeyboardInterrupt::new_err(()),
        _ => refused(error.without_dashes()),
    }
}

/// The refusal of an edit that does not fit the mesh. For arrays it says "the mesh has" and never "the file".
pub fn of_edit(error: &EditError, origin: Origin<'_>) -> PyErr {
    let sentence = error.to_string();
    let speaks_of_counts = matches!(
        error,
        EditError::NoSuchVertex { .. } | EditError::FieldLength { .. } | EditError::SharedVertex { .. }
    );
    match origin {
        Origin::Arrays if speaks_of_counts => refused(
            sentence
                .replace("the file has", "there are")
                .replace("the file's vertex", "vertex"),
        ),
        Origin::Arrays | Origin::File(_) => refused(sentence),
    }
}

/// An `OSError` of Python's own kind, such as `FileNotFoundError`, with the file as `filename`.
fn of_file(error: &FileError) -> PyErr {
    let number = match error.kind() {
        ErrorKind::NotFound => 2,
        ErrorKind::PermissionDenied => 13,
        ErrorKind::NotADirectory => 20,
        ErrorKind::IsADirectory => 21,
        _ => return PyOSError::new_err(error.to_string()),
    };
    // An OSError of three values takes its kind from the number.
    PyOSError::new_err((number, error.reason(), error.file().as_os_str().to_owned()))
}
