//! The frames of a sequence, wherever they are stored.

use std::path::{Path, PathBuf};

use glam::DVec3;
use pliant_io::PointCacheFormat;
use pliant_mesh::Drawn;

use super::cache::Cache;
use super::folder::Folder;
use super::frame::Frame;
use super::morphs::Morphs;
use crate::EngineError;
use crate::loading::Loaded;
use crate::watch::Watch;

/// The frames of a sequence.
pub(super) enum Source {
    /// A file for each.
    Folder(Vec<PathBuf>),
    /// A point cache.
    Cache(Cache),
    /// The mesh's own animation of morph targets.
    Morphs(Morphs),
}

impl Source {
    /// The frames of a folder or of a point cache of the mesh `first`.
    ///
    /// # Errors
    /// Those of [`Folder::of`] and [`Cache::of`].
    pub fn of(path: &Path, first: &Loaded) -> Result<Self, EngineError> {
        match cache_format(path) {
            Some(format) => Ok(Self::Cache(Cache::of(path, format, first)?)),
            None => Ok(Self::Folder(Folder::of(path)?.frames)),
        }
    }

    /// The number of frames.
    pub fn count(&self) -> usize {
        match self {
            Self::Folder(frames) => frames.len(),
            Self::Cache(cache) => cache.count(),
            Self::Morphs(morphs) => morphs.count(),
        }
    }

    /// The surface in a frame. `first` is the file whose vertices and faces all frames have, and `rest` its geometry.
    ///
    /// # Errors
    /// A frame that can't be read, or that has other vertices or faces.
    pub fn positions(
        &self,
        frame: usize,
        (first, rest): (&Loaded, &Drawn),
        watch: &Watch,
    ) -> Result<Vec<DVec3>, EngineError> {
        match self {
            Self::Folder(frames) => Ok(Frame::read(&frames[frame], first, rest, watch)?.positions),
            Self::Cache(cache) => Ok(cache.frame(frame)?.positions),
            Self::Morphs(morphs) => morphs.positions(first, &morphs.displacements(frame, rest.positions.len())),
        }
    }
}

/// The format of a point cache by its name; `None` for a folder.
pub(super) fn cache_format(path: &Path) -> Option<PointCacheFormat> {
    PointCacheFormat::of_name(&path.to_string_lossy()).filter(|_| !path.is_dir())
}
