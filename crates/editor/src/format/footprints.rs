//! Footprints of an edit: parts that rest on the ground for some frames.

use serde::{Deserialize, Serialize};

use super::edit_error::EditError;
use crate::document::HandleFootprints;
use crate::ground_axis::GroundAxis;

/// A handle that is held wherever it rests on the ground.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FootprintEntry {
    /// The handle's name.
    pub handle: String,
    /// The axis that points up.
    #[serde(default)]
    pub up: GroundAxis,
    /// The handle is on the ground if its lowest vertex is within this height above the lowest one of all frames, in
    /// world units.
    pub height: f64,
    /// It rests if its middle moves by at most this distance from one frame to the next, in world units.
    pub speed: f64,
    /// The number of frames before and after a footprint over which the handle goes over to its own way.
    #[serde(default = "usual_fade")]
    pub fade: u32,
}

impl FootprintEntry {
    /// The footprints of a document's handle with this name.
    pub(super) fn of(handle: &str, footprints: &HandleFootprints) -> Self {
        let HandleFootprints {
            up,
            height,
            speed,
            fade,
        } = *footprints;
        Self {
            handle: handle.to_owned(),
            up,
            height,
            speed,
            fade,
        }
    }

    /// Its conditions.
    pub fn footprints(&self) -> HandleFootprints {
        HandleFootprints {
            up: self.up,
            height: self.height,
            speed: self.speed,
            fade: self.fade,
        }
    }
}

fn usual_fade() -> u32 {
    4
}

/// Refuses distances that are not above 0.
pub(super) fn check_footprints(footprints: &[FootprintEntry]) -> Result<(), EditError> {
    for (place, footprint) in footprints.iter().enumerate() {
        for (member, value) in [("height", footprint.height), ("speed", footprint.speed)] {
            if !(value > 0.0 && value.is_finite()) {
                return Err(EditError::OutOfRange {
                    place: format!("footprints[{place}].{member}"),
                    found: value.to_string(),
                    allowed: "a distance above 0".to_owned(),
                });
            }
        }
    }
    Ok(())
}
