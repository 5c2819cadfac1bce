//! Edits, joins and selectors that a caller gives as the path of a JSON file or as its contents.

use std::path::{Path, PathBuf};

use pliant_editor::{Beginning, CutCurve, EditError, EditFile, JoinsFile, Selector};
use serde_json::Value;

use crate::watch::Watch;
use crate::{EngineError, control_mesh, read_edit, stitching};

/// A JSON file, or its contents.
#[derive(Clone, Debug)]
pub enum Given {
    /// The file's path.
    File(PathBuf),
    /// The contents, and the argument's name.
    Contents(Value, &'static str),
}

impl Given {
    /// The path, or the argument's name: the place that messages name. Files that contents name are relative to the
    /// working directory.
    pub fn place(&self) -> &Path {
        match self {
            Self::File(path) => path,
            Self::Contents(_, name) => Path::new(name),
        }
    }

    /// The path with its role, if it is a file: no output may be this file.
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

    /// The curve of a cut.
    ///
    /// # Errors
    /// A file that can't be read, or no curve.
    pub fn cut_curve(&self, watch: &Watch) -> Result<CutCurve, EngineError> {
        match self {
            Self::File(path) => stitching::read_cut_curve(path, watch),
            Self::Contents(contents, _) => CutCurve::parse(&contents.to_string()).map_err(|error| self.refused(error)),
        }
    }

    fn refused(&self, source: EditError) -> EngineError {
        EngineError::Edit {
            edit: self.place().to_owned(),
            source,
        }
    }
}
