//! The brush that corrects the shape: what it does, and how far.

/// What the brush does to the shape.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default, Hash)]
pub enum Correction {
    /// Takes bumps and creases away, and keeps the volume.
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
    /// What it does.
    pub correction: Correction,
    /// How far one dab goes, 0 to 1; a grab goes as far as the pointer.
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
    /// The brush with its strength within what it may be; `None` where that is no number.
    pub(crate) fn clamped(self) -> Option<Self> {
        self.strength.is_finite().then(|| Self {
            strength: self.strength.clamp(0.0, 1.0),
            ..self
        })
    }
}
