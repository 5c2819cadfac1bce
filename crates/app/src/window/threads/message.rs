//! Messages from other threads to the window.

use std::path::PathBuf;
use std::sync::Arc;

use glam::DVec3;
use pliant_deform::ExampleShape;
use pliant_editor::{Beginning, FollowedFrame, Following, JobDone, NewMesh, Revision, SavedAs, SnapshotKey};
use pliant_mesh::Cancel;
use pliant_render::{Image, Materials, Surface};

use crate::files::original::Kept;
use crate::window::files::listing::Entry;
use crate::window::files::other_shape::OtherShape;
use crate::window::files::rest_mesh::MeshSource;
use crate::window::files::save_request::{Unwritten, Written};
use pliant_engine::files::Stamp;
use pliant_engine::{Loaded, OpenSequence};
use pliant_picture::drawing::{Drawing, Field, Pose, Scale};

/// A result of another thread; the window takes all waiting ones at the start of each frame.
pub enum Message {
    /// One of the editor's jobs ended; a solved shape comes with its pose.
    Job(JobDone, Option<Posed>),
    /// A shape was prepared for the renderer.
    Posed(Revision, Result<Posed, String>),
    /// A file was uploaded again, for a further view.
    Uploaded(Arc<Drawing>, Result<Surface, String>),
    /// The open file was prepared for drawing with other parts turned inside out, or the reason why not.
    Redrawn(Result<Box<Redrawn>, String>),
    /// The images of a file were decoded and uploaded, or the reason why not.
    LoadedMaterials(ImagesOf, Result<LoadedMaterials, String>),
    /// A file was opened, or the reason why not.
    Opened(Revision, Result<Box<ModelToShow>, String>),
    /// A frame of the open sequence was read: the displacements of its surface vertices from the file's shape, or the
    /// reason why not.
    Frame(Revision, usize, Result<Arc<Vec<DVec3>>, String>),
    /// A frame of the other sequence of this name, which leads handles, was read, or the reason why not.
    MixFrame(Revision, String, usize, Result<Arc<Vec<DVec3>>, String>),
    /// A sequence that can lead handles of the open one was chosen, or the reason why it can't.
    MixChosen(Result<PathBuf, String>),
    /// The open sequence was followed through all frames, or the reason why not.
    Followed(Revision, Following, Result<Vec<FollowedFrame>, String>),
    /// The open file's triangles were changed, or the reason why not.
    Stitched(Revision, Result<Box<Stitched>, Refusal>),
    /// A file was written, or the reason why not.
    Written(Revision, Result<Written, Unwritten>),
    /// The place where the original of the file at this path is or will be kept, or the reason why it is unknown.
    OriginalFound(PathBuf, Result<Kept, String>),
    /// The state of the document with this key was kept for a recovery, or the reason why not.
    Autosaved(SnapshotKey, Result<(), String>),
    /// A cage was read, its vertices and triangles, or the reason why not.
    Cage(Result<(Vec<DVec3>, Vec<[u32; 3]>), String>),
    /// A shape was read for an example of this file, or the reason why not.
    Example(Arc<Loaded>, Result<ExampleShape, String>),
    /// The contents of a folder, or the reason why it can't be read.
    Folder(PathBuf, Result<Vec<Entry>, String>),
    /// Another program shows a file or a page, or the reason why none does.
    Shown(Result<(), String>),
    /// The small pictures of recent files were read.
    RecentPictures(Vec<(PathBuf, Image)>),
    /// A person chose a path in a dialog; `None` if they chose none.
    Chosen(Purpose, Option<PathBuf>),
    /// The system has no dialog to ask for a path; it was to begin at this one.
    NoDialog(Purpose, PathBuf),
}

/// A file in another drawing.
pub struct Redrawn {
    /// The file.
    pub loaded: Arc<Loaded>,
    /// Its new data for the renderer.
    pub drawing: Arc<Drawing>,
    /// Its surface in GPU buffers, in the shape of `displacements`.
    pub surface: Surface,
    /// The shape.
    pub displacements: Arc<Vec<DVec3>>,
}

/// A shape with its pose.
pub struct Posed {
    /// The source of the pose.
    pub drawing: Arc<Drawing>,
    /// The shape, as the editor shares it; compared by its address.
    pub displacements: Arc<Vec<DVec3>>,
    /// The same for the renderer.
    pub pose: Pose,
    /// The shape's numbers as colours, if these are shown.
    pub painted: Option<Painted>,
}

/// Numbers on the surface as colours.
pub struct Painted {
    /// The numbers.
    pub field: Field,
    /// The meaning of the colours.
    pub scale: Arc<Scale>,
    /// Colours of the drawn vertices.
    pub colours: Vec<[u8; 4]>,
}

/// The drawing whose images are decoded, and the flag that stops it.
#[derive(Clone)]
pub struct ImagesOf {
    /// The file's drawing.
    pub drawing: Arc<Drawing>,
    /// Raised when nobody waits for them any longer.
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
    /// Its path; none for the built-in sample.
    pub path: Option<PathBuf>,
    /// The file as stored and its vertex sets.
    pub loaded: Arc<Loaded>,
    /// Its data for the renderer.
    pub drawing: Arc<Drawing>,
    /// Its surface in GPU buffers, in its own shape.
    pub surface: Surface,
    /// Its own shape: no vertex is displaced.
    pub displacements: Arc<Vec<DVec3>>,
    /// The sequence of whose frames it is one, and the frame to show, if a person has chosen it.
    pub sequence: Option<(Arc<OpenSequence>, Option<usize>)>,
    /// Regions and handles to begin with.
    pub beginning: Option<Beginning>,
    /// The project from which it was opened, or to which it will be saved.
    pub project: Option<PathBuf>,
    /// The path of the mesh as it was read; none for the built-in sample.
    pub source: MeshSource,
    /// The recovery file from which it was opened, left by a session that ended without saving.
    pub recovered: Option<PathBuf>,
    /// The file that unsaved work needs; `None` if there is none.
    pub unsaved: Option<SavedAs>,
    /// The files beside the mesh's that were read, as they were then.
    pub stamps: Vec<(PathBuf, Stamp)>,
    /// Notes for a person about the file, a sentence each.
    pub notes: Vec<String>,
    /// What was done while it was opened, for the person to see at once.
    pub done: Option<String>,
}

/// A new shape of the open file, ready to be shown and edited.
pub struct Stitched {
    /// The document on it.
    pub mesh: NewMesh,
    /// The shape.
    pub shape: OtherShape,
    /// Notes for a person, a sentence each: the first says how much was done.
    pub notes: Vec<String>,
    /// A vertex, numbered as in the file, of each border that a note says stays open.
    pub left_open: Vec<u32>,
}

/// A change of the mesh that could not be made.
pub struct Refusal {
    /// The reason, in a sentence.
    pub sentence: String,
    /// The place of the obstacle: a vertex, numbered as in the file.
    pub place: Option<u32>,
}

/// The purpose of choosing a path.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Purpose {
    /// To open a model.
    Open,
    /// To open a sequence: one of its files, or its point cache.
    OpenSequence,
    /// To save the model under.
    SaveAs,
    /// To save the model under, at rest and with the edit as a morph target.
    SaveMorph,
    /// To save the project under.
    SaveProject,
    /// To write the edit file to.
    ExportEdit,
    /// To write the edit over time to.
    ExportAnimation,
    /// To write the frames of a sequence to: a folder, a point cache or an animation.
    ExportFrames,
    /// To write the frames of the flow that was played to: numbered files.
    ExportFlow,
    /// To take an edit from, for the open mesh.
    ApplyEdit,
    /// To put beside the open shape.
    Append,
    /// To take a sequence from that leads handles of the open one: one of its files, or its point cache.
    Mix,
    /// To take a cage from.
    LoadCage,
    /// To take an example from.
    AddExample,
    /// To save a picture of the view under.
    SavePicture(PictureKind),
}

/// The way to save a picture of the view.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct PictureKind {
    /// The number of its pixels along a side for one pixel of the view, at least 1.
    pub scale: u32,
    /// The background behind the surface.
    pub ground: Ground,
}

/// The background behind the surface in a saved picture.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Ground {
    /// The window's.
    AsShown,
    /// Nothing.
    Transparent,
}
