//! Arguments that are either the path of a JSON file or its contents: edits, joins and selectors.

use std::path::{Path, PathBuf};

use pliant_deform::{Budget, Method};
use pliant_editor::{Beginning, EDIT_VERSION, EditError, EditFile, JoinsFile, Selector};
use pliant_engine::watch::Watch;
use pliant_engine::{EngineError, control_mesh, memory, read_edit, stitching};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyInt, PyString};
use serde_json::{Value, json};

use crate::refusal::refused;
use crate::values::value;

/// A JSON file, or its contents.
pub enum Given {
    /// The file's path.
    File(PathBuf),
    /// The contents, and the argument's name.
    Contents(Value, &'static str),
}

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

impl Given {
    /// The path, or the argument's name: the place that messages name. The files that a dict names are relative to the
    /// working directory.
    pub fn place(&self) -> &Path {
        match self {
            Self::File(path) => path,
            Self::Contents(_, name) => Path::new(name),
        }
    }

    /// The path with its role, unless it is a dict: no output may be this file.
    pub fn source(&self) -> Option<(&'static str, &Path)> {
        match self {
            Self::File(path) => Some(("--edit", path)),
            Self::Contents(..) => None,
        }
    }

    /// The name of an edit: that of its file without extensions, or `edit`.
    pub fn own_name(&self) -> String {
        let stem = self.place().file_stem().unwrap_or_default().to_string_lossy();
        stem.strip_suffix(".edit").unwrap_or(&stem).to_owned()
    }

    /// The edit or project.
    ///
    /// # Errors
    /// A file that can't be read, or members that the format does not have.
    pub fn edit(&self, watch: &Watch) -> Result<Beginning, EngineError> {
        match self {
            Self::File(path) => read_edit(path, watch),
            Self::Contents(contents, _) => {
                let mut edit = Beginning::from(EditFile::from_value(contents).map_err(|error| self.refused(error))?);
                control_mesh::bring(&mut edit, self.place(), watch)?;
                Ok(edit)
            }
        }
    }

    /// The joins.
    ///
    /// # Errors
    /// A file that can't be read, or members that the format does not have.
    pub fn joins(&self, watch: &Watch) -> Result<JoinsFile, EngineError> {
        match self {
            Self::File(path) => stitching::read_joins(path, watch),
            Self::Contents(contents, _) => JoinsFile::parse(&contents.to_string()).map_err(|error| self.refused(error)),
        }
    }

    /// The selector.
    ///
    /// # Errors
    /// A file that can't be read, or no selector.
    pub fn selector(&self, watch: &Watch) -> Result<Selector, EngineError> {
        match self {
            Self::File(path) => stitching::read_selector(path, watch),
            Self::Contents(contents, _) => Selector::parse(&contents.to_string()).map_err(|error| self.refused(error)),
        }
    }

    fn refused(&self, source: EditError) -> EngineError {
        EngineError::Edit {
            edit: self.place().to_owned(),
            source,
        }
    }
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
