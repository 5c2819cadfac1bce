//! Sentences for a person as Python's warnings.

use std::ffi::CString;

use pyo3::exceptions::PyUserWarning;
use pyo3::prelude::*;

/// Gives each sentence as a warning at the line that called the function.
///
/// # Errors
/// If warnings are errors.
pub fn warn(py: Python<'_>, sentences: &[String]) -> PyResult<()> {
    for sentence in sentences {
        let sentence = CString::new(sentence.replace('\0', " "))?;
        PyErr::warn(py, &py.get_type::<PyUserWarning>(), &sentence, 1)?;
    }
    Ok(())
}
