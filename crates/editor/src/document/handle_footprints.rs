//! The footprints of a handle of a sequence: it is held wherever it rests on the ground.

use pliant_deform::{Method, Remedy};

use crate::ground_axis::GroundAxis;

/// The conditions under which a handle rests on the ground.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct HandleFootprints {
    /// The axis that points up.
    pub up: GroundAxis,
    /// It is on the ground if its lowest vertex is within this height above the lowest one of all frames, in world units.
    pub height: f64,
    /// It rests if its middle moves by at most this distance from one frame to the next, in world units.
    pub speed: f64,
    /// The number of frames before and after a footprint over which it goes over to its own way.
    pub fade: u32,
}

impl HandleFootprints {
    /// The reason, in the words of the edit format, why a method can't hold handles by footprints.
    pub(crate) fn refusal_by(method: &Method) -> Option<String> {
        (!method.takes_places()).then(|| {
            format!(
                "`{}` moves a handle as a whole, and footprints hold each of its vertices at a place: take {}",
                method.name(),
                Remedy::TakingPlaces
            )
        })
    }

    /// Returns true if an edit may have them.
    pub(crate) fn are_usable(&self) -> bool {
        [self.height, self.speed]
            .iter()
            .all(|length| *length > 0.0 && length.is_finite())
    }
}
