//! Arguments as an edit: those of `bind` are the edit format's members, with arrays of vertices as selections.

use pliant_deform::Method;
use pliant_editor::{EDIT_VERSION, EditFile};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList, PyString, PyTuple};
use serde_json::{Map, Value, json};

use crate::arrays;
use crate::refusal::refused;
use crate::values::value;

/// The arguments of `bind` beside the mesh. `None` stands for the edit format's default.
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

/// An edit, and the order of its handles' vertices.
pub struct Edit {
    /// The edit in the edit format.
    pub file: EditFile,
    /// Each handle's vertices in the order of the array that named them; `None` for a selector.
    pub orders: Vec<Option<Vec<i64>>>,
}

impl Arguments<'_> {
    /// The arguments' edit on a mesh of `vertex_count` vertices.
    ///
    /// # Errors
    /// `ValueError` with the edit format's refusal.
    pub fn edit(&self, vertex_count: usize) -> PyResult<Edit> {
        let mut members = Map::new();
        let mut orders = Vec::new();
        members.insert("version".to_owned(), EDIT_VERSION.into());
        let method = match &self.method {
            // The options follow.
            None => json!({ "name": Method::of_new_documents().name() }),
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
            members.insert(
                "handles".to_owned(),
                handle_entries(handles, vertex_count, &mut orders)?,
            );
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
        if self.method.is_none() {
            edit.method = Method::of_new_documents();
        }
        refuse_files(&mut edit)?;
        Ok(Edit { file: edit, orders })
    }
}

/// Refuses names of files: cages and examples are given as numbers, because a name has no folder to start from.
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
    Ok(match numbers(any, place, vertex_count)? {
        Some(numbers) => json!({ "vertices": numbers }),
        None => value(any, place)?,
    })
}

/// The vertices that an array names, in its order; `None` for a selector.
fn numbers(any: &Bound<'_, PyAny>, place: &str, vertex_count: usize) -> PyResult<Option<Vec<i64>>> {
    if any.is_instance_of::<PyString>() || any.is_instance_of::<PyDict>() {
        return Ok(None);
    }
    arrays::numbers(any, place, vertex_count).map(Some)
}

/// Handles by name, or in a row; adds the order of each handle's vertices.
fn handle_entries(
    handles: &Bound<'_, PyAny>,
    vertex_count: usize,
    orders: &mut Vec<Option<Vec<i64>>>,
) -> PyResult<Value> {
    let mut entries = Vec::new();
    if let Ok(named) = handles.cast::<PyDict>() {
        for (name, handle) in named {
            let name: String = name
                .extract()
                .map_err(|_| refused(format!("handles has the key {name}: a handle's name is a string")))?;
            let (mut entry, order) = handle_entry(&handle, &format!("handles[{name:?}]"), vertex_count)?;
            orders.push(order);
            entry.insert("name".to_owned(), name.into());
            entries.push(Value::Object(entry));
        }
    } else if handles.is_instance_of::<PyList>() || handles.is_instance_of::<PyTuple>() {
        for (number, handle) in handles.try_iter()?.enumerate() {
            let (entry, order) = handle_entry(&handle?, &format!("handles[{number}]"), vertex_count)?;
            orders.push(order);
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

/// A handle's members, and its vertices if an array names them.
type HandleEntry = (Map<String, Value>, Option<Vec<i64>>);

/// A selection, or a dict with `select` and a handle's other members.
fn handle_entry(handle: &Bound<'_, PyAny>, place: &str, vertex_count: usize) -> PyResult<HandleEntry> {
    let mut entry = Map::new();
    let mut order = None;
    match handle.cast::<PyDict>() {
        Ok(members) if members.contains("select")? || members.contains("curve")? => {
            for (name, member) in members {
                let name: String = name
                    .extract()
                    .map_err(|_| refused(format!("{place} has the member {name}: names are strings")))?;
                let at = format!("{place}.{name}");
                let member = match &*name {
                    "select" => {
                        order = numbers(&member, &at, vertex_count)?;
                        selector(&member, &at, vertex_count)?
                    }
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
            order = numbers(handle, place, vertex_count)?;
            entry.insert("select".to_owned(), selector(handle, place, vertex_count)?);
        }
    }
    Ok((entry, order))
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
    if place == "stiffness" && field.cast::<PyString>().is_ok_and(|name| name == "rigid") {
        return Ok(json!([{ "select": "all", "value": "rigid" }]));
    }
    if place == "stiffness" && arrays::has_names(field)? {
        return Ok(json!([{ "per_vertex": value(field, place)? }]));
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

/// JSON has only finite numbers.
fn finite(number: f64, place: &str) -> PyResult<f64> {
    match number.is_finite() {
        true => Ok(number),
        false => Err(refused(format!("{place} is {number}: give a finite number"))),
    }
}
