//! A mesh as an argument: a mesh that was read from a file, or a pair of vertices and faces.

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

/// A function's mesh.
pub enum Shape {
    /// From a file.
    Loaded(Arc<Loaded>),
    /// Arrays.
    Arrays(Drawn),
}

/// The mesh at `place`.
///
/// # Errors
/// `ValueError` for any other value.
pub fn shape(any: &Bound<'_, PyAny>, place: &str) -> PyResult<Shape> {
    if let Ok(mesh) = any.cast::<Mesh>() {
        return Ok(Shape::Loaded(Arc::clone(mesh.get().loaded())));
    }
    let is_pair = any.is_instance_of::<PyTuple>() || any.is_instance_of::<PyList>();
    if !is_pair || any.len()? != 2 {
        return Err(refused(format!(
            "{place} is not a mesh: give a result of `load`, or a pair (vertices, faces)"
        )));
    }
    let positions = arrays::points(&any.get_item(0)?, &format!("{place}[0]"))?;
    let triangles = arrays::triangles(&any.get_item(1)?, &format!("{place}[1]"), positions.len())?;
    Ok(Shape::Arrays(Drawn::once(positions, triangles)))
}

impl Shape {
    /// The mesh's drawn vertices and triangles.
    pub fn drawn(&self) -> Drawn {
        match self {
            Self::Loaded(loaded) => loaded.model.rest(),
            Self::Arrays(drawn) => drawn.clone(),
        }
    }

    /// The number of drawn vertices.
    pub fn vertex_count(&self) -> usize {
        match self {
            Self::Loaded(loaded) => loaded.model.drawn.vertex_count(),
            Self::Arrays(drawn) => drawn.positions.len(),
        }
    }

    /// The number of vertices that selections number.
    pub fn file_vertex_count(&self) -> usize {
        match self {
            Self::Loaded(loaded) => loaded.model.drawn.file_vertex_count(),
            Self::Arrays(drawn) => drawn.file_vertex_count,
        }
    }

    /// The origin that refusals name.
    pub fn origin(&self) -> Origin<'_> {
        match self {
            Self::Loaded(loaded) => Origin::File(&loaded.path),
            Self::Arrays(_) => Origin::Arrays,
        }
    }

    /// The number of drawn triangles.
    pub fn triangle_count(&self) -> usize {
        match self {
            Self::Loaded(loaded) => loaded.model.drawn.triangle_count(),
            Self::Arrays(drawn) => drawn.triangles.len(),
        }
    }

    /// The mesh's welded surface.
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
