//! A curve whose free point has slid along its line.

use glam::DVec3;

use super::handle_curve::HandleCurve;
use crate::chain::Chain;

/// A chain reaches a place if it ends within this share of its length from it.
const REACHED: f64 = 1e-6;

impl HandleCurve {
    /// The chain of its points at these places.
    pub(crate) fn chain(&self, points: Vec<DVec3>) -> Chain {
        Chain {
            points,
            pinned: self.pinned().to_vec(),
            bends: self.bends_rad(),
        }
    }

    /// The same curve, held, after its free point has slid by a length in world units; `None` if it has none, if its chain
    /// does not reach there, or if that would be no curve.
    pub(crate) fn slid(&self, length: f64) -> Option<Self> {
        let free = self.free_point()?;
        let (own, mut moved) = (free.point as usize, self.moved().to_vec());
        if length != 0.0 {
            let to = *moved.get(own)? + free.along * length;
            if free.is_chain {
                moved = self.chain(moved).pulled(own, to);
                if moved[own].distance(to) > REACHED * self.rest().length() {
                    return None;
                }
            } else {
                moved[own] = to;
            }
        }
        self.with(moved, self.twist_deg().to_vec(), self.scale().to_vec())
    }
}
