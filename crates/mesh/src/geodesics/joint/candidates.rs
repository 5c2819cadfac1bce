//! The rings of a limb that may be its joint, from the tip towards the body.
//!
//! Limbs narrow at most joints, so every ring that is narrower than the rings before and after it is a candidate. Knees
//! and elbows of smooth limbs do not show in the rings; candidates a few radii apart fill the gaps there.

use std::f64::consts::TAU;

use super::rings::{Rings, Source};
use crate::SurfaceVertex;

/// A ring is a candidate if the rings before and after it are this much longer.
const NARROWS: f64 = 1.06;

/// The largest gap between candidates, in radii of the ring at its beginning.
const GAP_RADII: f64 = 3.0;

/// The level of the candidate `up` places after the guess's, with the triangle of these corners on the limb, and the
/// number of places by which it is after; fewer if there are fewer. `None` if that is the guess itself.
pub(super) fn chosen(rings: &Rings, corners: &[SurfaceVertex; 3], guess: usize, up: i32) -> Option<(usize, i32)> {
    let levels = levels(rings, corners, guess);
    let at = levels.iter().position(|&level| level == guess)?;
    let last = levels.len() as i64 - 1;
    let place = (at as i64 + i64::from(up)).clamp(0, last);
    let level = levels[usize::try_from(place).ok()?];
    (level != guess).then_some((level, (place - at as i64) as i32))
}

/// The candidates' levels, ascending; one of them is the guess.
fn levels(rings: &Rings, corners: &[SurfaceVertex; 3], guess: usize) -> Vec<usize> {
    let is_ring = |level: usize| rings.lengths()[level] > 0.0 && !rings.is_round(level, Source::Tip);
    let around: Vec<usize> = (rings.first(corners)..rings.lengths().len())
        .filter(|&level| is_ring(level) || level == guess)
        .collect();
    let radius = |level: usize| rings.lengths().get(level).map_or(0.0, |length| length / TAU);
    let apart = |one: usize, other: usize| (rings.radii()[other] - rings.radii()[one]).abs();
    // The guess replaces a candidate beside it.
    let mut fixed: Vec<usize> = narrow(rings, &around);
    fixed.retain(|&level| apart(level, guess) > radius(guess));
    fixed.push(guess);
    fixed.sort_unstable();
    let mut levels = Vec::new();
    let ends = around.first().copied().into_iter().chain(fixed.iter().copied());
    let nexts = fixed.iter().copied().chain(around.last().copied());
    for (from, to) in ends.zip(nexts) {
        let step = GAP_RADII * radius(from).max(radius(to).min(radius(guess)));
        let count = match step > 0.0 && to > from {
            true => (apart(from, to) / step).floor() as usize,
            false => 0,
        };
        for number in 1..=count {
            let share = number as f64 / (count + 1) as f64;
            let target = rings.radii()[from] + share * apart(from, to);
            let between = around.iter().filter(|&&level| level > from && level < to);
            let off = |level: &&usize| (rings.radii()[**level] - target).abs();
            levels.extend(between.min_by(|a, b| off(a).total_cmp(&off(b))));
        }
        levels.push(to);
    }
    // The last end is no candidate itself.
    levels.pop();
    levels.dedup();
    levels
}

/// The levels whose rings are narrower than those before and after them. `around` are the levels with a ring.
fn narrow(rings: &Rings, around: &[usize]) -> Vec<usize> {
    let length = |level: usize| rings.lengths()[level];
    let mut found = Vec::new();
    let Some(&first) = around.first() else {
        return found;
    };
    let (mut least, mut most, mut narrows) = (first, first, false);
    for &level in around {
        if narrows {
            if length(level) < length(least) {
                least = level;
            }
            if length(level) > NARROWS * length(least) {
                found.push(least);
                (most, narrows) = (level, false);
            }
        } else {
            if length(level) > length(most) {
                most = level;
            }
            if length(level) * NARROWS < length(most) {
                (least, narrows) = (level, true);
            }
        }
    }
    found
}
