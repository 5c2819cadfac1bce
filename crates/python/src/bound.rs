//! A bound mesh: everything but the handles' transforms is solved.

use std::sync::{Arc, Mutex, OnceLock, PoisonError};

use glam::DVec3;
use pliant_deform::{Bound as Solver, Solve, SolveError, Step, Target};
use pliant_editor::Setup;
use pliant_engine::watch::Watch;
use pliant_engine::{check_bends, check_not_empty, memory, prepare, settle};
use pliant_mesh::{Cancel, Drawn, Model, SurfaceVertex};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use rayon::ThreadPool;

use crate::arrays;
use crate::edit::{Arguments, Edit};
use crate::interruptible::{detached, interruptible};
use crate::origin::Origin;
use crate::refusal::{of_edit, of_engine, refused};
use crate::rows::Rows;
use crate::targets::{Goal, goals};
use crate::values::weld_options;
use crate::warned::warn;
use crate::welded::welded;

#[doc = include_str!(concat!(env!("OUT_DIR"), "/Bound.txt"))]
#[pyclass(frozen, name = "Bound", module = "pliant")]
pub struct BoundMesh {
    model: Arc<Model>,
    setup: Setup,
    /// How positions of each handle's vertices are read, once there are some.
    handles: Vec<HandleRows>,
    /// Steps of several threads wait for one another.
    solving: Mutex<Solving>,
}

/// A handle's vertices as its positions name them.
struct HandleRows {
    /// In the order in which an array named them; `None` where a selector did.
    order: Option<Vec<i64>>,
    /// The surface vertices that it moves, ascending.
    moved: Vec<u32>,
    rows: OnceLock<Result<Rows, String>>,
}

/// Where the handles are to go: as the solver takes it, and the positions of those that have some.
struct Targets {
    of_solver: Vec<Target>,
    positions: Vec<(usize, Vec<DVec3>)>,
}

/// What a step changes.
struct Solving {
    solver: Solver,
    /// Of each surface vertex.
    displacements: Vec<DVec3>,
    last: Step,
    /// Whether there were targets already.
    has_targets: bool,
}

#[doc = include_str!(concat!(env!("OUT_DIR"), "/bind.txt"))]
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
    if positions.is_empty() {
        return Err(refused(
            "vertices has no rows, so there is nothing to bend: give positions",
        ));
    }
    let said = arrays::not_finite(&positions, "vertices");
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
        let model = welded(Drawn::once(positions, triangles), &weld, cancel)?;
        bind_model(Origin::Arrays, model, &edit, cancel)
    };
    let bound = interruptible(py, |pool, cancel| pool.install(|| bind(cancel)))??;
    warn(py, &said.into_iter().collect::<Vec<_>>())?;
    Ok(bound)
}

/// Binds a model to an edit.
///
/// # Errors
/// `ValueError`, as `pliant apply` refuses.
pub fn bind_model(origin: Origin<'_>, model: Arc<Model>, edit: &Edit, cancel: &Cancel) -> PyResult<BoundMesh> {
    let name = origin.name();
    let setup = edit.file.resolve(&model);
    let setup = setup.map_err(|error| of_edit(&error, origin))?;
    let bound = || {
        check_not_empty(name, &model)?;
        check_bends(name, &model, &setup.method)?;
        prepare(name, &model, &setup, memory::budget(), &Watch::cancelled_by(cancel))
    };
    let solver = bound().map_err(|error| of_engine(&error))?.bound;
    let handles = edit.orders.iter().enumerate().map(|(number, order)| HandleRows {
        order: order.clone(),
        moved: solver.handle_vertices(number).to_vec(),
        rows: OnceLock::new(),
    });
    let handles = handles.collect();
    let displacements = vec![DVec3::ZERO; model.surface.positions.len()];
    let solving = Mutex::new(Solving {
        solver,
        displacements,
        last: Step::default(),
        has_targets: false,
    });
    Ok(BoundMesh {
        model,
        setup,
        handles,
        solving,
    })
}

#[pymethods]
impl BoundMesh {
    #[doc = include_str!(concat!(env!("OUT_DIR"), "/Bound.step.txt"))]
    #[pyo3(signature = (transforms, *, iterations=None, out=None))]
    fn step<'py>(
        &self,
        py: Python<'py>,
        transforms: Bound<'py, PyAny>,
        iterations: Option<usize>,
        out: Option<Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let positions = self.bent(py, &transforms, iterations)?;
        match out {
            Some(out) => {
                arrays::write(&positions, &out)?;
                Ok(out)
            }
            None => Ok(arrays::of_points(py, positions)?.into_any()),
        }
    }

    #[doc = include_str!(concat!(env!("OUT_DIR"), "/Bound.handles.txt"))]
    #[getter]
    fn handles(&self) -> Vec<&str> {
        self.setup.handles.iter().map(|handle| &*handle.name).collect()
    }

    #[doc = include_str!(concat!(env!("OUT_DIR"), "/Bound.method.txt"))]
    #[getter]
    fn method(&self) -> &'static str {
        self.setup.method.name()
    }

    #[doc = include_str!(concat!(env!("OUT_DIR"), "/Bound.free_count.txt"))]
    #[getter]
    fn free_count(&self, py: Python<'_>) -> usize {
        self.with(py, |solving| solving.solver.free_count())
    }

    #[doc = include_str!(concat!(env!("OUT_DIR"), "/Bound.warnings.txt"))]
    #[getter]
    fn warnings(&self, py: Python<'_>) -> Vec<String> {
        self.with(py, |solving| {
            // Positions may hold what has no fixed vertex: that is known with the first targets.
            let said = solving.solver.warnings().iter();
            let said = said.filter(|warning| solving.has_targets || !warning.is_of_unheld());
            self.setup.worded(&said.cloned().collect::<Vec<_>>())
        })
    }

    #[doc = include_str!(concat!(env!("OUT_DIR"), "/Bound.findings.txt"))]
    #[getter]
    fn findings(&self) -> Vec<String> {
        self.model.findings.sentences()
    }

    #[doc = include_str!(concat!(env!("OUT_DIR"), "/Bound.converged.txt"))]
    #[getter]
    fn converged(&self, py: Python<'_>) -> bool {
        self.with(py, |solving| solving.last.converged)
    }

    #[doc = include_str!(concat!(env!("OUT_DIR"), "/Bound.iterations.txt"))]
    #[getter]
    fn iterations(&self, py: Python<'_>) -> u32 {
        self.with(py, |solving| solving.last.iteration)
    }

    #[doc = include_str!(concat!(env!("OUT_DIR"), "/Bound.energy.txt"))]
    #[getter]
    fn energy(&self, py: Python<'_>) -> f64 {
        self.with(py, |solving| solving.last.energy)
    }

    #[doc = include_str!(concat!(env!("OUT_DIR"), "/Bound.handle_residual.txt"))]
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
    /// The positions of all vertices with the handles moved so.
    ///
    /// # Errors
    /// `ValueError`, or a signal's exception.
    pub fn bent<'py>(
        &self,
        py: Python<'py>,
        transforms: &Bound<'py, PyAny>,
        iterations: Option<usize>,
    ) -> PyResult<Vec<DVec3>> {
        if iterations == Some(0) {
            return Err(refused(
                "iterations is 0: give at least 1, or leave it out to go on to the end",
            ));
        }
        let targets = self.targets(transforms)?;
        let most = iterations.unwrap_or(usize::MAX);
        let positions = match self.setup.method.solve() {
            Solve::Direct => detached(py, |pool| self.positions(&targets, most, pool, &Cancel::new()))?,
            Solve::Iterative { .. } => interruptible(py, |pool, cancel| self.positions(&targets, most, pool, cancel))?,
        };
        positions.map_err(refused)
    }

    /// Tells about the last step by the report's names.
    ///
    /// # Errors
    /// Where Python has no memory.
    pub fn tell(&self, py: Python<'_>, told: &Bound<'_, PyDict>) -> PyResult<()> {
        told.set_item("method", self.method())?;
        told.set_item("free_vertices", self.free_count(py))?;
        told.set_item("iterations", self.iterations(py))?;
        told.set_item("converged", self.converged(py))?;
        told.set_item("energy", self.energy(py))?;
        told.set_item("handle_residual", self.handle_residual(py))?;
        told.set_item("warnings", self.warnings(py))
    }

    fn targets(&self, any: &Bound<'_, PyAny>) -> PyResult<Targets> {
        let count = |handle: usize| self.rows(handle).as_ref().ok().map(|rows| rows.numbers.len());
        let mut targets = Targets {
            of_solver: Vec::new(),
            positions: Vec::new(),
        };
        for (number, goal) in goals(any, &self.setup, count)?.into_iter().enumerate() {
            targets.of_solver.push(match goal {
                Goal::Map(map) => Target::Map(map),
                Goal::Rows(positions) => {
                    let rows = self.rows(number).as_ref();
                    let places = rows.map_err(Clone::clone);
                    let places = places.and_then(|rows| rows.places(&self.model, &positions));
                    let places = places.map_err(|said| {
                        let name = &self.setup.handles[number].name;
                        refused(format!("transforms[{name:?}] {said}"))
                    })?;
                    targets.positions.push((number, positions));
                    Target::Places(places)
                }
            });
        }
        Ok(targets)
    }

    /// How a handle's positions are read.
    fn rows(&self, handle: usize) -> &Result<Rows, String> {
        let HandleRows { order, moved, rows } = &self.handles[handle];
        rows.get_or_init(|| Rows::of(&self.model, &self.setup, handle, order.as_deref(), moved))
    }

    fn with<T: Send>(&self, py: Python<'_>, read: impl FnOnce(&Solving) -> T + Send) -> T {
        // Another thread may hold it for as long as a step takes, and may need Python's lock to be stopped.
        py.detach(|| read(&self.solving.lock().unwrap_or_else(PoisonError::into_inner)))
    }

    fn positions(
        &self,
        targets: &Targets,
        most: usize,
        pool: &ThreadPool,
        cancel: &Cancel,
    ) -> Result<Vec<DVec3>, SolveError> {
        let mut solving = self.solving.lock().unwrap_or_else(PoisonError::into_inner);
        let Solving {
            solver,
            displacements,
            last,
            has_targets,
        } = &mut *solving;
        let stepped = pool.install(|| {
            solver.set_places(&targets.of_solver)?;
            *has_targets = true;
            *last = settle(solver, displacements, most, cancel)?;
            let mut positions = Vec::new();
            self.model.drawn_positions(displacements, &mut positions);
            for (handle, own) in &targets.positions {
                if let (Ok(rows), None) = (self.rows(*handle), self.setup.soft[*handle]) {
                    rows.put(own, &mut positions);
                }
            }
            Ok(positions)
        });
        stepped.map_err(|error: SolveError| {
            error.renumbered(|vertex| self.model.first_file_vertex(SurfaceVertex(vertex)).0)
        })
    }
}
