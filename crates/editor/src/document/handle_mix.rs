//! Another sequence that leads handles of the open one.

use std::collections::BTreeSet;

use super::handle::HandleId;

/// Another sequence that leads some handles: they go where it has them, and nothing else moves them.
#[derive(Clone, PartialEq, Debug)]
pub struct HandleMix {
    /// Its folder or its point cache, by the caller's name for it: no file is read here.
    pub sequence: String,
    /// The handles that it leads, at least one.
    pub handles: BTreeSet<HandleId>,
    /// The share of their way there, from 0 to 1.
    pub share: f64,
}

impl HandleMix {
    /// The least and the largest share.
    pub const SHARE_RANGE: std::ops::RangeInclusive<f64> = 0.0..=1.0;

    /// The same that leads this handle, too.
    #[must_use]
    pub fn with(&self, handle: HandleId) -> Self {
        let handles = self.handles.iter().copied().chain([handle]);
        Self {
            handles: handles.collect(),
            ..self.clone()
        }
    }

    /// The same that does not lead this handle.
    #[must_use]
    pub fn without(&self, handle: HandleId) -> Self {
        let handles = self.handles.iter().copied().filter(|own| *own != handle);
        Self {
            handles: handles.collect(),
            ..self.clone()
        }
    }

    /// Returns true if it leads this handle.
    pub fn leads(&self, handle: HandleId) -> bool {
        self.handles.contains(&handle)
    }
}
