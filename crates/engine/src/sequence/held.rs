//! A handle that footprints hold.

use pliant_editor::Footprints;

/// A handle, by its number, and its footprints.
pub(super) struct Held {
    pub handle: usize,
    pub footprints: Footprints,
}
