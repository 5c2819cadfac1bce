//! The schedule by which a coarse level corrects a large surface: corrections alternate with the surface's own steps as
//! long as they gain enough, and become rarer otherwise.

/// The schedule of corrections.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Corrections {
    /// The most fine steps between two corrections.
    rarest: u32,
    /// Fine steps from one correction to the next.
    every: u32,
    /// Fine steps before the next one.
    left: u32,
    /// The decrease by the last fine step.
    gained: f64,
}

impl Corrections {
    /// The schedule for new targets, with `first` fine steps before the first correction.
    pub fn after(first: u32, rarest: u32) -> Self {
        Self {
            rarest,
            every: 1,
            left: first,
            gained: f64::INFINITY,
        }
    }

    /// Whether the next step is a correction.
    pub fn is_due(&self) -> bool {
        self.left == 0
    }

    /// Makes the next step a correction.
    pub fn hurry(&mut self) {
        self.left = 0;
    }

    /// Notes the decrease by a fine step.
    pub fn stepped(&mut self, gained: f64) {
        self.gained = gained;
        self.left = self.left.saturating_sub(1);
    }

    /// Notes the decrease by a correction, which is worth its time if it gained this many times the last fine step's.
    pub fn corrected(&mut self, gained: f64, worth: f64) {
        let is_worth_it = gained > 0.0 && gained >= worth * self.gained;
        self.every = if is_worth_it {
            1
        } else {
            self.rarest.min(2 * self.every)
        };
        self.left = self.every;
    }
}
