//! Shapes that wait to be posed for the renderer: one runs at a time, and only the newest of the waiting ones is kept.

use std::sync::Arc;

use glam::DVec3;
use pliant_editor::{JobQueue, Revision};

use crate::window::threads::message::Message;
use crate::window::threads::workers::{PoseSource, Workers};
use crate::window::viewport::Viewport;

/// The poses that one view has requested.
#[derive(Default)]
pub struct PoseQueue {
    jobs: JobQueue<Arc<Vec<DVec3>>>,
    last: u64,
}

impl PoseQueue {
    /// Requests the pose of `wanted` if the view shows another shape, or other numbers as colours.
    pub fn follow(&mut self, wanted: &Arc<Vec<DVec3>>, viewport: &Viewport, source: &PoseSource, workers: &Workers) {
        let is_stale = viewport.displacements().is_some_and(|shown| {
            !Arc::ptr_eq(shown, wanted) || (source.field.is_some() && viewport.field() != source.field)
        });
        if is_stale && !self.jobs.is_busy() {
            self.last += 1;
            self.jobs.request(Revision(self.last), Arc::clone(wanted));
        }
        let Some((running, displacements)) = self.jobs.start_next() else {
            return;
        };
        let (stamp, source) = (running.stamp, source.clone());
        workers.spawn(
            "posing",
            move || Message::Posed(stamp, Ok(source.pose(displacements, None))),
            move |sentence| Message::Posed(stamp, Err(sentence)),
        );
    }

    /// A requested pose has come, or failed.
    pub fn finish(&mut self, stamp: Revision) {
        self.jobs.finish(stamp);
    }

    /// The requested pose is no longer wanted.
    pub fn cancel(&mut self) {
        self.jobs.cancel();
    }
}
