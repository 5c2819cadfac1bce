//! The steps that fit a cage of Green coordinates to its handles: Gauss–Newton with Levenberg's damping, from the
//! better of the linear shape and the last one. Conjugate gradients solve for a step. The cage's own resistance damps
//! it, so that a step is as smooth as the shape. The resistance hardly sees a step that moves a whole part, so the
//! damping alone would not keep such a step from turning a face over: a step is also shortened.

use glam::DVec3;

use super::green_fit::{Asked, Derivatives, GreenFit, Tried, add, dot};

/// Steps end after one that lowers the energy by less than this share of it.
const TOLERANCE: f64 = 1e-3;

/// Energies below this are rounding.
const NOTHING: f64 = 1e-24;

/// The most conjugate directions of a step, and the share of the first residual's square that remains.
pub(super) const DIRECTIONS: usize = 60;
const LEFT: f64 = 0.01;

/// The most increases of a step's damping, and their factor.
const TRIALS: usize = 9;
const MORE: f64 = 5.0;

/// The lengths of a step that are tried before more damping.
const LENGTHS: [f64; 4] = [1.0, 0.3, 0.1, 0.03];

/// A step must lower the energy by this share of the linear model's prediction; above the second share the next step is
/// damped less.
const SUFFICIENT: f64 = 0.1;
const GOOD: f64 = 0.6;

/// The result of a step.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Progressed {
    /// The energy may decrease further.
    Descends,
    /// The energy hardly decreased.
    Converged,
    /// No step lowers the energy, although the model predicts a decrease.
    Stalled,
}

/// The state of the steps.
#[derive(Debug)]
pub(super) struct Descent {
    pub asked: Asked,
    pub current: Tried,
    pub state: Progressed,
    damping: f64,
}

impl Descent {
    /// Starts from the better of these displacements.
    pub fn new(fit: &GreenFit, asked: Asked, start: Vec<DVec3>, last: Option<Vec<DVec3>>) -> Self {
        let mut current = fit.tried(&asked, start);
        if let Some(last) = last.map(|last| fit.tried(&asked, last))
            && last.energy < current.energy
        {
            current = last;
        }
        Self {
            asked,
            current,
            state: Progressed::Descends,
            damping: 1.0,
        }
    }

    /// Takes one step, unless it has converged or stalled.
    pub fn step(&mut self, fit: &GreenFit) {
        if self.state != Progressed::Descends {
            return;
        }
        let before = self.current.energy;
        if before <= NOTHING {
            self.state = Progressed::Converged;
            return;
        }
        let derivatives = fit.derivatives(&self.current);
        let downhill = fit.downhill(&derivatives, &self.current);
        for _ in 0..TRIALS {
            let direction = direction(fit, &derivatives, self.damping, &downhill);
            let promised = dot(&downhill, &direction);
            for length in LENGTHS {
                let mut shifts = self.current.shifts.clone();
                add(&mut shifts, length, &direction);
                let tried = fit.tried(&self.asked, shifts);
                let gained = before - tried.energy;
                if gained > SUFFICIENT * length * promised && gained > 0.0 {
                    if length < 1.0 {
                        self.damping *= MORE;
                    } else if gained > GOOD * promised {
                        self.damping /= MORE;
                    }
                    if gained < TOLERANCE * before && length == 1.0 {
                        self.state = Progressed::Converged;
                    }
                    self.current = tried;
                    return;
                }
            }
            if promised < TOLERANCE * before {
                self.state = Progressed::Converged;
                return;
            }
            self.damping *= MORE;
        }
        self.state = Progressed::Stalled;
    }
}

/// The damped Gauss–Newton step, by conjugate gradients.
fn direction(fit: &GreenFit, derivatives: &Derivatives, damping: f64, downhill: &[DVec3]) -> Vec<DVec3> {
    let mut direction = vec![DVec3::ZERO; downhill.len()];
    let mut left = downhill.to_vec();
    let mut conjugate = fit.preconditioned(&left);
    let first = dot(&left, &conjugate);
    let mut square = first;
    for _ in 0..DIRECTIONS {
        let product = fit.product(derivatives, damping, &conjugate);
        let length = square / dot(&conjugate, &product);
        if !length.is_finite() {
            break;
        }
        add(&mut direction, length, &conjugate);
        add(&mut left, -length, &product);
        let mapped = fit.preconditioned(&left);
        let next = dot(&left, &mapped);
        if next <= LEFT * first {
            break;
        }
        for (own, mapped) in conjugate.iter_mut().zip(&mapped) {
            *own = *own * (next / square) + *mapped;
        }
        square = next;
    }
    direction
}
