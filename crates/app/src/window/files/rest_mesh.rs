//! The open mesh as it was read, to which projects belong, and its present file.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use pliant_assets::CREATURE;
use pliant_engine::files::{KnownFiles, Stamp, is_same};
use pliant_engine::watch::Watch;
use pliant_engine::{EngineError, Loaded, OpenSequence};
use pliant_mesh::WeldOptions;

use crate::files::names::SAMPLE_NAME;

/// The present place of a mesh as it was read.
#[derive(Clone, PartialEq, Eq, Debug)]
pub enum MeshSource {
    /// It is built in.
    Sample,
    /// In this file.
    File(PathBuf),
    /// Nowhere: a save replaced it, and it must be written again if it is needed.
    Gone,
}

/// Reads and welds the built-in sample.
pub(in crate::window) fn load_sample(weld: &WeldOptions, watch: &Watch) -> Result<Loaded, EngineError> {
    pliant_engine::load_bytes(CREATURE.to_vec(), Path::new(SAMPLE_NAME), weld, watch)
}

/// The comparison of a file with its stamp: [`Stamp::is_current`] or [`Stamp::looks_current`].
pub type Check = fn(&Stamp, &Path) -> bool;

/// The open mesh as it was read. Cloning shares it.
#[derive(Clone, Debug)]
pub struct RestMesh {
    /// The file as stored and its vertex sets.
    pub loaded: Arc<Loaded>,
    /// Its place.
    pub source: MeshSource,
    /// The place of the sequence of whose frames it is one.
    pub sequence: Option<PathBuf>,
    /// True if that is a glTF's animation of which every key is a frame.
    pub has_own_key_times: bool,
    /// The files that contain it, as they were then.
    copies: KnownFiles,
}

impl RestMesh {
    /// A mesh that was just read from its place.
    pub fn new(loaded: Arc<Loaded>, source: MeshSource) -> Self {
        let copies = KnownFiles::default();
        if let Some(stamp) = &loaded.stamp {
            copies.note(&loaded.path, stamp.clone());
        }
        Self {
            loaded,
            source,
            sequence: None,
            has_own_key_times: false,
            copies,
        }
    }

    /// The same, a frame of this sequence.
    #[must_use]
    pub fn of_sequence(self, sequence: Option<&OpenSequence>) -> Self {
        let has_own = |sequence: &OpenSequence| sequence.rate().is_some() && sequence.fps().is_none();
        Self {
            sequence: sequence.map(|sequence| sequence.path().to_owned()),
            has_own_key_times: sequence.is_some_and(has_own),
            ..self
        }
    }

    /// Notes that a file contains it.
    pub fn note_copy(&self, path: &Path, stamp: Stamp) {
        self.copies.note(path, stamp);
    }

    /// Returns true if the file at `path` still contains it, as far as `check` finds out.
    pub fn is_in(&self, path: &Path, check: Check) -> bool {
        let is_read_file = is_same(path, &self.loaded.path);
        let mut neighbours = self.loaded.neighbours.iter().filter(|_| is_read_file);
        let copy = self.copies.stamp(path);
        copy.is_some_and(|stamp| check(&stamp, path)) && neighbours.all(|(path, stamp)| check(stamp, path))
    }
}
