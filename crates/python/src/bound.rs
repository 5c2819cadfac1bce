//! A bound mesh: everything is solved except the handles' targets.

use std::sync::{Arc, Mutex, OnceLock, PoisonError};

use glam::{DAffine3, DVec3};
use pliant_deform::{Bound as Solver, Solve, SolveError, Step, Target};
use pliant_editor::{Setup, settle};
use pliant_engine::watch::Watch;
use pliant_engine::{check_bends, check_not_empty, memory, prepare};
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
    /// Each handle's rows of positions, read with the first positions.
    handles: Vec<HandleRows>,
    /// Steps of several threads wait for each other.
    solving: Mutex<Solving>,
}

/// The vertices that a handle's positions are for.
struct HandleRows {
    /// In the order of the array that named them; `None` for a selector.
    order: Option<Vec<i64>>,
    /// The handle's surface vertices, ascending.
    moved: Vec<u32>,
    rows: OnceLock<Result<Rows, String>>,
}

/// The handles' targets for the solver, and the positions of the handles that have them.
struct Targets {
    of_solver: Vec<Target>,
    /// The maps of handles of which some follow lines, which turn far.
    along: Option<pliant_editor::Targets>,
    positions: Vec<(usize, Vec<DVec3>)>,
}

/// The data that a step changes.
struct Solving {
    solver: Solver,
    /// One for each surface vertex.
    displacements: Vec<DVec3>,
    last: Step,
    /// True if targets were set before.
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
/// `ValueError` with the refusal of `pliant apply`.
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
            // Positions may hold a part without a fixed vertex: only the first targets show this.
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
    /// The positions of all vertices for these targets of the handles.
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

    /// Fills in the last step's figures, under the report's names.
    ///
    /// # Errors
    /// If Python has no memory.
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
            along: None,
            positions: Vec::new(),
        };
        let goals = goals(any, &self.setup, count)?;
        // A handle that follows a line is moved by its line first.
        let map = |goal: &Goal| match goal {
            Goal::Map(map) => *map,
            Goal::Rows(_) => DAffine3::IDENTITY,
        };
        let maps: Vec<DAffine3> = goals.iter().map(map).collect();
        let (lines, share) = (&self.setup.lines, self.setup.line_share);
        let along = lines.targets(&maps, share);
        if !lines.is_empty() {
            targets.along = Some(pliant_editor::Targets::new(maps, None).along(lines, share));
        }
        for ((number, goal), along) in goals.into_iter().enumerate().zip(along) {
            targets.of_solver.push(match goal {
                Goal::Map(_) => along,
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

    /// A handle's rows of positions.
    fn rows(&self, handle: usize) -> &Result<Rows, String> {
        let HandleRows { order, moved, rows } = &self.handles[handle];
        rows.get_or_init(|| Rows::of(&self.model, &self.setup, handle, order.as_deref(), moved))
    }

    fn with<T: Send>(&self, py: Python<'_>, read: impl FnOnce(&Solving) -> T + Send) -> T {
        // Another thread may hold it during a whole step, and stopping that step may need Python's lock.
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
            solver.set_cancel(cancel);
            if let Some(along) = &targets.along {
                along.lead(solver, displacements, cancel)?;
            }
            solver.set_free_along(&self.setup.free_along())?;
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
