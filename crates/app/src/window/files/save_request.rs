//! The request of a save, and its result.

use std::collections::BTreeSet;
use std::path::PathBuf;
use std::sync::Arc;

use glam::DVec3;
use pliant_editor::{Dye, EditFile, FlowRecording, SaveMark, Snapshot};
use pliant_mesh::Model as Mesh;
use pliant_render::Image;

use super::in_file::SavedShape;
use super::rest_mesh::{MeshSource, RestMesh};
use pliant_engine::files::KnownFiles;
use pliant_engine::watch::Watch;
use pliant_engine::{ExistingFrames, Loaded};

/// The request.
#[derive(Clone)]
pub struct SaveRequest {
    /// The path.
    pub path: PathBuf,
    /// The content.
    pub content: Content,
    /// The files of the open model, which nothing else may replace.
    pub sources: Vec<PathBuf>,
    /// The files that the window has read or written, as they were then.
    pub known: KnownFiles,
    /// The action if one of the files to be replaced has changed.
    pub changed: Changed,
    /// The state of the document that is written.
    pub mark: SaveMark,
    /// The number of the opened file that it belongs to.
    pub opened: u64,
}

/// The action for a file that another program has changed since the window read or wrote it.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Changed {
    /// Do not replace it, and ask the person.
    Ask,
    /// Replace it.
    Replace,
}

/// The content of a file.
#[derive(Clone)]
pub enum Content {
    /// The bent mesh.
    Model(Model),
    /// The document.
    Project(Box<Snapshot>, RestMesh),
    /// The mesh at rest with its bent shape as a morph target.
    Morph(Shape, RestMesh),
    /// An edit for the command line, and the model whose vertex numbers it has.
    Edit(Box<EditFile>, Arc<Mesh>),
    /// The edit over time.
    Animation(Box<AnimationToWrite>),
    /// The frames of a sequence.
    Frames(Box<FramesToWrite>),
    /// The frames of a flow.
    Flow(Box<FlowToWrite>),
    /// A picture of the view.
    Picture(Arc<Image>),
}

/// The edit over time.
#[derive(Clone)]
pub struct AnimationToWrite {
    /// The edit with its keys.
    pub edit: EditFile,
    /// The frames a second.
    pub fps: f64,
    /// Whether numbered files may replace others.
    pub frames: ExistingFrames,
    /// The mesh as it was read.
    pub mesh: RestMesh,
    /// The dye that was kept as vertex colours, for each surface vertex.
    pub dye: Option<Arc<Vec<Dye>>>,
    /// The stage of the work.
    pub watch: Watch,
}

/// The frames of a sequence with the edit.
#[derive(Clone)]
pub struct FramesToWrite {
    /// The edit with its keys.
    pub edit: EditFile,
    /// The folder of frames, the point cache or the glTF.
    pub sequence: PathBuf,
    /// The mesh of a point cache.
    pub cached_mesh: Option<PathBuf>,
    /// The frames a second of a glTF; `None` for its own key times.
    pub fps: Option<f64>,
    /// Whether numbered files may replace others.
    pub existing: ExistingFrames,
    /// The stage of the work.
    pub watch: Watch,
}

/// The frames of the flow that was played, on the present shape.
#[derive(Clone)]
pub struct FlowToWrite {
    /// The flow.
    pub recording: FlowRecording,
    /// The shape in all frames.
    pub shape: Shape,
    /// The mesh as it was read.
    pub mesh: RestMesh,
    /// The frames a second.
    pub fps: f64,
    /// Whether numbered files may replace others.
    pub frames: ExistingFrames,
    /// The stage of the work.
    pub watch: Watch,
}

/// The bent mesh.
#[derive(Clone)]
pub struct Model {
    /// The mesh as it was read.
    pub mesh: RestMesh,
    /// The bent shape.
    pub shape: Shape,
    /// The fate of the replaced file.
    pub keep_original: KeepOriginal,
}

/// A shape of the open mesh.
#[derive(Clone)]
pub struct Shape {
    /// Displacements of the surface from the file's shape.
    pub displacements: Arc<Vec<DVec3>>,
    /// The connected parts that are turned inside out, by their numbers.
    pub inside_out: Arc<BTreeSet<u32>>,
    /// The dye that was kept as vertex colours, for each surface vertex.
    pub dye: Option<Arc<Vec<Dye>>>,
}

/// The fate of the file that a save replaces.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum KeepOriginal {
    /// As `NAME.original.EXT`, or with a number after it, unless one of these already has its content.
    Yes,
    /// Only if it is the mesh as it was read.
    No,
}

/// A file that was written.
pub struct Written {
    /// The path.
    pub path: PathBuf,
    /// The content.
    pub what: WrittenKind,
    /// Notes for the person, a sentence each.
    pub notes: Vec<String>,
    /// The state of the document in it.
    pub mark: SaveMark,
    /// As [`SaveRequest::opened`].
    pub opened: u64,
}

/// The written content.
#[derive(Clone, Debug)]
pub enum WrittenKind {
    /// The model.
    Model {
        /// The file as it was read, whose displacements these are.
        of: Arc<Loaded>,
        /// The new place of the mesh as it was read, if that has changed.
        source: Option<MeshSource>,
        /// The shape in the file.
        saved: SavedShape,
    },
    /// The project.
    Project,
    /// A picture.
    Picture,
    /// An edit for the command line; it does not count as saving the work.
    Edit,
    /// The model at rest with the edit as a morph target, which is a copy beside the open file.
    Morph,
    /// The model over time, or its flow, which are copies beside the open file.
    Animation,
    /// The frames of the open sequence, beside it.
    Frames,
}

/// The reason why a file was not written; all files are unchanged.
pub enum Unwritten {
    /// Another program has changed this file since the window read or wrote it: the person decides.
    Changed(PathBuf, Box<SaveRequest>),
    /// The animation's numbered files would replace others: the person decides.
    FramesExist {
        /// The first of them.
        first: PathBuf,
        /// Their number.
        count: usize,
        /// The save.
        request: Box<SaveRequest>,
    },
    /// Another reason.
    Refused(String),
}

impl Content {
    /// The mesh as it was read, to which the shape or project belongs.
    pub(super) fn mesh(&self) -> Option<&RestMesh> {
        match self {
            Self::Model(Model { mesh, .. }) | Self::Project(_, mesh) | Self::Morph(_, mesh) => Some(mesh),
            Self::Animation(animation) => Some(&animation.mesh),
            Self::Flow(flow) => Some(&flow.mesh),
            Self::Frames(_) | Self::Edit(..) | Self::Picture(_) => None,
        }
    }

    /// The same, for changes.
    pub(in crate::window) fn mesh_mut(&mut self) -> Option<&mut RestMesh> {
        match self {
            Self::Model(Model { mesh, .. }) | Self::Project(_, mesh) | Self::Morph(_, mesh) => Some(mesh),
            Self::Animation(animation) => Some(&mut animation.mesh),
            Self::Flow(flow) => Some(&mut flow.mesh),
            Self::Frames(_) | Self::Edit(..) | Self::Picture(_) => None,
        }
    }

    /// The stages of the work, if it has several.
    pub(in crate::window) fn watch(&self) -> Option<&Watch> {
        match self {
            Self::Animation(animation) => Some(&animation.watch),
            Self::Frames(frames) => Some(&frames.watch),
            Self::Flow(flow) => Some(&flow.watch),
            _ => None,
        }
    }

    /// From now on numbered files may replace others.
    pub(in crate::window) fn replace_frames(&mut self) {
        match self {
            Self::Animation(animation) => animation.frames = ExistingFrames::Replace,
            Self::Frames(frames) => frames.existing = ExistingFrames::Replace,
            Self::Flow(flow) => flow.frames = ExistingFrames::Replace,
            _ => {}
        }
    }
}
