//! The frames of a sequence whose ghosts are shown around the present one, on their way from the files.

use std::collections::BTreeMap;
use std::sync::Arc;

use glam::DVec3;

use crate::document::{HandleId, Version};
use crate::timeline::HandlePlace;

/// The frames of ghosts. Those that are no longer wanted are dropped.
#[derive(Default)]
pub(crate) struct SkinFrames {
    /// The wanted frames; `None` is one that can't be read, which has no ghost.
    wanted: BTreeMap<usize, Option<SkinFrame>>,
    /// The frame that must be read next, and the wanted one for which it is.
    asked: Option<(usize, usize)>,
    /// The wanted frame that needs its places in another sequence first.
    asked_of_mix: Option<usize>,
}

/// A frame that was read.
#[derive(Clone)]
pub(super) struct SkinFrame {
    /// The displacements from the file's shape.
    pub(super) shape: Arc<Vec<DVec3>>,
    /// The places of the handles in it, which this paint makes.
    pub(super) places: Arc<BTreeMap<HandleId, HandlePlace>>,
    pub(super) paint: Version,
}

impl SkinFrames {
    /// Wants these frames and no others.
    pub(super) fn want(&mut self, frames: &[(i8, usize)]) {
        self.wanted
            .retain(|known, _| frames.iter().any(|(_, frame)| frame == known));
        (self.asked, self.asked_of_mix) = (None, None);
    }

    /// The frames that are known or asked for.
    pub(super) fn frames(&self) -> impl Iterator<Item = usize> {
        let asked = self.asked.map(|(_, wanted)| wanted);
        self.wanted.keys().copied().chain(asked)
    }

    /// A wanted frame; the inner `None` is one that can't be read.
    pub(super) fn get(&self, frame: usize, paint: Version) -> Option<Option<&SkinFrame>> {
        let known = self.wanted.get(&frame)?.as_ref();
        known.is_none_or(|known| known.paint == paint).then_some(known)
    }

    /// Asks for a frame that a wanted one needs, which may be that one itself.
    pub(super) fn ask(&mut self, frame: usize, wanted: usize) {
        self.asked = Some((frame, wanted));
    }

    /// Asks for the places in another sequence that a wanted frame needs.
    pub(super) fn ask_mix(&mut self, wanted: usize) {
        self.asked_of_mix = Some(wanted);
    }

    /// The frame that must be read next.
    pub(super) fn asked(&self) -> Option<usize> {
        self.asked.map(|(frame, _)| frame)
    }

    /// The frame of another sequence that must be read next.
    pub(super) fn asked_of_mix(&self) -> Option<usize> {
        self.asked_of_mix
    }

    /// Takes the frame that was asked for.
    pub(super) fn take(&mut self, frame: usize, read: SkinFrame) {
        if let Some((_, wanted)) = self.asked.take_if(|(asked, _)| *asked == frame)
            && wanted == frame
        {
            self.wanted.insert(frame, Some(read));
        }
    }

    /// Notes that the frame that was asked for can't be read.
    pub(super) fn fail(&mut self, frame: usize) {
        if let Some((_, wanted)) = self.asked.take_if(|(asked, _)| *asked == frame) {
            self.wanted.insert(wanted, None);
        }
    }
}
