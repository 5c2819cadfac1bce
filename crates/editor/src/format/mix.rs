//! Another sequence whose large motion an edit takes.

use serde::{Deserialize, Serialize};

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
}
