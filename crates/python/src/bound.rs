//! A bound mesh: everything but the handles' transforms is solved.

use std::path::Path;
use std::sync::{Arc, Mutex, PoisonError};

use glam::{DAffine3, DVec3};
use pliant_deform::{Bound as Solver, Solve, SolveError, Step};
use pliant_editor::{EditFile, Setup};
use pliant_engine::watch::Watch;
use pliant_engine::{EngineError, check_bends, check_not_empty, memory, prepare, settle};
use pliant_mesh::{Cancel, Drawn, Model, Progress, SurfaceVertex};
use pyo3::prelude::*;
use rayon::ThreadPool;

use crate::arrays;
use crate::edit::Arguments;
use crate::interruptible::{detached, interruptible};
use crate::refusal::{of_engine, refused};
use crate::transforms::transforms;
use crate::values::weld_options;

/// What stands for a file's name in refusals of arrays.
const ARRAYS: &str = "the mesh";

/// A mesh that is bound to a method: transforms of the handles in, positions of all vertices out.
#[pyclass(frozen, name = "Bound", module = "pliant")]
pub struct BoundMesh {
    model: Arc<Model>,
    setup: Setup,
    /// Steps of several threads wait for one another.
    solving: Mutex<Solving>,
}

/// What a step changes.
struct Solving {
    solver: Solver,
    /// Of each surface vertex.
    displacements: Vec<DVec3>,
    last: Step,
}

/// Binds a mesh: factors and solves everything that does not depend on where the handles go.
///
/// The arguments after `faces` are the members of the edit format. See the type stubs for shapes and defaults.
#[pyfunction]
#[pyo3(signature = (vertices, faces, *, handles=None, fixed=None, region=None, stiffness=None, continuity=None, loose=None, method=None, weld=None))]
#[expect(clippy::too_many_arguments, reason = "they are the edit format's members, by name")]
pub fn bind<'py>(
    py: Python<'py>,
    vertices: &Bound<'py, PyAny>,
    faces: &Bound<'py, PyAny>,
    handles: Option<Bound<'py, PyAny>>,
    fixed: Option<Bound<'py, PyAny>>,
    region: Option<Bound<'py, PyAny>>,
    stiffness: Option<Bound<'py, PyAny>>,
    continuity: Option<Bound<'py, PyAny>>,
    loose: Option<Bound<'py, PyAny>>,
    method: Option<Bound<'py, PyAny>>,
    weld: Option<f64>,
) -> PyResult<BoundMesh> {
    let positions = arrays::points(vertices, "vertices")?;
    let triangles = arrays::triangles(faces, "faces", positions.len())?;
    let arguments = Arguments {
        method,
        handles,
        fixed,
        region,
        stiffness,
        continuity,
        loose,
    };
    let edit = arguments.edit(positions.len())?;
    let weld = weld_options(weld)?;
    let bind = |cancel: &Cancel| {
        let drawn = Drawn::once(positions, triangles);
        let model = Model::weld(drawn, &weld, &Progress::new(), cancel);
        let model = model.map_err(|_| of_engine(&EngineError::Interrupted))?;
        bind_model(Path::new(ARRAYS), Arc::new(model), &edit, cancel)
    };
    interruptible(py, |pool, cancel| pool.install(|| bind(cancel)))?
}

/// Binds a model to an edit; `name` stands in refusals.
///
/// # Errors
/// `ValueError`, as `pliant apply` refuses.
pub fn bind_model(name: &Path, model: Arc<Model>, edit: &EditFile, cancel: &Cancel) -> PyResult<BoundMesh> {
    let setup = edit.resolve(&model).map_err(refused)?;
    let bound = || {
        check_not_empty(name, &model)?;
        check_bends(name, &model, &setup.method)?;
        prepare(name, &model, &setup, memory::budget(), &Watch::cancelled_by(cancel))
    };
    let solver = bound().map_err(|error| of_engine(&error))?.bound;
    let displacements = vec![DVec3::ZERO; model.surface.positions.len()];
    let solving = Mutex::new(Solving {
        solver,
        displacements,
        last: Step::default(),
    });
    Ok(BoundMesh { model, setup, solving })
}

#[pymethods]
impl BoundMesh {
    /// Moves the handles and returns the positions of all vertices, an array of the shape (n, 3).
    ///
    /// A method that iterates goes on until it has converged or met the limit that its options say, or for
    /// `iterations` steps: fewer follow a moving hand, and calls with the same transforms go on. `out`, an array of
    /// float64 or float32, is filled and returned in place of a new one.
    #[pyo3(signature = (transforms, *, iterations=None, out=None))]
    fn step<'py>(
        &self,
        py: Python<'py>,
        transforms: Bound<'py, PyAny>,
        iterations: Option<usize>,
        out: Option<Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        if iterations == Some(0) {
            return Err(refused(
                "iterations is 0: give at least 1, or leave it out to go on to the end",
            ));
        }
        let targets = self.targets(&transforms)?;
        let most = iterations.unwrap_or(usize::MAX);
        let positions = match self.setup.method.solve() {
            Solve::Direct => detached(py, |pool| self.positions(&targets, most, pool, &Cancel::new()))?,
            Solve::Iterative { .. } => interruptible(py, |pool, cancel| self.positions(&targets, most, pool, cancel))?,
        };
        let positions = positions.map_err(refused)?;
        match out {
            Some(out) => {
                arrays::write(&positions, &out)?;
                Ok(out)
            }
            None => Ok(arrays::of_points(py, positions)?.into_any()),
        }
    }

    /// The handles' names, in the order that `step` takes transforms in.
    #[getter]
    fn handles(&self) -> Vec<&str> {
        self.setup.handles.iter().map(|handle| &*handle.name).collect()
    }

    /// The method's name.
    #[getter]
    fn method(&self) -> &'static str {
        self.setup.method.name()
    }

    /// How many vertices are solved for, once those in the same place are joined.
    #[getter]
    fn free_count(&self, py: Python<'_>) -> usize {
        self.with(py, |solving| solving.solver.free_count())
    }

    /// What a person should know about the binding and the last step, as sentences.
    #[getter]
    fn warnings(&self, py: Python<'_>) -> Vec<String> {
        self.with(py, |solving| self.setup.worded(solving.solver.warnings()))
    }

    /// What is wrong with the mesh, in sentences; none for a clean, closed, connected one.
    #[getter]
    fn findings(&self) -> Vec<String> {
        self.model.findings.sentences()
    }

    /// Whether further steps with the same transforms would change nothing.
    #[getter]
    fn converged(&self, py: Python<'_>) -> bool {
        self.with(py, |solving| solving.last.converged)
    }

    /// How many iterations were taken towards the last transforms.
    #[getter]
    fn iterations(&self, py: Python<'_>) -> u32 {
        self.with(py, |solving| solving.last.iteration)
    }

    /// The method's energy after the last step, 0 at rest, without unit.
    #[getter]
    fn energy(&self, py: Python<'_>) -> f64 {
        self.with(py, |solving| solving.last.energy)
    }

    /// The largest distance of a handle's vertex from where its transform takes it, after the last step, in world units:
    /// 0 for methods that hold handles exactly.
    #[getter]
    fn handle_residual(&self, py: Python<'_>) -> f64 {
        self.with(py, |solving| solving.last.handle_residual)
    }

    fn __repr__(&self) -> String {
        let (vertices, handles) = (self.model.drawn.vertex_count(), self.setup.handles.len());
        let method = self.setup.method.name();
        format!("<pliant.Bound {method}: {vertices} vertices, {handles} handles>")
    }
}

impl BoundMesh {
    fn targets(&self, any: &Bound<'_, PyAny>) -> PyResult<Vec<DAffine3>> {
        transforms(any, &self.setup)
    }

    fn with<T: Send>(&self, py: Python<'_>, read: impl FnOnce(&Solving) -> T + Send) -> T {
        // Another thread may hold it for as long as a step takes, and may need Python's lock to be stopped.
        py.detach(|| read(&self.solving.lock().unwrap_or_else(PoisonError::into_inner)))
    }

    fn positions(
        &self,
        targets: &[DAffine3],
        most: usize,
        pool: &ThreadPool,
        cancel: &Cancel,
    ) -> Result<Vec<DVec3>, SolveError> {
        let mut solving = self.solving.lock().unwrap_or_else(PoisonError::into_inner);
        let Solving {
            solver,
            displacements,
            last,
        } = &mut *solving;
        let stepped = pool.install(|| {
            solver.set_targets(targets)?;
            *last = settle(solver, displacements, most, cancel)?;
            let mut positions = Vec::new();
            self.model.drawn_positions(displacements, &mut positions);
            Ok(positions)
        });
        stepped.map_err(|error: SolveError| {
            error.renumbered(|vertex| self.model.first_file_vertex(SurfaceVertex(vertex)).0)
        })
    }
}
