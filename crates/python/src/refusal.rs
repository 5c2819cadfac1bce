//! Refusals as Python's exceptions: each is one sentence that names the culprit and the remedy.

use std::fmt::Display;

use pliant_engine::EngineError;
use pyo3::PyErr;
use pyo3::exceptions::{PyKeyboardInterrupt, PyOSError, PyValueError};

/// A `ValueError`.
pub fn refused(sentence: impl Display) -> PyErr {
    PyValueError::new_err(sentence.to_string())
}

/// What the engine refuses: an `OSError` where the disk is in the way, and a `ValueError` otherwise.
pub fn of_engine(error: &EngineError) -> PyErr {
    match error {
        EngineError::File(_) | EngineError::System(_) => PyOSError::new_err(error.to_string()),
        EngineError::Interrupted => PyKeyboardInterrupt::new_err(()),
        _ => refused(error),
    }
}
