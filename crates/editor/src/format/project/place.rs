//! The positions of handles in a project's poses and keys.

use std::collections::BTreeMap;

use glam::DVec3;
use serde::{Deserialize, Serialize};

use crate::HandleTransform;
use crate::document::{HandleId, Placed, Stance, followed, means};

/// A handle's transform, and its pivot at that time.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct StoredPlace {
    #[serde(default)]
    transform: HandleTransform,
    /// The counted turn, in degrees about x, y and z.
    #[serde(default)]
    turn_deg: [f64; 3],
    pivot: [f64; 3],
}

impl StoredPlace {
    fn of(placed: &Placed) -> Self {
        Self {
            transform: placed.stance.transform,
            turn_deg: placed.stance.turn_deg.to_array(),
            pivot: placed.pivot.to_array(),
        }
    }

    fn placed(&self) -> Placed {
        let counted = DVec3::from_array(self.turn_deg);
        Placed {
            stance: Stance {
                transform: self.transform,
                // The counted turn must be the rotation, even in a file from another program.
                turn_deg: match self.transform {
                    HandleTransform::Trs { rotation, .. } if !means(counted, rotation) => {
                        followed(DVec3::ZERO, rotation)
                    }
                    _ => counted,
                },
            },
            pivot: DVec3::from_array(self.pivot),
        }
    }
}

/// Positions by the handles' numbers.
pub(super) fn stored_places(handles: &BTreeMap<HandleId, Placed>) -> BTreeMap<u32, StoredPlace> {
    let handles = handles.iter();
    handles
        .map(|(id, placed)| (u32::from(id.0), StoredPlace::of(placed)))
        .collect()
}

/// The same, read. A number that is too large for a handle becomes the largest.
pub(super) fn places(stored: &BTreeMap<u32, StoredPlace>) -> BTreeMap<HandleId, Placed> {
    let stored = stored.iter();
    stored
        .map(|(id, place)| (HandleId(u16::try_from(*id).unwrap_or(u16::MAX)), place.placed()))
        .collect()
}
