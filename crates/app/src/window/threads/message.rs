//! Messages from other threads to the window.

use std::path::PathBuf;
use std::sync::Arc;

use glam::DVec3;
use pliant_deform::ExampleShape;
use pliant_editor::{Beginning, JobDone, Revision, SavedAs, SnapshotKey};
use pliant_mesh::Cancel;
use pliant_render::{Materials, Surface};

use crate::drawing::{Drawing, Field, Pose, Scale};
use crate::window::dialogs::folder_browser::listing::Entry;
use crate::window::files::original::Kept;
use crate::window::files::rest_mesh::MeshSource;
use crate::window::files::save_request::{Unwritten, Written};
use pliant_engine::Loaded;
use pliant_engine::files::Stamp;

/// A result of another thread; the window takes all waiting ones at the start of each frame.
pub enum Message {
    /// One of the editor's jobs ended; a solved shape comes with its pose.
    Job(JobDone, Option<Posed>),
    /// A shape was made ready for the renderer.
    Posed(Revision, Result<Posed, String>),
    /// A file was uploaded once more, for a second view.
    Uploaded(Arc<Drawing>, Result<Surface, String>),
    /// The open file was made ready to be drawn with other parts turned inside out, or why not.
    Redrawn(Result<Box<Redrawn>, String>),
    /// The images of a file were decoded and uploaded, or why not.
    LoadedMaterials(ImagesOf, Result<LoadedMaterials, String>),
    /// A file was opened, or why it was not.
    Opened(Revision, Result<Box<ModelToShow>, String>),
    /// A file was written, or why it was not.
    Written(Revision, Result<Written, Unwritten>),
    /// Where the original of the file at this path is kept or will be, or why that can't be told.
    OriginalFound(PathBuf, Result<Kept, String>),
    /// The state of the document with this key was kept for a recovery, or why it was not.
    Autosaved(SnapshotKey, Result<(), String>),
    /// A cage was read, its vertices and triangles, or why it was not.
    Cage(Result<(Vec<DVec3>, Vec<[u32; 3]>), String>),
    /// A shape was read that is to be an example for this file, or why it was not.
    Example(Arc<Loaded>, Result<ExampleShape, String>),
    /// What is in a folder, or why it can't be read.
    Folder(PathBuf, Result<Vec<Entry>, String>),
    /// A person chose a path in a dialog; `None` if they chose none.
    Chosen(Purpose, Option<PathBuf>),
    /// The system has no dialog to ask for a path, which was to begin at this one.
    NoDialog(Purpose, PathBuf),
}

/// A file in another drawing.
pub struct Redrawn {
    /// The file.
    pub loaded: Arc<Loaded>,
    /// What the renderer takes of it now.
    pub drawing: Arc<Drawing>,
    /// Its surface in GPU buffers, in the shape of `displacements`.
    pub surface: Surface,
    /// The shape.
    pub displacements: Arc<Vec<DVec3>>,
}

/// A shape with its pose.
pub struct Posed {
    /// What it is a pose of.
    pub drawing: Arc<Drawing>,
    /// The shape, as the editor shares it; compared by its address.
    pub displacements: Arc<Vec<DVec3>>,
    /// The same for the renderer.
    pub pose: Pose,
    /// The shape's numbers as colours, where such are shown.
    pub painted: Option<Painted>,
}

/// Numbers on the surface as colours.
pub struct Painted {
    /// What they are.
    pub field: Field,
    /// What the colours mean.
    pub scale: Arc<Scale>,
    /// Colours of the drawn vertices.
    pub colours: Vec<[u8; 4]>,
}

/// Whose images are decoded, and what stops that.
#[derive(Clone)]
pub struct ImagesOf {
    /// The file's drawing.
    pub drawing: Arc<Drawing>,
    /// Raised once nobody waits for them.
    pub cancel: Cancel,
}

/// A file's materials with their images.
pub struct LoadedMaterials {
    /// On the device.
    pub materials: Materials,
    /// Images that can't be shown, a sentence each.
    pub notes: Vec<String>,
}

/// A file that was read, welded and uploaded, ready to be shown and edited.
pub struct ModelToShow {
    /// Where it stands; the built-in sample stands nowhere.
    pub path: Option<PathBuf>,
    /// The file as stored and its vertex sets.
    pub loaded: Arc<Loaded>,
    /// What the renderer takes of it.
    pub drawing: Arc<Drawing>,
    /// Its surface in GPU buffers, in its own shape.
    pub surface: Surface,
    /// Its own shape: no vertex displaced.
    pub displacements: Arc<Vec<DVec3>>,
    /// Regions and handles to begin with.
    pub beginning: Option<Beginning>,
    /// The project that it was opened from, or is to be saved to.
    pub project: Option<PathBuf>,
    /// Where the mesh as it was read stands; the built-in sample stands nowhere.
    pub source: MeshSource,
    /// The recovery file that it was opened from, left by a session that ended without saving.
    pub recovered: Option<PathBuf>,
    /// Which file is needed for the work that no file has; `None` where there is none.
    pub unsaved: Option<SavedAs>,
    /// The files beside the mesh's that were read, as they were then.
    pub stamps: Vec<(PathBuf, Stamp)>,
    /// What a person should know about the file, a sentence each.
    pub notes: Vec<String>,
}

/// What a path is chosen for.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Purpose {
    /// To open a model.
    Open,
    /// To save the model under.
    SaveAs,
    /// To save the model under, at rest and with the edit as a morph target.
    SaveMorph,
    /// To save the project under.
    SaveProject,
    /// To write the edit file to.
    ExportEdit,
    /// To take a cage from.
    LoadCage,
    /// To take an example from.
    AddExample,
    /// To save a picture of the view under.
    SavePicture(PictureKind),
}

/// How a picture of the view is saved.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct PictureKind {
    /// How many of its pixels along a side one pixel of the view becomes, at least 1.
    pub scale: u32,
    /// What is behind the surface.
    pub ground: Ground,
}

/// What is behind the surface in a saved picture.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Ground {
    /// What the window shows.
    AsShown,
    /// Nothing.
    Transparent,
}
