//! The contents of a file, like `pliant info --json`.

use std::path::PathBuf;

use pliant_engine::inspect;
use pliant_engine::watch::Watch;
use pyo3::prelude::*;

use crate::interruptible::interruptible;
use crate::refusal::of_engine;
use crate::values::{as_python, weld_options};

#[doc = include_str!(concat!(env!("OUT_DIR"), "/info.txt"))]
#[pyfunction]
#[pyo3(signature = (file, *, weld=None))]
pub fn info(py: Python<'_>, file: PathBuf, weld: Option<f64>) -> PyResult<Bound<'_, PyAny>> {
    let weld = weld_options(weld)?;
    let inspected = interruptible(py, |pool, cancel| {
        pool.install(|| inspect(&file, weld, &Watch::cancelled_by(cancel)).map(|inspected| inspected.to_json()))
    })?;
    as_python(py, &inspected.map_err(|error| of_engine(&error))?.to_string())
}
