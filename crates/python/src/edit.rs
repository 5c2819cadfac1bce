//! Arguments as an edit: what `bind` takes are the edit format's members, with arrays of vertices as selections.

use pliant_deform::Method;
use pliant_editor::{EDIT_VERSION, EditFile};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList, PyString, PyTuple};
use serde_json::{Map, Value, json};

use crate::arrays;
use crate::refusal::refused;
use crate::values::value;

/// What `bind` takes beside the mesh. All that is `None` has the edit format's default.
pub struct Arguments<'py> {
    /// A name, or a name and options.
    pub method: Option<Bound<'py, PyAny>>,
    /// Selections by name or in a row.
    pub handles: Option<Bound<'py, PyAny>>,
    /// A selection.
    pub fixed: Option<Bound<'py, PyAny>>,
    /// A selection.
    pub region: Option<Bound<'py, PyAny>>,
    /// A number for each vertex, or the edit format's list.
    pub stiffness: Option<Bound<'py, PyAny>>,
    /// A number, one for each vertex, or the edit format's list.
    pub continuity: Option<Bound<'py, PyAny>>,
    /// A name, or the edit format's list.
    pub loose: Option<Bound<'py, PyAny>>,
}

impl Arguments<'_> {
    /// The edit that they describe, on a mesh of `vertex_count` vertices.
    ///
    /// # Errors
    /// `ValueError`, as the edit format refuses.
    pub fn edit(&self, vertex_count: usize) -> PyResult<EditFile> {
        let mut members = Map::new();
        members.insert("version".to_owned(), EDIT_VERSION.into());
        let method = match &self.method {
            None => json!({ "name": Method::default().name() }),
            Some(method) => match method.cast::<PyString>() {
                Ok(name) => json!({ "name": name.to_cow()? }),
                Err(_) => value(method, "method")?,
            },
        };
        members.insert("method".to_owned(), method);
        for (name, selection) in [("fixed", &self.fixed), ("region", &self.region)] {
            if let Some(selection) = selection {
                members.insert(name.to_owned(), selector(selection, name, vertex_count)?);
            }
        }
        if let Some(handles) = &self.handles {
            members.insert("handles".to_owned(), handle_entries(handles, vertex_count)?);
        }
        for (name, field) in [("stiffness", &self.stiffness), ("continuity", &self.continuity)] {
            if let Some(field) = field {
                members.insert(name.to_owned(), field_entries(field, name)?);
            }
        }
        if let Some(loose) = &self.loose {
            members.insert("loose".to_owned(), value(loose, "loose")?);
        }
        let mut edit = EditFile::from_value(&Value::Object(members)).map_err(refused)?;
        refuse_files(&mut edit)?;
        Ok(edit)
    }
}

/// Cages and examples come as numbers: a file that a name would lead to has no folder to be sought in.
fn refuse_files(edit: &mut EditFile) -> PyResult<()> {
    let named = edit.attachment_files().into_iter().map(|(name, _)| name).next();
    let examples = edit.examples_mut().any(|example| {
        use pliant_editor::ExampleSource::{File, MorphTarget};
        matches!(example.source, File(_) | MorphTarget(_))
    });
    match named.or(examples.then_some("examples")) {
        Some(name) => Err(refused(format!(
            "method.{name} names a file or a morph target: load it, and give its numbers"
        ))),
        None => Ok(()),
    }
}

/// A selection: the edit format's selector, or an array of vertices or of switches.
fn selector(any: &Bound<'_, PyAny>, place: &str, vertex_count: usize) -> PyResult<Value> {
    if any.is_instance_of::<PyString>() || any.is_instance_of::<PyDict>() {
        return value(any, place);
    }
    Ok(json!({ "vertices": arrays::numbers(any, place, vertex_count)? }))
}

/// Handles by name, or in a row.
fn handle_entries(handles: &Bound<'_, PyAny>, vertex_count: usize) -> PyResult<Value> {
    let mut entries = Vec::new();
    if let Ok(named) = handles.cast::<PyDict>() {
        for (name, handle) in named {
            let name: String = name
                .extract()
                .map_err(|_| refused(format!("handles has the key {name}: a handle's name is a string")))?;
            let mut entry = handle_entry(&handle, &format!("handles[{name:?}]"), vertex_count)?;
            entry.insert("name".to_owned(), name.into());
            entries.push(Value::Object(entry));
        }
    } else if handles.is_instance_of::<PyList>() || handles.is_instance_of::<PyTuple>() {
        for (number, handle) in handles.try_iter()?.enumerate() {
            let entry = handle_entry(&handle?, &format!("handles[{number}]"), vertex_count)?;
            entries.push(Value::Object(entry));
        }
    } else {
        return Err(refused(format!(
            "handles is of type {}: give a dict of names and selections, or a list of selections",
            handles.get_type().name()?
        )));
    }
    Ok(Value::Array(entries))
}

/// A selection, or a dict with `select` and what else a handle has.
fn handle_entry(handle: &Bound<'_, PyAny>, place: &str, vertex_count: usize) -> PyResult<Map<String, Value>> {
    let mut entry = Map::new();
    match handle.cast::<PyDict>() {
        Ok(members) if members.contains("select")? => {
            for (name, member) in members {
                let name: String = name
                    .extract()
                    .map_err(|_| refused(format!("{place} has the member {name}: names are strings")))?;
                let at = format!("{place}.{name}");
                let member = match &*name {
                    "select" => selector(&member, &at, vertex_count)?,
                    "transform" => {
                        return Err(refused(format!(
                            "{place} has a `transform`: leave it out, and give it to `step`"
                        )));
                    }
                    _ => value(&member, &at)?,
                };
                entry.insert(name, member);
            }
        }
        _ => {
            entry.insert("select".to_owned(), selector(handle, place, vertex_count)?);
        }
    }
    Ok(entry)
}

/// The edit format's list or number, or an array with a value for each vertex.
fn field_entries(field: &Bound<'_, PyAny>, place: &str) -> PyResult<Value> {
    let is_list_of_entries = match field.cast::<PyList>() {
        Ok(list) => list.iter().next().is_some_and(|first| first.is_instance_of::<PyDict>()),
        Err(_) => false,
    };
    if is_list_of_entries {
        return value(field, place);
    }
    let (shape, numbers) = arrays::reals(field, place)?;
    match shape[..] {
        [] => {
            let everywhere = numbers.first().copied().unwrap_or(1.0);
            Ok(json!([{ "select": "all", "value": field_value(everywhere, place, place)? }]))
        }
        [_] => {
            let values = numbers.iter().enumerate();
            let values = values.map(|(number, own)| field_value(*own, place, &format!("{place}[{number}]")));
            Ok(json!([{ "per_vertex": values.collect::<PyResult<Vec<Value>>>()? }]))
        }
        _ => Err(refused(format!(
            "{place} is an array of the shape {shape:?}: give one number for each vertex"
        ))),
    }
}

/// A field's value: infinite stiffness is rigid.
fn field_value(number: f64, field: &str, place: &str) -> PyResult<Value> {
    if field == "stiffness" && number == f64::INFINITY {
        return Ok(json!("rigid"));
    }
    finite(number, place).map(|number| json!(number))
}

/// JSON has no other numbers.
fn finite(number: f64, place: &str) -> PyResult<f64> {
    match number.is_finite() {
        true => Ok(number),
        false => Err(refused(format!("{place} is {number}: give a finite number"))),
    }
}
