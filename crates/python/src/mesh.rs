//! Files, read with their whole contents and saved with new positions.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use glam::DVec3;
use numpy::PyArray2;
use pliant_engine::files::{self, Staging};
use pliant_engine::saving::{self, SaveAs};
use pliant_engine::watch::Watch;
use pliant_engine::{EngineError, Loaded, load as load_file};
use pliant_mesh::Progress;
use pyo3::prelude::*;

use crate::arrays;
use crate::bound::{BoundMesh, bind_model};
use crate::edit::Arguments;
use crate::interruptible::interruptible;
use crate::origin::Origin;
use crate::refusal::{of_engine, refused};
use crate::values::weld_options;

#[doc = include_str!(concat!(env!("OUT_DIR"), "/Mesh.txt"))]
#[pyclass(frozen, module = "pliant")]
pub struct Mesh {
    loaded: Arc<Loaded>,
}

impl Mesh {
    /// The file.
    pub fn loaded(&self) -> &Arc<Loaded> {
        &self.loaded
    }
}

#[pymethods]
impl Mesh {
    #[doc = include_str!(concat!(env!("OUT_DIR"), "/Mesh.vertices.txt"))]
    #[getter]
    fn vertices<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        arrays::of_points(py, self.loaded.model.rest_positions())
    }

    #[doc = include_str!(concat!(env!("OUT_DIR"), "/Mesh.faces.txt"))]
    #[getter]
    fn faces<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<u32>>> {
        arrays::of_triangles(py, &self.loaded.model.drawn_triangles())
    }

    #[doc = include_str!(concat!(env!("OUT_DIR"), "/Mesh.file_vertices.txt"))]
    #[getter]
    fn file_vertices<'py>(&self, py: Python<'py>) -> Bound<'py, numpy::PyArray1<u32>> {
        let numbers = self.loaded.model.drawn.file_vertices().map(|vertex| vertex.0);
        numpy::PyArray1::from_iter(py, numbers)
    }

    #[doc = include_str!(concat!(env!("OUT_DIR"), "/Mesh.path.txt"))]
    #[getter]
    fn path(&self) -> PathBuf {
        self.loaded.path.clone()
    }

    #[doc = include_str!(concat!(env!("OUT_DIR"), "/Mesh.findings.txt"))]
    #[getter]
    fn findings(&self) -> Vec<String> {
        let mut said = self.loaded.scene.notes().to_vec();
        said.extend(self.loaded.model.findings.sentences());
        said
    }

    #[doc = include_str!(concat!(env!("OUT_DIR"), "/Mesh.bind.txt"))]
    #[pyo3(signature = (*, handles=None, fixed=None, region=None, stiffness=None, continuity=None, loose=None, method=None))]
    #[expect(clippy::too_many_arguments, reason = "they are the edit format's members, by name")]
    fn bind<'py>(
        &self,
        py: Python<'py>,
        handles: Option<Bound<'py, PyAny>>,
        fixed: Option<Bound<'py, PyAny>>,
        region: Option<Bound<'py, PyAny>>,
        stiffness: Option<Bound<'py, PyAny>>,
        continuity: Option<Bound<'py, PyAny>>,
        loose: Option<Bound<'py, PyAny>>,
        method: Option<Bound<'py, PyAny>>,
    ) -> PyResult<BoundMesh> {
        let arguments = Arguments {
            method,
            handles,
            fixed,
            region,
            stiffness,
            continuity,
            loose,
        };
        let edit = arguments.edit(self.loaded.model.drawn.file_vertex_count())?;
        let loaded = &*self.loaded;
        interruptible(py, |pool, cancel| {
            pool.install(|| bind_model(Origin::File(&loaded.path), Arc::clone(&loaded.model), &edit, cancel))
        })?
    }

    fn __repr__(&self) -> String {
        let drawn = &self.loaded.model.drawn;
        let (vertices, triangles) = (drawn.vertex_count(), drawn.triangle_count());
        let name = files::shown(&self.loaded.path);
        format!("<pliant.Mesh {name}: {vertices} vertices, {triangles} triangles>")
    }
}

#[doc = include_str!(concat!(env!("OUT_DIR"), "/load.txt"))]
#[pyfunction]
#[pyo3(signature = (path, *, weld=None))]
pub fn load(py: Python<'_>, path: PathBuf, weld: Option<f64>) -> PyResult<Mesh> {
    let options = weld_options(weld)?;
    let loaded = interruptible(py, |pool, cancel| {
        pool.install(|| load_file(&path, &options, &Watch::cancelled_by(cancel)))
    })?;
    let loaded = loaded.map_err(|error| of_engine(&error))?;
    Ok(Mesh {
        loaded: Arc::new(loaded),
    })
}

#[doc = include_str!(concat!(env!("OUT_DIR"), "/save.txt"))]
#[pyfunction]
#[pyo3(signature = (path, mesh, vertices=None))]
pub fn save(
    py: Python<'_>,
    path: PathBuf,
    mesh: &Bound<'_, Mesh>,
    vertices: Option<&Bound<'_, PyAny>>,
) -> PyResult<Vec<String>> {
    let loaded = Arc::clone(&mesh.get().loaded);
    let count = loaded.model.drawn.vertex_count();
    let positions = match vertices {
        Some(vertices) => arrays::points(vertices, "vertices")?,
        None => loaded.model.rest_positions(),
    };
    if positions.len() != count {
        return Err(refused(format!(
            "vertices has {} rows, but the mesh has {count} vertices: give a row for each",
            positions.len()
        )));
    }
    let saved = interruptible(py, |pool, cancel| {
        pool.install(|| saved(&loaded, &positions, &path, &Watch::cancelled_by(cancel)))
    })?;
    saved.map_err(|error| of_engine(&error))
}

fn saved(loaded: &Loaded, positions: &[DVec3], path: &Path, watch: &Watch) -> Result<Vec<String>, EngineError> {
    files::refuse_shared(("path", path), loaded.sources().skip(1))?;
    let staging = Staging::default();
    let save = SaveAs::shape(positions, path);
    let saved = saving::stage(loaded, &save, &staging, &Progress::new(), &watch.cancel)?;
    if watch.cancel.is_cancelled() {
        return Err(EngineError::Interrupted);
    }
    saved.staged.commit()?;
    Ok(saved.warnings)
}
