//! The work on keys beside the document: the selected and the copied ones, and a stretch of play.

use std::collections::BTreeSet;

use crate::document::{KeyFrame, KeyId, Transaction};

/// The selected keys, the copied ones, and the stretch that plays.
#[derive(Default)]
pub(crate) struct KeyWork {
    pub(super) selected: BTreeSet<KeyId>,
    pub(super) copied: Vec<KeyFrame>,
    pub(super) play: Option<Play>,
}

/// A stretch of play, which becomes one step of the history.
pub(super) struct Play {
    pub(super) step: Transaction,
    /// The executor's time at the beginning.
    pub(super) began_ms: f64,
    /// The executor's time from which the next frame may be shown.
    pub(super) next_ms: f64,
}

impl KeyWork {
    /// The selected keys.
    pub(crate) fn selected(&self) -> &BTreeSet<KeyId> {
        &self.selected
    }

    /// Returns true if keys were copied.
    pub(crate) fn has_copied(&self) -> bool {
        !self.copied.is_empty()
    }

    /// Returns true between play and pause.
    pub(crate) fn is_playing(&self) -> bool {
        self.play.is_some()
    }
}
