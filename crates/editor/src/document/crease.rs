//! A crease along a curve, which is made sharper or flatter.

/// The range of a crease's sharpness: −1 is flat, 0 as at rest, 1 twice as sharp.
pub const SHARPEN_RANGE: std::ops::RangeInclusive<f64> = -1.0..=4.0;

/// The surface beside a curve, and how much sharper than at rest it is.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Crease {
    width: f64,
    sharpen: f64,
}

impl Crease {
    /// The surface up to `width` from the curve, in world units, whose Laplacian is 1 + `sharpen` times that at rest.
    ///
    /// # Errors
    /// A sentence without its subject, the crease.
    pub fn new(width: f64, sharpen: f64) -> Result<Self, String> {
        if !(width.is_finite() && width > 0.0) {
            return Err(format!("has the `width` {width}: give a length above 0"));
        }
        if !SHARPEN_RANGE.contains(&sharpen) {
            let (flat, sharp) = (SHARPEN_RANGE.start(), SHARPEN_RANGE.end());
            return Err(format!(
                "has `sharpen` {sharpen}: give a number from {flat} (flat) to {sharp}"
            ));
        }
        Ok(Self { width, sharpen })
    }

    /// The distance from the curve up to which the surface changes, in world units.
    pub fn width(&self) -> f64 {
        self.width
    }

    /// How much sharper it is, in [`SHARPEN_RANGE`]: 0 changes nothing.
    pub fn sharpen(&self) -> f64 {
        self.sharpen
    }

    /// The same with another sharpness, clamped to its range.
    #[must_use]
    pub(crate) fn sharpened(self, sharpen: f64) -> Self {
        Self {
            sharpen: sharpen.clamp(*SHARPEN_RANGE.start(), *SHARPEN_RANGE.end()),
            ..self
        }
    }
}
