//! A mesh's plane of symmetry, and the vertices on its other side.

use numpy::PyArray1;
use pliant_mesh::{Bvh, Cancel, Cancelled, MirrorPlane, Model, Progress, SurfaceVertex, image_of, symmetry_plane};
use pyo3::exceptions::PyKeyboardInterrupt;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::interruptible::interruptible;
use crate::shape::shape;

#[doc = include_str!(concat!(env!("OUT_DIR"), "/symmetry.txt"))]
#[pyfunction]
pub fn symmetry<'py>(py: Python<'py>, mesh: &Bound<'py, PyAny>) -> PyResult<Option<Bound<'py, PyDict>>> {
    let shape = shape(mesh, "mesh")?;
    let search = |cancel: &Cancel| -> PyResult<_> {
        let model = shape.model(cancel)?;
        found(&model, cancel).map_err(|_| PyKeyboardInterrupt::new_err(()))
    };
    let found = interruptible(py, |pool, cancel| pool.install(|| search(cancel)))??;
    let Some((plane, images)) = found else {
        return Ok(None);
    };
    let told = PyDict::new(py);
    let normal = plane.normal();
    told.set_item("plane", (normal.x, normal.y, normal.z, plane.distance()))?;
    told.set_item("images", PyArray1::from_vec(py, images))?;
    Ok(Some(told))
}

/// The plane, and for each drawn vertex the number of the drawn vertex nearest to its image, −1 if there is none.
fn found(model: &Model, cancel: &Cancel) -> Result<Option<(MirrorPlane, Vec<i64>)>, Cancelled> {
    let (surface, topology) = (&model.surface, &model.topology);
    let bvh = Bvh::build(&surface.positions, &surface.triangles);
    let Some(plane) = symmetry_plane(surface, topology, &bvh, &Progress::new(), cancel)? else {
        return Ok(None);
    };
    let mut drawn = vec![None; surface.positions.len()];
    for (number, vertex) in (0_i64..).zip(model.drawn.surface_vertices()) {
        if let Some(vertex) = vertex {
            drawn[vertex.index()].get_or_insert(number);
        }
    }
    let image = |vertex: SurfaceVertex| {
        let image = image_of(&surface.positions, topology, &bvh, plane, vertex);
        image.and_then(|image| drawn[image.index()]).unwrap_or(-1)
    };
    let images = model.drawn.surface_vertices();
    let images = images.map(|vertex| vertex.map_or(-1, image)).collect();
    Ok(Some((plane, images)))
}
