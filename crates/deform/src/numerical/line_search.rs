//! A line search that halves and interpolates ([NW06], sections 3.1 and 3.5).

/// A step must lower the energy by this share of its slope's prediction.
const SUFFICIENT: f64 = 1e-4;

/// One length along a direction, with its energy.
pub(crate) struct Trial {
    /// The length, positive.
    pub length: f64,
    /// The energy at length 0.
    pub before: f64,
    /// The energy at `length`.
    pub after: f64,
    /// The energy's slope at length 0, negative.
    pub slope: f64,
}

impl Trial {
    /// Returns true if the energy falls, and by a large enough share of the slope's prediction.
    pub fn is_sufficient(&self) -> bool {
        let Self {
            length,
            before,
            after,
            slope,
        } = *self;
        after <= before + SUFFICIENT * length * slope && after < before
    }

    /// The next, shorter length: the least of the parabola through both energies and the slope, from a tenth to a half
    /// of this length.
    pub fn next_length(&self) -> f64 {
        let Self {
            length,
            before,
            after,
            slope,
        } = *self;
        let least = -0.5 * slope * length * length / (after - before - slope * length);
        if least.is_finite() {
            least.clamp(0.1 * length, 0.5 * length)
        } else {
            0.1 * length
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Trial;

    #[test]
    fn the_next_length_is_a_parabolas_least_or_near_it() {
        let parabola = |least: f64| Trial {
            length: 1.0,
            before: least * least,
            after: (1.0 - least) * (1.0 - least),
            slope: -2.0 * least,
        };
        for least in [0.1, 0.25, 0.5] {
            assert!((parabola(least).next_length() - least).abs() < 1e-12);
        }
        assert_eq!(parabola(0.01).next_length(), 0.1);
        assert!(!parabola(0.25).is_sufficient() && parabola(0.75).is_sufficient());
        let endless = Trial {
            after: f64::INFINITY,
            ..parabola(0.25)
        };
        assert_eq!(endless.next_length(), 0.1);
        let unknown = Trial {
            after: f64::NAN,
            ..parabola(0.25)
        };
        assert!(!unknown.is_sufficient());
        assert_eq!(unknown.next_length(), 0.1);
    }
}
