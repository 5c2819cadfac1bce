//! The way of a sequence's body: its middle in every frame, and where its bent path carries it.

use std::sync::Arc;

use glam::DVec3;
use pliant_mesh::Model;

use crate::document::BodyPath;
use crate::timeline::{BodyMotion, FollowedFrame, body_motions};

/// The body followed through all frames, once they were read.
#[derive(Debug, Default)]
pub(crate) struct BodyWay {
    /// Its middle in each frame, in world space.
    middles: Option<Vec<DVec3>>,
    /// Its motion in each frame by the path `of`.
    motions: Vec<BodyMotion>,
    of: Option<Arc<BodyPath>>,
    /// The lowest coordinates of the file's surface.
    lowest: DVec3,
}

impl BodyWay {
    /// Returns true if all frames must be read before anything is known.
    pub(super) fn is_unknown(&self) -> bool {
        self.middles.is_none()
    }

    /// Takes all frames that were read.
    pub(super) fn take(&mut self, frames: &[FollowedFrame], model: &Model) {
        let positions = model.surface.positions.iter();
        self.lowest = positions.fold(DVec3::INFINITY, |lowest, place| lowest.min(*place));
        self.middles = Some(frames.iter().map(|frame| frame.middle).collect());
        (self.motions, self.of) = (Vec::new(), None);
    }

    /// Follows the document's path.
    pub(super) fn follow(&mut self, path: Option<&Arc<BodyPath>>) {
        let Some(middles) = &self.middles else { return };
        let is_same = match (&self.of, path) {
            (Some(of), Some(path)) => Arc::ptr_eq(of, path),
            (of, path) => of.is_none() && path.is_none(),
        };
        if is_same {
            return;
        }
        self.motions = match path {
            None => Vec::new(),
            Some(path) => {
                let shifts: Vec<(usize, DVec3)> = path.shifts().collect();
                body_motions(middles, &shifts, path.up().direction())
            }
        };
        self.of = path.cloned();
    }

    /// The body's middle in each frame by its own way; `None` until all frames were read.
    pub(crate) fn own(&self) -> Option<&[DVec3]> {
        self.middles.as_deref()
    }

    /// Its motions along the bent path in all frames; none by its own way.
    pub(super) fn motions(&self) -> &[BodyMotion] {
        &self.motions
    }

    /// Its motion along the bent path in a frame; `None` until all frames were read.
    pub(crate) fn motion(&self, frame: usize) -> Option<BodyMotion> {
        self.middles.as_ref()?;
        Some(self.motions.get(frame).copied().unwrap_or(BodyMotion::STILL))
    }

    /// Its middle in a frame on the bent path.
    pub(crate) fn bent(&self, frame: usize) -> Option<DVec3> {
        Some(self.motion(frame)?.moved(*self.own()?.get(frame)?))
    }

    /// Returns true if the path is not the body's own.
    pub(crate) fn is_bent(&self) -> bool {
        self.motions.iter().any(BodyMotion::moves)
    }

    /// A point at the height of the file's lowest one along an axis of length 1.
    pub(crate) fn on_ground(&self, point: DVec3, up: DVec3) -> DVec3 {
        point + up * (self.lowest.dot(up) - point.dot(up))
    }
}
