//! The binding of an edit to a model: the equations are ordered, and then the method is bound.

use std::path::Path;
use std::time::Instant;

use pliant_deform::{BindError, Bound, Budget, Method, Ordering};
use pliant_editor::Setup;
use pliant_mesh::{Cancel, Model, Progress, SurfaceVertex};
use tracing::info_span;

use crate::EngineError;
use crate::report::ms_since;
use crate::watch::Watch;

/// Orders a model's equations for a method that needs it, once for all regions: for the Laplacian's factor if the
/// method's own is too large for the remaining memory.
///
/// # Errors
/// [`EngineError::Interrupted`] soon after `cancel` is raised.
pub fn order(
    model: &Model,
    setup: &Setup,
    budget: Budget,
    progress: &Progress,
    cancel: &Cancel,
) -> Result<Option<Ordering>, EngineError> {
    let _span = info_span!("order").entered();
    let ordering = setup.problem(model).ordering_within(budget, progress, cancel);
    ordering.map_err(|_| EngineError::Interrupted)
}

/// Binds a setup.
///
/// # Errors
/// The obstacle to a solution, naming `file`.
pub fn bind(
    file: &Path,
    model: &Model,
    setup: &Setup,
    ordering: Option<&Ordering>,
    budget: Budget,
    (progress, cancel): (&Progress, &Cancel),
) -> Result<Bound, EngineError> {
    let _span = info_span!("bind", method = setup.method.name()).entered();
    let bound = setup.problem(model).bind_within(ordering, budget, progress, cancel);
    bound.map_err(|error| refused(file, model, error))
}

/// The refusal of a binding, which names vertices by the file's numbers.
pub(crate) fn refused(file: &Path, model: &Model, error: BindError) -> EngineError {
    match error {
        BindError::Cancelled(_) => EngineError::Interrupted,
        error => EngineError::Bind {
            file: file.to_owned(),
            source: error.renumbered(|vertex| model.first_file_vertex(SurfaceVertex(vertex)).0),
        },
    }
}

/// Refuses a method that bends surfaces for a file with only points.
///
/// # Errors
/// [`BindError::NoTriangles`], naming `file`.
pub fn check_bends(file: &Path, model: &Model, method: &Method) -> Result<(), EngineError> {
    let checked = method.check_bends(&model.surface);
    checked.map_err(|error| refused(file, model, error))
}

/// A binding, and its times.
#[derive(Debug)]
pub struct Prepared {
    /// The bound problem.
    pub bound: Bound,
    /// The time of the mesh's ordering, in milliseconds.
    pub order_ms: f64,
    /// The time from the ordering to the binding, in milliseconds.
    pub bind_ms: f64,
}

/// Orders and binds a setup, once its tables are known to fit the budget.
///
/// # Errors
/// Those of [`bind`]; [`EngineError::Interrupted`] soon after the watch's flag is raised.
pub fn prepare(
    file: &Path,
    model: &Model,
    setup: &Setup,
    budget: Budget,
    watch: &Watch,
) -> Result<Prepared, EngineError> {
    let start = Instant::now();
    let checked = setup.problem(model).check_tables(budget);
    checked.map_err(|error| refused(file, model, error))?;
    let ordering = order(model, setup, budget, &watch.begin("ordering"), &watch.cancel)?;
    let order_ms = ms_since(start);
    let start = Instant::now();
    let bound = bind(
        file,
        model,
        setup,
        ordering.as_ref(),
        budget,
        (&watch.begin("binding"), &watch.cancel),
    )?;
    let bind_ms = ms_since(start);
    Ok(Prepared {
        bound,
        order_ms,
        bind_ms,
    })
}
