//! The body of the open sequence, followed through all frames off the window's thread.

use std::sync::Arc;

use pliant_editor::{FollowedFrame, Following, JobQueue, Revision};
use pliant_engine::OpenSequence;
use pliant_engine::watch::Watch;

use crate::window::threads::message::Message;
use crate::window::threads::workers::Workers;

/// The sentence about a search that a person has stopped.
const STOPPED: &str = "Not all frames were read, so the path is not known: show it again to read them.";

/// All frames are read, one group after the other.
#[derive(Default)]
pub struct FrameSearch {
    reading: JobQueue<Following>,
    watch: Watch,
    last: u64,
    /// True if the running search is of a sequence that is no longer open.
    is_forgotten: bool,
}

impl FrameSearch {
    /// Reads all frames, and follows these handles.
    pub fn request(&mut self, following: Following, sequence: &Arc<OpenSequence>, workers: &Workers) {
        self.last += 1;
        self.reading.request(Revision(self.last), following);
        // A search that was stopped ends first.
        let Some((running, following)) = self.reading.start_next() else {
            return;
        };
        self.is_forgotten = false;
        let (stamp, watch) = (running.stamp, Watch::cancelled_by(&running.cancel));
        self.watch = watch.clone();
        let (sequence, failed) = (Arc::clone(sequence), following.clone());
        workers.spawn(
            "following",
            move || {
                let frames = sequence.followed(&following, &watch).map_err(|error| error.to_string());
                Message::Followed(stamp, following, frames)
            },
            move |sentence| Message::Followed(stamp, failed.clone(), Err(sentence)),
        );
    }

    /// Takes the end of a search. Returns its result if it is of the open sequence.
    pub fn take(
        &mut self,
        stamp: Revision,
        frames: Result<Vec<FollowedFrame>, String>,
    ) -> Option<Result<Vec<FollowedFrame>, String>> {
        let running = self.reading.finish(stamp)?;
        let is_stopped = running.cancel.is_cancelled();
        let frames = if is_stopped { Err(STOPPED.to_owned()) } else { frames };
        (!self.is_forgotten).then_some(frames)
    }

    /// Stops the search.
    pub fn stop(&mut self) {
        self.reading.cancel();
    }

    /// Another file is open.
    pub fn forget(&mut self) {
        self.reading.cancel();
        self.is_forgotten = true;
    }

    /// The running search, with its progress (0 to 1).
    pub fn doing(&self) -> Option<(&'static str, f32)> {
        self.reading.running()?;
        Some(self.watch.now().unwrap_or(("following the frames", 0.0)))
    }
}
