//! The frames of the open sequence: read one at a time, off the window's thread.

use std::collections::VecDeque;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use glam::DVec3;
use pliant_editor::{JobQueue, Revision};
use pliant_engine::watch::Watch;
use pliant_engine::{EngineError, OpenSequence};

use crate::window::threads::message::Message;
use crate::window::threads::workers::Workers;

/// The bytes of frames that are kept, beside the last one, so that they need not be read again.
const KEPT_BYTES: usize = 64 << 20;

/// The displacements of a frame's surface vertices from the file's shape.
pub type Shape = Arc<Vec<DVec3>>;

/// The frames that are being read and those that were read last.
#[derive(Default)]
pub struct FrameReads {
    reading: JobQueue<usize>,
    kept: VecDeque<(usize, Shape)>,
    last: u64,
}

impl FrameReads {
    /// The frame's shape if it is known. If not, it is read once the running read has ended, and comes as a message.
    pub fn request(
        &mut self,
        frame: usize,
        read: impl FnOnce(&Watch) -> Result<Vec<DVec3>, EngineError> + Send + 'static,
        message: impl Fn(Revision, Result<Shape, String>) -> Message + Clone + Send + 'static,
        workers: &Workers,
    ) -> Option<Shape> {
        if let Some((_, shape)) = self.kept.iter().find(|(kept, _)| *kept == frame) {
            return Some(Arc::clone(shape));
        }
        if self.reading.is_busy() {
            return None;
        }
        self.last += 1;
        self.reading.request(Revision(self.last), frame);
        let (running, _) = self.reading.start_next()?;
        let (stamp, failed) = (running.stamp, message.clone());
        workers.spawn(
            "frame",
            move || {
                let shape = read(&Watch::cancelled_by(&running.cancel));
                message(stamp, shape.map(Arc::new).map_err(|error| error.to_string()))
            },
            move |sentence| failed(stamp, Err(sentence)),
        );
        None
    }

    /// Takes a frame that was read. Returns it if it belongs to the open sequence.
    pub fn take(
        &mut self,
        stamp: Revision,
        frame: usize,
        shape: Result<Shape, String>,
    ) -> Option<Result<Shape, String>> {
        let running = self.reading.finish(stamp)?;
        if running.cancel.is_cancelled() {
            return None;
        }
        if let Ok(shape) = &shape {
            let bytes = shape.len() * size_of::<DVec3>();
            self.kept.push_back((frame, Arc::clone(shape)));
            while self.kept.len() > 1 && self.kept.len() * bytes > KEPT_BYTES {
                self.kept.pop_front();
            }
        }
        Some(shape)
    }

    /// Another file is open.
    pub fn forget(&mut self) {
        self.reading.cancel();
        self.kept.clear();
    }
}

/// The file of a sequence's mesh: that of the sequence itself, or for a point cache the mesh of the same name beside it,
/// or else `open`, the mesh that is open.
pub(super) fn mesh_of(sequence: &Path, open: Option<&Path>) -> Result<PathBuf, EngineError> {
    if let Some(mesh) = OpenSequence::mesh_of(sequence)? {
        return Ok(mesh);
    }
    let beside = pliant_io::Format::EXTENSIONS
        .iter()
        .map(|ending| sequence.with_extension(ending));
    let mut meshes = beside.chain(open.map(Path::to_owned));
    meshes.find(|mesh| mesh.is_file()).ok_or_else(|| {
        EngineError::Unsupported(format!(
            "{} holds only positions: open the mesh that it was made of first, then the cache",
            pliant_engine::files::shown(sequence)
        ))
    })
}

/// The sequence that a person means by a file: a folder of frames, a point cache or a glTF itself, and the folder of
/// any other mesh.
pub fn meant_by(file: &Path) -> PathBuf {
    match OpenSequence::is_one(file) {
        true => file.to_owned(),
        false => pliant_engine::files::folder_of(file).to_owned(),
    }
}
