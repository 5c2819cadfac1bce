//! What a save is asked to write, and what comes of it.

use std::collections::BTreeSet;
use std::path::PathBuf;
use std::sync::Arc;

use glam::DVec3;
use pliant_editor::{EditFile, SaveMark, Snapshot};
use pliant_render::Image;

use super::rest_mesh::{MeshSource, RestMesh};
use pliant_engine::files::KnownFiles;

/// What is to be written.
#[derive(Clone)]
pub struct SaveRequest {
    /// Where.
    pub path: PathBuf,
    /// What.
    pub content: Content,
    /// The files of the open model, which nothing else may be saved over.
    pub sources: Vec<PathBuf>,
    /// The files that the window has read or written, as they were then.
    pub known: KnownFiles,
    /// What to do where one of them that is to be replaced has another content now.
    pub changed: Changed,
    /// The state of the document that is written.
    pub mark: SaveMark,
    /// Which of the files that were opened one after the other it belongs to.
    pub opened: u64,
}

/// What to do with a file that another program has changed since the window read or wrote it.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Changed {
    /// Leave it, and ask the person.
    Ask,
    /// Replace it.
    Replace,
}

/// What a file holds.
#[derive(Clone)]
pub enum Content {
    /// The bent mesh.
    Model(Model),
    /// The document.
    Project(Box<Snapshot>, RestMesh),
    /// The mesh at rest with its bent shape as a morph target.
    Morph(Shape, RestMesh),
    /// An edit for the command line.
    Edit(Box<EditFile>),
    /// A picture of the view.
    Picture(Arc<Image>),
}

/// The bent mesh.
#[derive(Clone)]
pub struct Model {
    /// The mesh as it was read.
    pub mesh: RestMesh,
    /// What it is bent to.
    pub shape: Shape,
    /// Whether the file that is replaced is kept.
    pub keep_original: KeepOriginal,
}

/// A shape of the open mesh.
#[derive(Clone)]
pub struct Shape {
    /// Displacements of the surface from the file's shape.
    pub displacements: Arc<Vec<DVec3>>,
    /// The connected parts that are turned inside out, by their numbers.
    pub inside_out: Arc<BTreeSet<u32>>,
}

/// Whether the file that a save replaces is kept.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum KeepOriginal {
    /// As `NAME.original.EXT`, or with a number behind it, unless one of these has its content already.
    Yes,
    /// Only if it is the mesh as it was read.
    No,
}

/// A file that was written.
pub struct Written {
    /// Where.
    pub path: PathBuf,
    /// What it is.
    pub what: WrittenKind,
    /// What a person should know, a sentence each.
    pub notes: Vec<String>,
    /// The state of the document that it has.
    pub mark: SaveMark,
    /// As [`SaveRequest::opened`].
    pub opened: u64,
}

/// What was written.
#[derive(Clone, PartialEq, Debug)]
pub enum WrittenKind {
    /// The model.
    Model {
        /// Where the mesh as it was read stands now, if that has changed.
        source: Option<MeshSource>,
        /// What the file is moved by, per surface vertex.
        saved: Arc<Vec<DVec3>>,
    },
    /// The project.
    Project,
    /// A picture.
    Picture,
    /// An edit for the command line: the work is not saved with it.
    Edit,
    /// The model at rest with the edit as a morph target, which is a copy beside the open file.
    Morph,
}

/// Why a file was not written; all files are as they were then.
pub enum Unwritten {
    /// Another program has changed this file since the window read or wrote it: the person decides.
    Changed(PathBuf, Box<SaveRequest>),
    /// For this reason.
    Refused(String),
}

impl Content {
    /// The mesh as it was read, of which it is a shape or a project.
    pub(super) fn mesh(&self) -> Option<&RestMesh> {
        match self {
            Self::Model(Model { mesh, .. }) | Self::Project(_, mesh) | Self::Morph(_, mesh) => Some(mesh),
            Self::Edit(_) | Self::Picture(_) => None,
        }
    }

    /// The same, to be changed.
    pub(super) fn mesh_mut(&mut self) -> Option<&mut RestMesh> {
        match self {
            Self::Model(Model { mesh, .. }) | Self::Project(_, mesh) | Self::Morph(_, mesh) => Some(mesh),
            Self::Edit(_) | Self::Picture(_) => None,
        }
    }
}
