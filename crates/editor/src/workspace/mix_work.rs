//! The places to which another sequence leads handles, in the frames of it that were read.

use std::collections::BTreeMap;

use crate::document::{HandleId, HandleMix, Version};
use crate::timeline::HandlePlace;

/// The places of handles in another sequence.
#[derive(Debug, Default)]
pub(crate) struct MixWork {
    /// By frame.
    places: BTreeMap<usize, BTreeMap<HandleId, HandlePlace>>,
    /// The paint that makes the handles, and the sequence.
    of: Option<(Version, String)>,
    /// True if a frame of it could not be read: the handles keep their own ways until another one is chosen.
    has_failed: bool,
}

impl MixWork {
    /// Returns true if the places in a frame must be read first.
    pub(super) fn awaits(&self, frame: usize, paint: Version, mix: &HandleMix) -> bool {
        let is_known = self.is_of(paint, mix) && self.places.contains_key(&frame);
        !(self.has_failed || is_known)
    }

    /// Takes the places of all handles in a frame.
    pub(super) fn take(
        &mut self,
        frame: usize,
        places: BTreeMap<HandleId, HandlePlace>,
        (paint, mix): (Version, &HandleMix),
    ) {
        if !self.is_of(paint, mix) {
            self.places.clear();
            self.of = Some((paint, mix.sequence.clone()));
        }
        self.places.insert(frame, places);
    }

    /// Notes that a frame can't be read.
    pub(super) fn fail(&mut self) {
        self.has_failed = true;
    }

    /// Reads frames again.
    pub(super) fn try_again(&mut self) {
        self.has_failed = false;
    }

    /// The place to which a handle is led in a frame.
    pub(super) fn place(
        &self,
        handle: HandleId,
        frame: usize,
        (paint, mix): (Version, &HandleMix),
    ) -> Option<&HandlePlace> {
        let is_led = self.is_of(paint, mix) && mix.leads(handle);
        self.places.get(&frame).filter(|_| is_led)?.get(&handle)
    }

    fn is_of(&self, paint: Version, mix: &HandleMix) -> bool {
        let of = self.of.as_ref();
        of.is_some_and(|(own, sequence)| *own == paint && *sequence == mix.sequence)
    }
}
