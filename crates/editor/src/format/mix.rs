//! Another sequence whose large motion an edit takes.

use std::collections::BTreeSet;

use serde::{Deserialize, Serialize};

use super::edit_error::EditError;
use crate::document::{HandleId, HandleMix};

/// The sequence that leads the handles. The rest of the surface keeps its own motion and its details.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MixEntry {
    /// Its folder or its point cache, relative to the edit's folder. It has as many frames as the edited one, with the
    /// same vertices and faces.
    pub sequence: String,
    /// The names of the handles that it leads; without names, all of them.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub handles: Vec<String>,
    /// The share of their way there, from 0 to 1.
    #[serde(default = "all_of_it", skip_serializing_if = "is_all_of_it")]
    pub share: f64,
}

fn all_of_it() -> f64 {
    1.0
}

fn is_all_of_it(share: &f64) -> bool {
    *share == all_of_it()
}

impl MixEntry {
    /// The mix of a document whose handles have these names.
    pub(super) fn of(mix: &HandleMix, name: impl Fn(HandleId) -> Option<String>) -> Option<Self> {
        let handles: Vec<String> = mix.handles.iter().filter_map(|id| name(*id)).collect();
        // Without names it would lead all handles.
        (!handles.is_empty()).then(|| Self {
            sequence: mix.sequence.clone(),
            handles,
            share: mix.share,
        })
    }

    /// The same for a document, with these handles.
    pub(super) fn mix(&self, handles: BTreeSet<HandleId>) -> HandleMix {
        HandleMix {
            sequence: self.sequence.clone(),
            handles,
            share: self.share,
        }
    }

    /// Refuses a share out of range.
    ///
    /// # Errors
    /// [`EditError::OutOfRange`].
    pub(super) fn check(&self) -> Result<(), EditError> {
        match HandleMix::SHARE_RANGE.contains(&self.share) {
            true => Ok(()),
            false => Err(EditError::OutOfRange {
                place: "mix.share".to_owned(),
                found: self.share.to_string(),
                allowed: "a number from 0 to 1".to_owned(),
            }),
        }
    }
}
