//! The brush that corrects the shape: its action and strength.

/// The brush's action on the shape.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default, Hash)]
pub enum Correction {
    /// Removes bumps and creases, and keeps the volume.
    #[default]
    Smooth,
    /// Evens out the triangles. The surface keeps its shape.
    Relax,
    /// Drags the surface with the pointer, and keeps the volume.
    Grab,
}

/// The brush that corrects the shape.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct CorrectionBrush {
    /// Its action.
    pub correction: Correction,
    /// The strength of one dab, 0 to 1; a grab always follows the pointer fully.
    pub strength: f64,
}

impl Default for CorrectionBrush {
    fn default() -> Self {
        Self {
            correction: Correction::default(),
            strength: 0.5,
        }
    }
}

impl CorrectionBrush {
    /// The brush with its strength clamped to its range; `None` for NaN.
    pub(crate) fn clamped(self) -> Option<Self> {
        self.strength.is_finite().then(|| Self {
            strength: self.strength.clamp(0.0, 1.0),
            ..self
        })
    }
}
