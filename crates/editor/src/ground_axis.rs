//! The axis that points up where a body stands on the ground.

use glam::DVec3;
use serde::{Deserialize, Serialize};

/// An axis that points up.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default, Serialize, Deserialize)]
#[serde(rename_all = "lowercase", expecting = "\"y\" or \"z\"")]
pub enum GroundAxis {
    /// As in glTF and in most scans.
    #[default]
    Y,
    /// As in Blender.
    Z,
}

impl GroundAxis {
    /// Its direction, of length 1.
    pub(crate) fn direction(self) -> DVec3 {
        match self {
            Self::Y => DVec3::Y,
            Self::Z => DVec3::Z,
        }
    }
}
