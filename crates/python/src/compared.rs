//! The differences of two files, and the distortion of a shape.

use std::path::PathBuf;
use std::sync::Arc;

use glam::DVec3;
use pliant_engine::watch::Watch;
use pliant_engine::{Compared, Difference, Loaded, What, differences};
use pliant_mesh::{Cancel, Distortion, Model};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::arrays;
use crate::interruptible::interruptible;
use crate::mesh::Mesh;
use crate::refusal::{of_engine, refused};
use crate::shape::shape;

#[doc = include_str!(concat!(env!("OUT_DIR"), "/distortion.txt"))]
#[pyfunction]
pub fn distortion<'py>(
    py: Python<'py>,
    mesh: &Bound<'py, PyAny>,
    bent: &Bound<'py, PyAny>,
) -> PyResult<Bound<'py, PyDict>> {
    let shape = shape(mesh, "mesh")?;
    let bent = rows(bent, shape.vertex_count())?;
    let measure = |cancel: &Cancel| {
        let model = shape.model(cancel)?;
        Ok::<_, PyErr>(distortion_of(&model, &on_surface(&model, &bent)))
    };
    let distortion = interruptible(py, |pool, cancel| pool.install(|| measure(cancel)))??;
    as_dict(py, &distortion)
}

/// Finite positions for `vertex_count` vertices.
fn rows(bent: &Bound<'_, PyAny>, count: usize) -> PyResult<Vec<DVec3>> {
    let bent = arrays::points(bent, "bent")?;
    if bent.len() != count {
        return Err(refused(format!(
            "bent has {} rows, but the mesh has {count} vertices: give a row for each",
            bent.len()
        )));
    }
    arrays::check_finite(&bent, "bent")?;
    Ok(bent)
}

/// The distortion of a surface whose vertices are moved to `bent`.
pub fn distortion_of(model: &Model, bent: &[DVec3]) -> Distortion {
    Distortion::of(&model.surface, &model.topology, bent)
}

/// The surface vertices' positions: each has the displacement of its first drawn vertex.
pub fn on_surface(model: &Model, bent: &[DVec3]) -> Vec<DVec3> {
    let rest = model.rest_positions();
    let mut surface: Vec<Option<DVec3>> = vec![None; model.surface.positions.len()];
    let each = model.drawn.surface_vertices().zip(bent.iter().zip(&rest));
    for (vertex, (bent, rest)) in each {
        if let Some(vertex) = vertex {
            let moved = model.surface.positions[vertex.index()] + (*bent - *rest);
            surface[vertex.index()].get_or_insert(moved);
        }
    }
    let each = surface.into_iter().zip(&model.surface.positions);
    each.map(|(moved, rest)| moved.unwrap_or(*rest)).collect()
}

/// A dict with the report's names.
pub fn as_dict<'py>(py: Python<'py>, distortion: &Distortion) -> PyResult<Bound<'py, PyDict>> {
    let told = PyDict::new(py);
    told.set_item("edge_stretch_mean", distortion.edge_stretch_mean)?;
    told.set_item("edge_stretch_max", distortion.edge_stretch_max)?;
    told.set_item("flipped_faces", distortion.flipped_faces)?;
    told.set_item("volume_ratio", distortion.volume_ratio)?;
    Ok(told)
}

#[doc = include_str!(concat!(env!("OUT_DIR"), "/diff.txt"))]
#[pyfunction]
pub fn diff<'py>(
    py: Python<'py>,
    first: &Bound<'py, PyAny>,
    second: &Bound<'py, PyAny>,
) -> PyResult<Vec<Bound<'py, PyDict>>> {
    let (first, second) = (file(first)?, file(second)?);
    let differences = interruptible(py, |pool, cancel| {
        pool.install(|| differences(first.compared(), second.compared(), &Watch::cancelled_by(cancel)))
    })?;
    let differences = differences.map_err(|error| of_engine(&error))?;
    differences.iter().map(|one| of_difference(py, one)).collect()
}

/// A file's path, or a file that was read.
enum File {
    Named(PathBuf),
    Read(Arc<Loaded>),
}

fn file(any: &Bound<'_, PyAny>) -> PyResult<File> {
    match any.cast::<Mesh>() {
        Ok(mesh) => Ok(File::Read(Arc::clone(mesh.get().loaded()))),
        Err(_) => any.extract().map(File::Named),
    }
}

impl File {
    fn compared(&self) -> Compared<'_> {
        match self {
            Self::Named(path) => Compared::File(path),
            Self::Read(loaded) => Compared::Loaded(loaded),
        }
    }
}

/// A dict with the members of `pliant diff --json`.
fn of_difference<'py>(py: Python<'py>, difference: &Difference) -> PyResult<Bound<'py, PyDict>> {
    let told = PyDict::new(py);
    told.set_item("place", &difference.place)?;
    told.set_item("sentence", difference.to_string())?;
    if let What::Elements { elements, of, largest } = &difference.what {
        told.set_item("elements", elements)?;
        told.set_item("of", of)?;
        told.set_item("largest", largest)?;
    }
    Ok(told)
}
