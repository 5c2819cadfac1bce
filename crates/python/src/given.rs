//! Arguments that are either the path of a JSON file or its contents: edits, joins and selectors.

use pliant_deform::{Budget, Method};
use pliant_editor::{EDIT_VERSION, EditFile};
use pliant_engine::{Given, memory};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyInt, PyString};
use serde_json::json;

use crate::refusal::refused;
use crate::values::value;

/// The argument `name`: a path, or a dict.
///
/// # Errors
/// `ValueError` for a value without a counterpart in JSON.
pub fn given(any: &Bound<'_, PyAny>, name: &'static str) -> PyResult<Given> {
    if any.is_instance_of::<PyDict>() {
        return value(any, name).map(|contents| Given::Contents(contents, name));
    }
    any.extract().map(Given::File).map_err(|_| {
        let kind = any.get_type().name();
        let kind = kind.map_or_else(|_| "another type".to_owned(), |kind| kind.to_string());
        refused(format!(
            "{name} is of type {kind}: give a path, or a dict of the file's members"
        ))
    })
}

/// The method that replaces an edit's: a name, or a dict of its `name` and options.
///
/// # Errors
/// `ValueError` for an unknown name or option.
pub fn method(any: &Bound<'_, PyAny>) -> PyResult<Method> {
    let method = match any.cast::<PyString>() {
        Ok(name) => json!({ "name": name.to_cow()? }),
        Err(_) => value(any, "method")?,
    };
    let edit = json!({ "version": EDIT_VERSION, "method": method });
    let edit = EditFile::from_value(&edit).map_err(refused)?;
    match edit.attachment_files().first() {
        None => Ok(edit.method),
        Some((name, _)) => Err(refused(format!(
            "method.{name} names a file: put the method into the edit, whose files are read"
        ))),
    }
}

/// The memory that bindings may take: a number of bytes, or text such as `8GB`.
///
/// # Errors
/// `ValueError` for anything else.
pub fn budget(memory: Option<&Bound<'_, PyAny>>) -> PyResult<Budget> {
    let Some(any) = memory else {
        return Ok(memory::budget());
    };
    let bytes = match any.is_instance_of::<PyInt>() {
        true => any.extract::<u64>().map_err(|_| any.to_string()),
        false => any
            .extract::<String>()
            .map_err(|_| any.to_string())
            .and_then(|text| memory::bytes(&text)),
    };
    match bytes {
        Ok(bytes) if bytes > 0 => Ok(memory::budget_within(Some(bytes))),
        _ => Err(refused(format!(
            "memory is {any}: give a number of bytes, or a size such as \"8GB\" or \"500MB\""
        ))),
    }
}
