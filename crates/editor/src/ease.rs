//! The way from one key of an animation to the next.

use serde::{Deserialize, Serialize};

/// The way from a key to the next.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default, Serialize, Deserialize)]
#[serde(rename_all = "lowercase", expecting = "\"hold\", \"linear\" or \"smooth\"")]
pub enum Ease {
    /// The handle stays until the next key.
    Hold,
    /// At constant speed.
    Linear,
    /// Along a smooth curve through the keys.
    #[default]
    Smooth,
}
