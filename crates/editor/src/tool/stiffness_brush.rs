//! The stiffness brush: its action, its strength, and its softness at the rim.

use super::firmness::firmness;
use crate::STIFFNESS_RANGE;

/// The stiffness brush's action.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default, Hash)]
pub enum StiffnessAction {
    /// Takes the surface towards the brush's value.
    #[default]
    Paint,
    /// Takes each vertex towards its neighbours.
    Smooth,
    /// Makes the surface rigid: each connected part moves as one body.
    Rigid,
    /// Takes the surface back to 1.
    Erase,
}

/// The stiffness brush.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct StiffnessBrush {
    /// Its action.
    pub action: StiffnessAction,
    /// Its value, in [`STIFFNESS_RANGE`].
    pub value: f64,
    /// The strength of one stroke, 0 to 1.
    pub strength: f64,
    /// Its softness: 0 is a hard rim, 1 falls off from the middle.
    pub falloff: f64,
}

impl Default for StiffnessBrush {
    fn default() -> Self {
        Self {
            action: StiffnessAction::default(),
            value: 10.0,
            strength: 1.0,
            falloff: 0.5,
        }
    }
}

impl StiffnessBrush {
    /// The brush with every number clamped to its range; `None` if one is NaN.
    pub(crate) fn clamped(self) -> Option<Self> {
        let is_usable = [self.value, self.strength, self.falloff]
            .iter()
            .all(|number| number.is_finite());
        is_usable.then(|| Self {
            value: self.value.clamp(*STIFFNESS_RANGE.start(), *STIFFNESS_RANGE.end()),
            strength: self.strength.clamp(0.0, 1.0),
            falloff: self.falloff.clamp(0.0, 1.0),
            ..self
        })
    }

    /// The firmness of the brush at a share of its radius: 1 inside, 0 at the rim, a smooth step between.
    pub(super) fn firmness(&self, share: f64) -> f64 {
        firmness(self.falloff, share)
    }
}
