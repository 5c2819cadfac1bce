//! An open sequence, whose frames are read one at a time.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use glam::DVec3;
use pliant_editor::{FollowedFrame, Following, middle_of};
use pliant_io::Format;
use pliant_mesh::Drawn;

use super::bend::followed;
use super::cache::Cache;
use super::folder::Folder;
use super::leading::other_sequence;
use super::morphs::Morphs;
use super::side_by_side::side_by_side;
use super::source::{Source, cache_format};
use crate::EngineError;
use crate::files::is_same;
use crate::loading::Loaded;
use crate::path_text::shown;
use crate::watch::Watch;

/// A sequence on the mesh whose vertices and faces all frames have.
pub struct OpenSequence {
    path: PathBuf,
    mesh: Arc<Loaded>,
    /// The geometry of the mesh.
    rest: Drawn,
    source: Source,
    fps: Option<f64>,
    note: Option<String>,
}

impl OpenSequence {
    /// The file whose vertices and faces all frames of a sequence have: the first frame of a folder, or the glTF itself.
    /// `None` for a point cache, which holds only positions.
    ///
    /// # Errors
    /// A path that is no sequence.
    pub fn mesh_of(path: &Path) -> Result<Option<PathBuf>, EngineError> {
        if cache_format(path).is_some() {
            return Ok(None);
        }
        match is_gltf(path) {
            true => Ok(Some(path.to_owned())),
            false => Ok(Folder::of(path)?.frames.into_iter().next()),
        }
    }

    /// Returns true for a folder, a point cache or a glTF.
    pub fn is_one(path: &Path) -> bool {
        path.is_dir() || cache_format(path).is_some() || is_gltf(path)
    }

    /// A sentence about the sequence that a mesh file may belong to: its own animation of morph targets, or a point cache
    /// with its name beside it. `None` without one.
    pub fn beside(mesh: &Loaded, watch: &Watch) -> Option<String> {
        let caches = ["pc2", "mdd"].map(|ending| mesh.path.with_extension(ending));
        if let Some(cache) = caches.iter().find(|cache| cache.is_file()) {
            return Some(format!(
                "{} may move this mesh: choose Open sequence… to see its frames.",
                shown(cache)
            ));
        }
        let has_targets = is_gltf(&mesh.path) && !mesh.scene.morph_targets().is_empty();
        let file = mesh.path.to_string_lossy();
        let playback = has_targets.then(|| mesh.scene.morph_playback(&file, &watch.cancel));
        let is_animated = playback.is_some_and(|playback| playback.is_ok_and(|playback| playback.is_some()));
        is_animated.then(|| "Its morph targets are animated: choose Open sequence… to see the frames.".to_owned())
    }

    /// The number of the frame that is this file, in a folder of frames.
    pub fn frame_of(&self, file: &Path) -> Option<usize> {
        match &self.source {
            Source::Folder(frames) => frames.iter().position(|frame| is_same(frame, file)),
            Source::Cache(_) | Source::Morphs(_) => None,
        }
    }

    /// Opens a folder of frames, a point cache, or a glTF's animation of morph targets at `fps` frames a second or,
    /// without it, such that every key of the animation is a frame. No frame is read yet.
    ///
    /// # Errors
    /// A path that is no sequence, or one of another mesh.
    pub fn of(path: &Path, mesh: Arc<Loaded>, fps: Option<f64>, watch: &Watch) -> Result<Self, EngineError> {
        let (source, note) = match cache_format(path) {
            Some(format) => (Source::Cache(Cache::of(path, format, &mesh)?), None),
            None if is_gltf(path) => {
                let morphs = Morphs::of(&mesh, fps, watch)?;
                let choice = morphs.choice();
                (Source::Morphs(morphs), choice)
            }
            None => {
                let folder = Folder::of(path)?;
                (Source::Folder(folder.frames), folder.gap)
            }
        };
        if source.count() == 0 {
            return Err(EngineError::Unsupported(format!(
                "{} holds no frame: give another sequence",
                shown(path)
            )));
        }
        Ok(Self {
            path: path.to_owned(),
            rest: mesh.model.rest(),
            mesh,
            source,
            fps,
            note,
        })
    }

    /// Another sequence of the same mesh that can lead handles of this one: a folder or a point cache.
    ///
    /// # Errors
    /// A path that is no such sequence, or one of another mesh or with another number of frames.
    pub fn other(&self, path: &Path) -> Result<Self, EngineError> {
        Ok(Self {
            path: path.to_owned(),
            mesh: Arc::clone(&self.mesh),
            rest: self.rest.clone(),
            source: other_sequence(path, &self.mesh, (&self.path, self.count()))?,
            fps: self.fps,
            note: None,
        })
    }

    /// The folder, the point cache or the glTF.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// The frames a second at which a glTF's animation was to be read; `None` for its own key times.
    pub fn fps(&self) -> Option<f64> {
        self.fps
    }

    /// The frames a second of a glTF's animation, which may have more frames at uneven keys; `None` for other sequences.
    pub fn rate(&self) -> Option<f64> {
        match &self.source {
            Source::Morphs(morphs) => Some(morphs.fps()),
            Source::Folder(_) | Source::Cache(_) => None,
        }
    }

    /// Returns true for a point cache, whose mesh is in another file.
    pub fn is_cache(&self) -> bool {
        matches!(self.source, Source::Cache(_))
    }

    /// The number of frames, at least one.
    pub fn count(&self) -> usize {
        self.source.count()
    }

    /// A sentence for a person: a number that is missing among the frames' names, or the choice among animations.
    pub fn note(&self) -> Option<&str> {
        self.note.as_deref()
    }

    /// Follows the body and some handles through all frames: reads each, and keeps none.
    ///
    /// # Errors
    /// A frame that can't be read, or that has other vertices or faces; [`EngineError::Interrupted`].
    pub fn followed(&self, following: &Following, watch: &Watch) -> Result<Vec<FollowedFrame>, EngineError> {
        let frames: Vec<usize> = (0..self.count()).collect();
        let of_frame = |frame: usize| {
            let positions = self.positions(frame, watch)?;
            let first = &self.mesh.model.surface.positions;
            let handles = following.handles.iter();
            let handles = handles.map(|(_, vertices)| followed(vertices, first, &positions));
            Ok(FollowedFrame {
                middle: middle_of(&positions),
                handles: handles.collect(),
            })
        };
        side_by_side(&frames, of_frame, watch)
    }

    /// The mesh whose vertices and faces all frames have.
    pub(super) fn mesh(&self) -> &Loaded {
        &self.mesh
    }

    /// The surface in a frame.
    ///
    /// # Errors
    /// Those of [`displacements`](Self::displacements).
    pub(super) fn positions(&self, frame: usize, watch: &Watch) -> Result<Vec<DVec3>, EngineError> {
        self.source.positions(frame, (&self.mesh, &self.rest), watch)
    }

    /// Reads a frame below [`count`](Self::count): the displacement of each surface vertex from its place in the mesh's
    /// file.
    ///
    /// # Errors
    /// A frame that can't be read, or that has other vertices or faces.
    pub fn displacements(&self, frame: usize, watch: &Watch) -> Result<Vec<DVec3>, EngineError> {
        let positions = self.positions(frame, watch)?;
        let rest = &self.mesh.model.surface.positions;
        Ok(positions.iter().zip(rest).map(|(own, rest)| *own - *rest).collect())
    }
}

/// Returns true for a file with a glTF's name.
pub(super) fn is_gltf(path: &Path) -> bool {
    let format = Format::of_name(&path.to_string_lossy());
    matches!(format, Ok(Format::Glb | Format::Gltf)) && path.is_file()
}
