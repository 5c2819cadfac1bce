//! The number of the view's pixels that become one while something moves: as few as the device manages in time.

/// A drawing that takes longer than this in milliseconds gets fewer pixels.
const SLOW_MS: f64 = 50.0;
/// A drawing that takes less than this gets more again; the limit is low enough that it does not oscillate.
const FAST_MS: f64 = 10.0;
/// The most pixels a side that become one.
const COARSEST: u32 = 4;
/// Fewer pixels must make a drawing at least this much faster: a mesh of millions of triangles on a software device
/// gains nothing from them.
const WORTH: f64 = 0.8;

/// The choice, from one drawing to the next.
#[derive(Debug, Clone, PartialEq)]
pub struct Coarseness {
    factor: u32,
    /// The time of a drawing before the last step to fewer pixels.
    before_ms: Option<f64>,
    /// Fewer pixels were tried and gained nothing.
    is_in_vain: bool,
}

impl Default for Coarseness {
    fn default() -> Self {
        Self {
            factor: 1,
            before_ms: None,
            is_in_vain: false,
        }
    }
}

impl Coarseness {
    /// The view's pixels a side for one pixel of the picture.
    pub fn factor(&self) -> u32 {
        self.factor
    }

    /// Takes the time of a drawing at the present factor.
    pub fn took(&mut self, ms: f64) {
        if let Some(before_ms) = self.before_ms.take()
            && ms > WORTH * before_ms
        {
            self.factor = 1;
            self.is_in_vain = true;
        } else if ms > SLOW_MS && self.factor < COARSEST && !self.is_in_vain {
            self.before_ms = Some(ms);
            self.factor *= 2;
        } else if ms < FAST_MS {
            self.factor = (self.factor / 2).max(1);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Draws thirty times with a device that needs `fixed_ms` and `pixels_ms` at full size; the last ten factors.
    fn factors(fixed_ms: f64, pixels_ms: f64) -> Vec<u32> {
        let mut coarseness = Coarseness::default();
        let mut factors = Vec::new();
        for _ in 0..30 {
            let factor = f64::from(coarseness.factor());
            coarseness.took(fixed_ms + pixels_ms / (factor * factor));
            factors.push(coarseness.factor());
        }
        factors.split_off(20)
    }

    #[test]
    fn a_fast_device_draws_every_pixel_and_a_slow_one_settles_on_fewer() {
        assert_eq!(factors(1.0, 5.0), [1; 10]);
        assert_eq!(factors(5.0, 40.0), [1; 10]);
        assert_eq!(factors(10.0, 100.0), [2; 10]);
        assert_eq!(factors(10.0, 400.0), [4; 10]);
    }

    #[test]
    fn where_fewer_pixels_gain_nothing_all_are_drawn() {
        assert_eq!(factors(900.0, 30.0), [1; 10]);
    }
}
