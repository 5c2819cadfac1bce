//! Dye that flows along a surface, like `pliant flow`.

use pliant_editor::{EDIT_VERSION, FlowFile};
use pliant_engine::watch::Watch;
use pliant_engine::{Flowing, memory};
use pliant_mesh::{Cancel, DrawnVertex};
use pyo3::prelude::*;
use serde_json::{Map, Value};

use crate::arrays;
use crate::interruptible::interruptible;
use crate::refusal::{of_engine, refused};
use crate::shape::shape;
use crate::values::value;
use crate::warned::warn;

#[doc = include_str!(concat!(env!("OUT_DIR"), "/flow.txt"))]
#[pyfunction]
#[pyo3(signature = (mesh, *, dye=None, velocity=None, gravity=None, viscosity=None, confinement=None, advection=None, step=None, seconds=None))]
#[expect(clippy::too_many_arguments, reason = "they are the flow format's members, by name")]
pub fn flow<'py>(
    py: Python<'py>,
    mesh: &Bound<'py, PyAny>,
    dye: Option<Bound<'py, PyAny>>,
    velocity: Option<Bound<'py, PyAny>>,
    gravity: Option<Bound<'py, PyAny>>,
    viscosity: Option<Bound<'py, PyAny>>,
    confinement: Option<Bound<'py, PyAny>>,
    advection: Option<Bound<'py, PyAny>>,
    step: Option<Bound<'py, PyAny>>,
    seconds: Option<Bound<'py, PyAny>>,
) -> PyResult<Bound<'py, PyAny>> {
    let shape = shape(mesh, "mesh")?;
    let mut members = Map::new();
    members.insert("version".to_owned(), EDIT_VERSION.into());
    for (name, given) in [
        ("dye", dye),
        ("velocity", velocity),
        ("gravity", gravity),
        ("viscosity", viscosity),
        ("confinement", confinement),
        ("advection", advection),
        ("step", step),
        ("seconds", seconds),
    ] {
        if let Some(given) = given {
            members.insert(name.to_owned(), value(&given, name)?);
        }
    }
    let file = FlowFile::from_value(&Value::Object(members)).map_err(refused)?;
    let run = |cancel: &Cancel| -> PyResult<_> {
        let model = shape.model(cancel)?;
        let start = file.resolve(&model).map_err(refused)?;
        let watch = Watch::cancelled_by(cancel);
        let origin = (shape.origin().name(), &*model);
        let begun = Flowing::begin(origin, (&file, &start), memory::budget(), &watch);
        let mut flow = begun.map_err(|error| of_engine(&error))?;
        for _ in 0..file.steps() {
            flow.step(cancel).map_err(|error| of_engine(&error))?;
        }
        let dyes = flow.flow().dyes();
        let vertices = (0..model.drawn.vertex_count() as u32).map(DrawnVertex);
        let of_drawn = vertices.map(|vertex| {
            let surface = model.drawn.surface_vertex(vertex);
            surface.map_or([0.0; 4], |surface| dyes[surface.index()])
        });
        Ok((of_drawn.collect::<Vec<[f64; 4]>>(), flow.warning()))
    };
    let (dyes, warning) = interruptible(py, |pool, cancel| pool.install(|| run(cancel)))??;
    warn(py, warning.as_slice())?;
    Ok(arrays::of_colours(py, dyes)?.into_any())
}
