//! Arrays as a model.

use std::sync::Arc;

use pliant_engine::EngineError;
use pliant_mesh::{Cancel, Drawn, Model, Progress, WeldOptions};
use pyo3::PyResult;

use crate::refusal::of_engine;

/// The model of arrays.
///
/// # Errors
/// `KeyboardInterrupt`.
pub fn welded(drawn: Drawn, weld: &WeldOptions, cancel: &Cancel) -> PyResult<Arc<Model>> {
    let model = Model::weld(drawn, weld, &Progress::new(), cancel);
    model.map(Arc::new).map_err(|_| of_engine(&EngineError::Interrupted))
}
