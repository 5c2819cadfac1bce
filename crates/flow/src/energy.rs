//! The kinetic energy of each component, which does not grow without force.

use glam::DVec2;
use rayon::prelude::*;

use crate::error::FlowError;
use crate::fluid::Fluid;
use crate::sums::CHUNK;

/// Refuses speeds that are no numbers.
pub(crate) fn check_finite(speeds: &[f64]) -> Result<(), FlowError> {
    match speeds.iter().all(|speed| speed.is_finite()) {
        true => Ok(()),
        false => Err(FlowError::NotFinite),
    }
}

/// Slows components that are faster than allowed: advection may have given them kinetic energy. Returns the norm of the
/// velocity on each.
pub(crate) fn cap(fluid: &Fluid<'_>, allowed: &[f64], velocity: &mut [DVec2]) -> Vec<f64> {
    let mut speeds = fluid.speeds(velocity);
    let factor = |(&allowed, &speed): (&f64, &f64)| if speed > allowed { allowed / speed } else { 1.0 };
    let factors: Vec<f64> = allowed.iter().zip(&speeds).map(factor).collect();
    if factors.iter().all(|factor| *factor == 1.0) {
        return speeds;
    }
    for (speed, &allowed) in speeds.iter_mut().zip(allowed) {
        *speed = speed.min(allowed);
    }
    let slow = |(triangle, velocity): (usize, &mut DVec2)| *velocity *= factors[fluid.component_of_triangle(triangle)];
    velocity.par_iter_mut().with_min_len(CHUNK).enumerate().for_each(slow);
    speeds
}
