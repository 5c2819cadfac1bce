//! Curves as chains: a pulled point takes the others along at their distances, pinned points stay, and joints bend within
//! their limits.

use glam::{DQuat, DVec3};
use pliant_mesh::{BendRange, JointLimits, pulled_briefly, pulled_within};

/// The most times that both sides of a pulled point between two pins answer each other.
const MOST_ANSWERS: usize = 200;

/// The number of answers after which both sides are checked for whether they still come nearer.
const LOOK: usize = 8;

/// They do not meet if more than this share of the gap between them is left since the last look.
const SLOW: f64 = 0.9;

/// The distance at which both sides meet, as a share of the chain's length.
const MET: f64 = 1e-10;

/// The angle in radians by which a joint may miss its limits by rounding.
const ROUNDING_RAD: f64 = 1e-9;

/// The steps by which a point between two pins comes near to the place where a limit or the pins stop it.
const HALVINGS: u32 = 8;

/// A chain of points, the numbers of those that stay, and the bends that they may have, one for each point or none.
#[derive(Clone, Debug)]
pub(crate) struct Chain {
    pub(crate) points: Vec<DVec3>,
    pub(crate) pinned: Vec<u32>,
    pub(crate) bends: Vec<BendRange>,
}

impl Chain {
    /// The chain with the given point pulled to a target, or as near to it as pins and limits let it come. Pinned points
    /// stay, and so does all beyond the nearest pin on either side. Without a pin before the pulled point the first point
    /// is one, and the points behind the pulled one keep their distances from it; the first point itself pulls the chain
    /// from its other end.
    pub(crate) fn pulled(&self, point: usize, target: DVec3) -> Vec<DVec3> {
        let pin = |number: &u32| *number as usize;
        let before = self.pinned.iter().map(pin).filter(|pin| *pin < point).max();
        let after_it = point + 1..self.points.len();
        let behind = self.pinned.iter().map(pin).filter(|pin| after_it.contains(pin)).min();
        let last = self.points.len() - 1;
        let (before, behind) = match (before, behind) {
            (None, None) if point == 0 => (None, Some(last)),
            // A free end hangs on the pin behind it.
            (None, Some(behind)) => (None, Some(behind)),
            (before, behind) => (Some(before.unwrap_or(0)), behind),
        };
        match (before, behind) {
            (Some(before), Some(behind)) => self.pulled_between(before, point, behind, target),
            (Some(before), None) => self.pulled_forwards(before, point, target),
            (None, behind) => {
                let mut pulled = self
                    .reversed()
                    .pulled_forwards(last - behind.unwrap_or(last), last - point, target);
                pulled.reverse();
                pulled
            }
        }
    }

    /// The same chain from its last point to its first.
    fn reversed(&self) -> Self {
        let last = self.points.len() as u32 - 1;
        Self {
            points: self.points.iter().rev().copied().collect(),
            pinned: self.pinned.iter().rev().map(|pin| last - pin).collect(),
            bends: self.bends.iter().rev().copied().collect(),
        }
    }

    /// The chain with a point pulled about the pin before it. What comes after the point moves along, and turns as far as
    /// the joint at the point needs.
    fn pulled_forwards(&self, before: usize, point: usize, target: DVec3) -> Vec<DVec3> {
        let mut pulled = self.points.to_vec();
        let own = pulled_within(&self.points[before..=point], target, self.limits(before));
        pulled[before..=point].copy_from_slice(&own);
        let (from, to) = (self.points[point], pulled[point]);
        let turn = self.points.get(point + 1).map_or(DQuat::IDENTITY, |next| {
            let way = (*next - from).normalize_or(DVec3::X);
            let allowed = self.limits(0).allowed(point, to - pulled[point - 1], way);
            if allowed == way {
                DQuat::IDENTITY
            } else {
                DQuat::from_rotation_arc(way, allowed.normalize())
            }
        });
        for own in &mut pulled[point + 1..] {
            *own = if turn == DQuat::IDENTITY {
                *own + (to - from)
            } else {
                to + turn * (*own - from)
            };
        }
        pulled
    }

    /// The limits of the joints from `first` on.
    fn limits(&self, first: usize) -> JointLimits<'_> {
        JointLimits {
            bends: self.bends.get(first..).unwrap_or_default(),
            before: first
                .checked_sub(1)
                .map(|before| self.points[first] - self.points[before]),
        }
    }

    /// The chain with a point between two pins pulled as near to the target as they let it come, on the straight way.
    fn pulled_between(&self, before: usize, point: usize, behind: usize, target: DVec3) -> Vec<DVec3> {
        if let Some(met) = self.met(before, point, behind, target) {
            return met;
        }
        let (mut share, mut step) = (0.0, 0.5);
        let mut best = self.points.to_vec();
        for _ in 0..HALVINGS {
            let goal = self.points[point].lerp(target, share + step);
            if let Some(met) = self.met(before, point, behind, goal) {
                (best, share) = (met, share + step);
            }
            step *= 0.5;
        }
        best
    }

    /// Both sides of a point between two pins, from each pin to the point, pulled to a target: each in turn goes to where
    /// the other one has come. `None` if they do not meet, because the pins or the limits hold them.
    fn met(&self, before: usize, point: usize, behind: usize, target: DVec3) -> Option<Vec<DVec3>> {
        let lengths = self.points[before..=behind]
            .windows(2)
            .map(|pair| pair[0].distance(pair[1]));
        let whole: f64 = lengths.sum();
        let reversed = self.reversed();
        let end = self.points.len() - 1;
        let (first, last) = (end - behind, end - point);
        let (mut left, mut right) = (
            self.points[before..=point].to_vec(),
            reversed.points[first..=last].to_vec(),
        );
        let (mut goal, mut looked) = (target, f64::INFINITY);
        for answer in 1..=MOST_ANSWERS {
            left = pulled_briefly(&left, goal, self.limits(before));
            let met = left[point - before];
            right = pulled_briefly(&right, met, reversed.limits(first));
            goal = right[behind - point];
            let gap = goal.distance(met);
            if gap > MET * whole {
                if answer % LOOK == 0 && gap > SLOW * looked {
                    return None;
                }
                looked = if answer % LOOK == 0 { gap } else { looked };
                continue;
            }
            let mut pulled = self.points.to_vec();
            pulled[point..=behind]
                .iter_mut()
                .zip(right.iter().rev())
                .for_each(|(own, right)| *own = *right);
            pulled[before..=point].copy_from_slice(&left);
            let [way_before, way_after] = [pulled[point] - pulled[point - 1], pulled[point + 1] - pulled[point]];
            let allowed = self
                .limits(0)
                .allowed(point, way_before, way_after.normalize_or(DVec3::X));
            return (allowed.angle_between(way_after) <= ROUNDING_RAD).then_some(pulled);
        }
        None
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::Chain;

    fn chain() -> Vec<DVec3> {
        let point = |x: i32| DVec3::new(f64::from(x), 0.1 * f64::from(x * x), 0.0);
        (0..7).map(point).collect()
    }

    fn pulled_at(points: &[DVec3], pinned: &[u32], point: usize, target: DVec3) -> Vec<DVec3> {
        let (points, pinned) = (points.to_vec(), pinned.to_vec());
        let bends = Vec::new();
        Chain { points, pinned, bends }.pulled(point, target)
    }

    fn lengths(chain: &[DVec3]) -> Vec<f64> {
        chain.windows(2).map(|pair| pair[0].distance(pair[1])).collect()
    }

    fn assert_lengths_stay(pulled: &[DVec3], case: &str) {
        for (before, after) in lengths(&chain()).into_iter().zip(lengths(pulled)) {
            assert!((before - after).abs() < 1e-9, "{case}: {before} and {after}");
        }
    }

    #[test]
    fn a_pulled_chain_keeps_its_lengths_wherever_it_is_pulled() {
        let chain = chain();
        for point in 0..chain.len() {
            let target = chain[point] * 0.6 + DVec3::new(0.2, 0.15, 0.1);
            let pulled = pulled_at(&chain, &[], point, target);
            // One segment alone reaches nothing but its circle.
            let is_reached = pulled[point].distance(target) < 1e-6;
            assert_eq!(is_reached, point != 1, "{point}: {}", pulled[point]);
            assert_lengths_stay(&pulled, &format!("{point}"));
        }
    }

    #[test]
    fn pinned_points_stay_to_the_bit_and_lengths_too() {
        let chain = chain();
        for pins in [&[3][..], &[0, 3], &[2, 5], &[0, 6], &[1, 2]] {
            for point in (0..chain.len()).filter(|point| !pins.contains(&(*point as u32))) {
                for by in [DVec3::new(-0.4, 0.3, 0.2), DVec3::new(20.0, 0.0, 5.0)] {
                    let pulled = pulled_at(&chain, pins, point, chain[point] + by);
                    for pin in pins {
                        assert_eq!(pulled[*pin as usize], chain[*pin as usize], "{pins:?} {point}");
                    }
                    assert_lengths_stay(&pulled, &format!("{pins:?} {point} {by}"));
                }
            }
        }
    }

    #[test]
    fn a_point_between_two_pins_comes_to_a_target_that_both_sides_reach() {
        let zigzag = |x: i32| DVec3::new(f64::from(x), f64::from(x % 2), 0.0);
        let chain: Vec<DVec3> = (0..7).map(zigzag).collect();
        let target = chain[3] + DVec3::new(0.4, 0.3, 0.6);
        let pulled = pulled_at(&chain, &[0, 6], 3, target);
        assert!(pulled[3].distance(target) < 1e-6, "{}", pulled[3]);
        // An elbow is pulled about the shoulder and the hand that lies on a table.
        assert!(pulled[1] != chain[1] && pulled[5] != chain[5]);
    }

    #[test]
    fn joints_bend_within_their_limits_beside_pins_and_between_them() {
        let points = chain();
        let bend = |points: &[DVec3], joint: usize| {
            (points[joint] - points[joint - 1]).angle_between(points[joint + 1] - points[joint])
        };
        let bends = [[0.01, 0.5]; 7];
        for pinned in [&[][..], &[3], &[0, 6], &[2, 5]] {
            let chain = Chain {
                points: points.clone(),
                pinned: pinned.to_vec(),
                bends: bends.to_vec(),
            };
            for point in (0..points.len()).filter(|point| !pinned.contains(&(*point as u32))) {
                for by in [
                    DVec3::new(-0.1, 0.2, 0.1),
                    DVec3::new(-1.0, 2.0, 0.5),
                    DVec3::new(-9.0, 1.0, 0.0),
                ] {
                    let pulled = chain.pulled(point, points[point] + by);
                    assert!(
                        pulled != points || by.length() > 1.0 || point == 1,
                        "{pinned:?} {point} {by}"
                    );
                    assert_lengths_stay(&pulled, &format!("{pinned:?} {point} {by}"));
                    for joint in 1..6 {
                        let bend = bend(&pulled, joint);
                        let case = format!("{pinned:?} {point} {by}: {bend} at {joint}");
                        assert!((0.01 - 1e-8..=0.5 + 1e-8).contains(&bend), "{case}");
                    }
                }
            }
        }
    }
}
