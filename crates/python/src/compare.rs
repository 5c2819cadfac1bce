//! One edit by several methods, like `pliant compare` without its picture.

use std::sync::Arc;

use pliant_deform::METHODS;
use pliant_engine::report::detail_error;
use pliant_mesh::Model;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyString};

use crate::arrays;
use crate::bound::{BoundMesh, bind_model};
use crate::compared::{as_dict, distortion_of, on_surface};
use crate::edit::Arguments;
use crate::interruptible::interruptible;
use crate::refusal::refused;
use crate::shape::{Shape, shape};

#[doc = include_str!(concat!(env!("OUT_DIR"), "/compare.txt"))]
#[pyfunction]
#[pyo3(signature = (mesh, transforms, *, methods=None, handles=None, fixed=None, region=None, stiffness=None, continuity=None, loose=None))]
#[expect(clippy::too_many_arguments, reason = "they are the edit format's members, by name")]
pub fn compare<'py>(
    py: Python<'py>,
    mesh: &Bound<'py, PyAny>,
    transforms: Bound<'py, PyAny>,
    methods: Option<&Bound<'py, PyAny>>,
    handles: Option<Bound<'py, PyAny>>,
    fixed: Option<Bound<'py, PyAny>>,
    region: Option<Bound<'py, PyAny>>,
    stiffness: Option<Bound<'py, PyAny>>,
    continuity: Option<Bound<'py, PyAny>>,
    loose: Option<Bound<'py, PyAny>>,
) -> PyResult<Bound<'py, PyDict>> {
    let shape = shape(mesh, "mesh")?;
    let asked = asked(py, methods)?;
    let model = interruptible(py, |pool, cancel| pool.install(|| shape.model(cancel)))??;
    let outcomes = PyDict::new(py);
    let mut errors = Vec::new();
    for (label, method) in asked {
        let arguments = Arguments {
            method: Some(method),
            handles: handles.clone(),
            fixed: fixed.clone(),
            region: region.clone(),
            stiffness: stiffness.clone(),
            continuity: continuity.clone(),
            loose: loose.clone(),
        };
        let outcome = PyDict::new(py);
        match bent(py, &shape, &model, &arguments, &transforms, &outcome) {
            Ok(error) => errors.push((outcome.clone(), error)),
            Err(error) if error.is_instance_of::<PyValueError>(py) => {
                outcome.set_item("refused", error.value(py).to_string())?;
            }
            Err(error) => return Err(error),
        }
        outcomes.set_item(label, outcome)?;
    }
    let least = errors.iter().map(|(_, error)| *error).min_by(f64::total_cmp);
    for (outcome, error) in errors {
        let ratio = least.filter(|least| *least > 0.0).map(|least| error / least);
        outcome.set_item("detail_error_ratio", ratio)?;
    }
    Ok(outcomes)
}

/// Methods by label: the given ones, or all with their defaults.
fn asked<'py>(py: Python<'py>, methods: Option<&Bound<'py, PyAny>>) -> PyResult<Vec<(String, Bound<'py, PyAny>)>> {
    let Some(methods) = methods else {
        let all = METHODS.iter().map(|declaration| declaration.name);
        return Ok(all
            .map(|name| (name.to_owned(), PyString::new(py, name).into_any()))
            .collect());
    };
    if let Ok(labelled) = methods.cast::<PyDict>()
        && !labelled.contains("name")?
    {
        return labelled
            .iter()
            .map(|(label, method)| Ok((label.extract()?, method)))
            .collect();
    }
    let is_one = methods.is_instance_of::<PyString>() || methods.is_instance_of::<PyDict>();
    let each = match is_one {
        true => vec![methods.clone()],
        false => methods.try_iter()?.collect::<PyResult<Vec<_>>>()?,
    };
    let mut asked: Vec<(String, Bound<'py, PyAny>)> = Vec::new();
    for method in each {
        let name: String = match method.cast::<PyDict>() {
            Ok(members) => members
                .get_item("name")?
                .map_or(Ok(String::new()), |name| name.extract())?,
            Err(_) => method.extract()?,
        };
        if asked.iter().any(|(label, _)| *label == name) {
            return Err(refused(format!(
                "methods names {name} twice: give a dict of labels and methods"
            )));
        }
        asked.push((name, method));
    }
    Ok(asked)
}

/// Fills in one method's result; returns its detail error.
fn bent<'py>(
    py: Python<'py>,
    shape: &Shape,
    model: &Arc<Model>,
    arguments: &Arguments<'py>,
    transforms: &Bound<'py, PyAny>,
    outcome: &Bound<'py, PyDict>,
) -> PyResult<f64> {
    let edit = arguments.edit(shape.file_vertex_count())?;
    let bound: BoundMesh = interruptible(py, |pool, cancel| {
        pool.install(|| bind_model(shape.origin(), Arc::clone(model), &edit, cancel))
    })??;
    let positions = bound.bent(py, transforms, None)?;
    let (distortion, error) = interruptible(py, |pool, _| {
        pool.install(|| {
            let surface = on_surface(model, &positions);
            (distortion_of(model, &surface), detail_error(model, &surface))
        })
    })?;
    outcome.set_item("vertices", arrays::of_points(py, positions)?)?;
    outcome.set_item("distortion", as_dict(py, &distortion)?)?;
    outcome.set_item("detail_error", error)?;
    bound.tell(py, outcome)?;
    Ok(error)
}
