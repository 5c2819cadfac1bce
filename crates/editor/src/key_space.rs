//! The axes of a key in a sequence.

use serde::{Deserialize, Serialize};

/// The axes in which a key's transform stays the same from frame to frame. Its pivot always rides along with the handle.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Hash, Default, Serialize, Deserialize)]
#[serde(rename_all = "lowercase", expecting = "\"local\" or \"world\"")]
pub enum KeySpace {
    /// Those of the handle, which turn with it.
    #[default]
    Local,
    /// Those of the world.
    World,
}
