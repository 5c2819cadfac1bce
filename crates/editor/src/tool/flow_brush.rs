//! The flow brush: its action, its colour, its strength, and its softness at the rim.

/// The flow brush's action.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default, Hash)]
pub enum FlowAction {
    /// Pours colour, and moves the fluid with the stroke.
    #[default]
    PourAndPush,
    /// Pours colour.
    Pour,
    /// Moves the fluid with the stroke.
    Push,
    /// Washes colour away.
    Wash,
}

/// The flow brush.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct FlowBrush {
    /// Its action.
    pub action: FlowAction,
    /// Its colour, sRGB.
    pub colour: [u8; 3],
    /// The share of colour and velocity that the fluid gets in the middle, 0 to 1.
    pub strength: f64,
    /// Its softness: 0 is a hard rim, 1 falls off from the middle.
    pub falloff: f64,
}

impl Default for FlowBrush {
    fn default() -> Self {
        Self {
            action: FlowAction::default(),
            colour: [186, 74, 32],
            strength: 1.0,
            falloff: 0.5,
        }
    }
}

impl FlowBrush {
    /// The brush with every number clamped to its range; `None` if one is NaN.
    pub(crate) fn clamped(self) -> Option<Self> {
        (self.strength.is_finite() && self.falloff.is_finite()).then(|| Self {
            strength: self.strength.clamp(0.0, 1.0),
            falloff: self.falloff.clamp(0.0, 1.0),
            ..self
        })
    }

    /// Returns true if it moves the fluid.
    pub(super) fn pushes(&self) -> bool {
        matches!(self.action, FlowAction::PourAndPush | FlowAction::Push)
    }
}
