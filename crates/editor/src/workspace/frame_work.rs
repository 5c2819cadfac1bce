//! The frames of a sequence on their way to the document, and the places of handles in those with keys.

use std::collections::BTreeMap;
use std::sync::Arc;

use glam::DVec3;

use super::body_way::BodyWay;
use super::filter_work::FilterWork;
use super::footprint_work::FootprintWork;
use super::handle_ways::HandleWays;
use super::mix_work::MixWork;
use super::skin_frames::SkinFrames;
use crate::document::{HandleId, Version};
use crate::timeline::HandlePlace;

/// The frames on their way to the document.
#[derive(Default)]
pub(crate) struct FrameWork {
    /// The frame that a person wants to see; `None` if it is shown.
    pub(super) wanted: Option<usize>,
    /// True before the first frame is shown, which is no step of the history.
    pub(super) is_beginning: bool,
    /// A frame that was read, and its displacements from the file's shape.
    pub(super) read: Option<(usize, Arc<Vec<DVec3>>)>,
    /// The places of handles in frames with keys.
    pub(super) places: BTreeMap<usize, BTreeMap<HandleId, HandlePlace>>,
    /// The paint to which these belong.
    pub(super) places_of: Option<Version>,
    /// The way of the body through all frames.
    pub(super) way: BodyWay,
    /// The ways of the handles through all frames.
    pub(super) ways: HandleWays,
    /// The shifts of handles by filters.
    pub(super) filters: FilterWork,
    /// The footprints of handles.
    pub(super) footprints: FootprintWork,
    /// The places to which another sequence leads handles.
    pub(super) mix: MixWork,
    /// The frames around the shown one, for the ghosts.
    pub(super) skins: SkinFrames,
    /// True if not all frames could be read.
    pub(super) has_failed: bool,
}

impl FrameWork {
    /// Forgets the wanted frame.
    pub(super) fn stop(&mut self) {
        self.wanted = None;
        self.read = None;
    }

    /// Returns true between the wish for a frame and its arrival.
    pub(super) fn is_awaited(&self) -> bool {
        self.wanted.is_some()
    }
}
