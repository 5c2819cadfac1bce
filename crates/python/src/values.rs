//! Python's values as values of the edit format: numbers, names, lists and objects.

use pliant_mesh::WeldOptions;
use pyo3::prelude::*;
use pyo3::types::{PyBool, PyDict, PyFloat, PyInt, PyList, PyString, PyTuple};
use serde_json::{Map, Number, Value};

use crate::refusal::refused;

/// The depth of the edit format's values, and a little more. It stops a list that contains itself.
const DEPTH: usize = 32;

/// The value at `place`, e.g. `fixed`. Arrays and numpy's numbers become lists and numbers.
///
/// # Errors
/// `ValueError` for a value without a counterpart.
pub fn value(any: &Bound<'_, PyAny>, place: &str) -> PyResult<Value> {
    at_depth(any, place, DEPTH)
}

fn at_depth(any: &Bound<'_, PyAny>, place: &str, depth: usize) -> PyResult<Value> {
    let Some(below) = depth.checked_sub(1) else {
        return Err(refused(format!("{place} is nested too deeply: see the edit format")));
    };
    if any.is_none() {
        return Ok(Value::Null);
    }
    if let Ok(switch) = any.cast::<PyBool>() {
        return Ok(switch.is_true().into());
    }
    if let Ok(text) = any.cast::<PyString>() {
        return Ok(text.to_cow()?.into_owned().into());
    }
    if any.is_instance_of::<PyInt>() {
        let number = any.extract::<i64>().map(Number::from);
        let number = number.or_else(|_| any.extract::<u64>().map(Number::from));
        return number.map(Value::Number).map_err(|_| {
            refused(format!(
                "{place} is {any}, which is out of range: give a smaller number"
            ))
        });
    }
    if any.is_instance_of::<PyFloat>() {
        let number = Number::from_f64(any.extract()?);
        return number
            .map(Value::Number)
            .ok_or_else(|| refused(format!("{place} is {any}: give a finite number")));
    }
    if let Ok(members) = any.cast::<PyDict>() {
        let mut object = Map::new();
        for (name, member) in members {
            let name: String = name
                .extract()
                .map_err(|_| refused(format!("{place} has the member {name}: names are strings")))?;
            let member = at_depth(&member, &format!("{place}.{name}"), below)?;
            object.insert(name, member);
        }
        return Ok(Value::Object(object));
    }
    if any.is_instance_of::<PyList>() || any.is_instance_of::<PyTuple>() {
        let elements = any.try_iter()?.enumerate();
        let elements = elements.map(|(number, element)| at_depth(&element?, &format!("{place}[{number}]"), below));
        return elements.collect::<PyResult<_>>().map(Value::Array);
    }
    if any.hasattr("tolist")? {
        return at_depth(&any.call_method0("tolist")?, place, below);
    }
    let kind = any.get_type().name()?;
    Err(refused(format!(
        "{place} is of type {kind}: give a number, a name, a list or a dict"
    )))
}

/// Python's dicts, lists and numbers of a JSON text.
///
/// # Errors
/// If the text is not JSON.
pub fn as_python<'py>(py: Python<'py>, json: &str) -> PyResult<Bound<'py, PyAny>> {
    py.import("json")?.call_method1("loads", (json,))
}

/// The welding of vertices, with the distance if one is given.
///
/// # Errors
/// `ValueError` if it is not a distance.
pub fn weld_options(weld: Option<f64>) -> PyResult<WeldOptions> {
    if weld.is_some_and(|distance| !(distance.is_finite() && distance >= 0.0)) {
        return Err(refused("weld is not a distance: give a number of at least 0"));
    }
    Ok(WeldOptions { distance: weld })
}
