//! A mesh as functions take it: one that was read from a file, or a pair of vertices and faces.

use std::sync::Arc;

use pliant_engine::Loaded;
use pliant_mesh::{Cancel, Drawn, Model, WeldOptions};
use pyo3::prelude::*;
use pyo3::types::{PyList, PyTuple};

use crate::arrays;
use crate::mesh::Mesh;
use crate::origin::Origin;
use crate::refusal::refused;
use crate::welded::welded;

/// A mesh that a function was given.
pub enum Shape {
    /// From a file.
    Loaded(Arc<Loaded>),
    /// Arrays.
    Arrays(Drawn),
}

/// The mesh at `place`.
///
/// # Errors
/// `ValueError` for what is none.
pub fn shape(any: &Bound<'_, PyAny>, place: &str) -> PyResult<Shape> {
    if let Ok(mesh) = any.cast::<Mesh>() {
        return Ok(Shape::Loaded(Arc::clone(mesh.get().loaded())));
    }
    let is_pair = any.is_instance_of::<PyTuple>() || any.is_instance_of::<PyList>();
    if !is_pair || any.len()? != 2 {
        return Err(refused(format!(
            "{place} is no mesh: give what `load` returned, or a pair (vertices, faces)"
        )));
    }
    let positions = arrays::points(&any.get_item(0)?, &format!("{place}[0]"))?;
    let triangles = arrays::triangles(&any.get_item(1)?, &format!("{place}[1]"), positions.len())?;
    Ok(Shape::Arrays(Drawn::once(positions, triangles)))
}

impl Shape {
    /// What it shows.
    pub fn drawn(&self) -> Drawn {
        match self {
            Self::Loaded(loaded) => loaded.model.rest(),
            Self::Arrays(drawn) => drawn.clone(),
        }
    }

    /// How many vertices it shows.
    pub fn vertex_count(&self) -> usize {
        match self {
            Self::Loaded(loaded) => loaded.model.drawn.vertex_count(),
            Self::Arrays(drawn) => drawn.positions.len(),
        }
    }

    /// How many vertices selections number.
    pub fn file_vertex_count(&self) -> usize {
        match self {
            Self::Loaded(loaded) => loaded.model.drawn.file_vertex_count(),
            Self::Arrays(drawn) => drawn.file_vertex_count,
        }
    }

    /// What refusals speak of.
    pub fn origin(&self) -> Origin<'_> {
        match self {
            Self::Loaded(loaded) => Origin::File(&loaded.path),
            Self::Arrays(_) => Origin::Arrays,
        }
    }

    /// How many triangles it shows.
    pub fn triangle_count(&self) -> usize {
        match self {
            Self::Loaded(loaded) => loaded.model.drawn.triangle_count(),
            Self::Arrays(drawn) => drawn.triangles.len(),
        }
    }

    /// Its welded surface.
    ///
    /// # Errors
    /// `KeyboardInterrupt`.
    pub fn model(&self, cancel: &Cancel) -> PyResult<Arc<Model>> {
        match self {
            Self::Loaded(loaded) => Ok(Arc::clone(&loaded.model)),
            Self::Arrays(drawn) => welded(drawn.clone(), &WeldOptions::default(), cancel),
        }
    }
}
