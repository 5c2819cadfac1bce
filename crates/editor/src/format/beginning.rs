//! The setup of an opened file: an edit, or a saved project.

use glam::DVec3;
use pliant_mesh::{Model, WeldOptions};

use super::json::parse;
use super::matched_by_place::MatchedByPlace;
use super::project::StoredKept;
use crate::document::Document;
use crate::{Camera, EditError, EditFile, ExampleEntry, Project, SequenceEdit, Setup};

/// The regions, handles and options of the beginning.
#[derive(Clone, PartialEq, Debug)]
pub enum Beginning {
    /// An edit, which fits any mesh.
    Edit(Box<EditFile>),
    /// An edit of a sequence, whose mesh was one of its frames.
    Sequence(Box<SequenceEdit>),
    /// A project, which belongs to one mesh.
    Project(Box<Project>),
}

impl Beginning {
    /// Reads either from its JSON text: a project names its mesh, an edit names none.
    ///
    /// # Errors
    /// Members that the formats don't have are refused by name.
    pub fn parse(text: &str) -> Result<Self, EditError> {
        let value = parse(text).map_err(|error| error.at("the file"))?;
        match value.get("mesh") {
            Some(_) => Project::from_value(&value).map(Self::from),
            None => EditFile::from_value(&value).map(Self::from),
        }
    }

    /// The solver's input, on a model.
    ///
    /// # Errors
    /// Those of [`EditFile::resolve`]; a project on another mesh than its own.
    pub fn resolve(&self, model: &Model) -> Result<Setup, EditError> {
        match self {
            Self::Edit(edit) => edit.resolve(model),
            Self::Sequence(own) => own.edit.resolve(model),
            Self::Project(project) => project.resolve(model),
        }
    }

    /// The same by the numbers of `model`, and how much was found, if it is an edit that was made on another mesh
    /// ([`EditFile::placed`]).
    ///
    /// # Errors
    /// Those of [`EditFile::placed`].
    pub fn placed(&self, model: &Model) -> Result<Option<(Self, MatchedByPlace)>, EditError> {
        let placed = match self {
            Self::Edit(edit) => edit.placed(model)?,
            // An edit of a sequence is made from an edit that fits its mesh already.
            Self::Sequence(_) | Self::Project(_) => None,
        };
        Ok(placed.map(|placed| (Self::from(placed.edit), placed.matched)))
    }

    /// Returns true if nothing would move.
    pub fn changes_nothing(&self) -> bool {
        match self {
            Self::Edit(edit) => edit.changes_nothing(),
            Self::Sequence(own) => own.edit.changes_nothing(),
            Self::Project(project) => project.changes_nothing(),
        }
    }

    /// The name of its method.
    pub fn method_name(&self) -> &str {
        match self {
            Self::Edit(edit) => edit.method.name(),
            Self::Sequence(own) => own.edit.method.name(),
            Self::Project(project) => project.method_name(),
        }
    }

    /// The joining of the mesh's vertices before this is resolved on it.
    pub fn weld_options(&self) -> WeldOptions {
        match self {
            Self::Edit(edit) => WeldOptions { distance: edit.weld },
            Self::Sequence(own) => WeldOptions {
                distance: own.edit.weld,
            },
            Self::Project(project) => project.weld_options(),
        }
    }

    /// The files to read before this is resolved: the names of their attachments, and their own names, relative to this
    /// file's folder. A project contains everything.
    pub fn attachment_files(&self) -> Vec<(&'static str, String)> {
        match self {
            Self::Edit(edit) => edit.attachment_files(),
            // Inputs beside handles fit only one frame.
            Self::Sequence(_) | Self::Project(_) => Vec::new(),
        }
    }

    /// The examples with files and morph targets to read before this is resolved. A project contains everything.
    pub fn examples_mut(&mut self) -> impl Iterator<Item = &mut ExampleEntry> {
        let edit = match self {
            Self::Edit(edit) => Some(edit),
            Self::Sequence(_) | Self::Project(_) => None,
        };
        edit.into_iter().flat_map(|edit| edit.examples_mut())
    }

    /// See [`EditFile::bring`].
    ///
    /// # Errors
    /// Those of [`EditFile::bring`].
    pub fn bring(&mut self, name: &'static str, mesh: (Vec<DVec3>, Vec<[u32; 3]>)) -> Result<(), EditError> {
        match self {
            Self::Edit(edit) => edit.bring(name, mesh),
            Self::Sequence(_) | Self::Project(_) => Ok(()),
        }
    }

    /// Chooses another method.
    pub fn set_method(&mut self, method: pliant_deform::Method) {
        match self {
            // The other method's inputs stay: this one ignores them, and they are not written with it.
            Self::Edit(edit) => {
                edit.method = method;
                edit.kept = edit.kept.take().and_then(StoredKept::for_another_method);
            }
            Self::Sequence(own) => own.edit.method = method,
            Self::Project(project) => project.set_method(&method),
        }
    }

    pub(crate) fn document(&self, model: &Model) -> Result<Document, EditError> {
        match self {
            Self::Edit(edit) => super::exchange::import(edit, model),
            Self::Sequence(own) => own.document(model),
            Self::Project(project) => project.shown_document(model),
        }
    }

    pub(crate) fn camera(&self) -> Option<Camera> {
        match self {
            Self::Edit(_) | Self::Sequence(_) => None,
            Self::Project(project) => project.camera(),
        }
    }
}

impl From<EditFile> for Beginning {
    fn from(edit: EditFile) -> Self {
        Self::Edit(Box::new(edit))
    }
}

impl From<Project> for Beginning {
    fn from(project: Project) -> Self {
        Self::Project(Box::new(project))
    }
}

impl From<SequenceEdit> for Beginning {
    fn from(edit: SequenceEdit) -> Self {
        Self::Sequence(Box::new(edit))
    }
}
