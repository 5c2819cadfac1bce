//! The other sequence that leads handles of the open one: its frames, read one at a time, off the window's thread.

use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};

use pliant_editor::Revision;
use pliant_engine::watch::Watch;
use pliant_engine::{EngineError, OpenSequence, files};

use super::frames::{FrameReads, Shape};
use super::opening::absolute;
use crate::window::threads::message::Message;
use crate::window::threads::workers::Workers;

/// The other sequence, once it was opened.
type Opened = Arc<Mutex<Option<Arc<OpenSequence>>>>;

/// The frames of the other sequence.
#[derive(Default)]
pub struct MixReads {
    /// Its name in the document.
    name: String,
    opened: Opened,
    reads: FrameReads,
}

impl MixReads {
    /// The frame's shape if it is known. If not, it is read once the running read has ended. `sequence` is the open one.
    pub fn request(
        &mut self,
        name: &str,
        frame: usize,
        sequence: &Arc<OpenSequence>,
        workers: &Workers,
    ) -> Option<Shape> {
        if self.name != name {
            self.forget();
            name.clone_into(&mut self.name);
        }
        let (opened, sequence) = (Arc::clone(&self.opened), Arc::clone(sequence));
        let path = PathBuf::from(name);
        let read = move |watch: &Watch| other(&opened, &path, &sequence)?.displacements(frame, watch);
        let name = name.to_owned();
        let message = move |stamp, shape| Message::MixFrame(stamp, name.clone(), frame, shape);
        self.reads.request(frame, read, message, workers)
    }

    /// Takes a frame that was read. Returns it if it is still wanted.
    pub fn take(
        &mut self,
        stamp: Revision,
        frame: usize,
        shape: Result<Shape, String>,
    ) -> Option<Result<Shape, String>> {
        self.reads.take(stamp, frame, shape)
    }

    /// Another file is open, or another sequence leads.
    pub fn forget(&mut self) {
        self.reads.forget();
        self.opened = Opened::default();
        self.name.clear();
    }
}

/// The other sequence, opened if it was not.
fn other(opened: &Opened, path: &Path, sequence: &OpenSequence) -> Result<Arc<OpenSequence>, EngineError> {
    let mut opened = opened.lock().unwrap_or_else(PoisonError::into_inner);
    if let Some(other) = &*opened {
        return Ok(Arc::clone(other));
    }
    let other = Arc::new(sequence.other(path)?);
    *opened = Some(Arc::clone(&other));
    Ok(other)
}

/// Checks off the window's thread that the sequence that a person means by a file can lead handles of the open one, by one
/// of its frames.
pub fn check(file: &Path, frame: usize, sequence: &Arc<OpenSequence>, workers: &Workers) {
    let (file, sequence) = (file.to_owned(), Arc::clone(sequence));
    let read = move || {
        let path = absolute(&leading_meant_by(&file));
        let other = sequence.other(&path)?;
        other.displacements(frame, &Watch::default())?;
        Ok(path)
    };
    workers.spawn(
        "mix",
        move || Message::MixChosen(read().map_err(|error: EngineError| error.to_string())),
        |sentence| Message::MixChosen(Err(sentence)),
    );
}

/// The sequence that a person means by a file: a point cache itself, and the folder of any other file.
fn leading_meant_by(file: &Path) -> PathBuf {
    match file.is_dir() || pliant_io::PointCacheFormat::of_name(&file.to_string_lossy()).is_some() {
        true => file.to_owned(),
        false => files::folder_of(file).to_owned(),
    }
}
