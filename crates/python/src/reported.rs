//! A job on files that ends with a report.

use pliant_engine::EngineError;
use pliant_engine::watch::Watch;
use pyo3::prelude::*;

use crate::interruptible::interruptible;
use crate::refusal::of_engine;
use crate::values::as_python;
use crate::warned::warn;

/// Runs a job, which gives the report's text and the warnings, warns, and returns the report as a dict.
///
/// # Errors
/// The job's, and a warning that is an error.
pub fn reported<'py>(
    py: Python<'py>,
    job: impl Fn(&Watch) -> Result<(String, Vec<String>), EngineError> + Sync,
) -> PyResult<Bound<'py, PyAny>> {
    let told = interruptible(py, |pool, cancel| pool.install(|| job(&Watch::cancelled_by(cancel))))?;
    let (report, warnings) = told.map_err(|error| of_engine(&error))?;
    warn(py, &warnings)?;
    as_python(py, &report)
}
