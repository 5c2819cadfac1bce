//! Chains of points whose distances stay: forward and backward reaching inverse kinematics \[AL11\], with limits to the
//! bends of its joints.

use std::f64::consts::PI;

use glam::DVec3;

/// Passes in both directions, after which a chain stops wherever its end is.
const MOST_PASSES: usize = 20_000;

/// The same for a chain with limits, whose passes may come to rest away from the target.
const MOST_LIMITED_PASSES: usize = 1_000;

/// The same for each part of a way, and for callers that ask many times.
const FEW_PASSES: usize = 100;

/// The parts of the way in which a chain with limits goes to a target that it does not find at once.
const STEPS: u32 = 16;

/// The distance from the target at which the end has arrived, as a share of the chain's length.
const ARRIVED: f64 = 1e-10;

/// After so many passes, and again after as many, it is looked whether a chain with limits still comes nearer.
const LOOK: usize = 32;

/// It rests if more than this share of the way to the target is left since the last look.
const SLOW: f64 = 0.98;

/// A chain whose target is within this share of its length from its full reach is straight.
const STRETCHED: f64 = 1e-9;

/// The least and the most bend of a joint in radians, 0 to π: the angle between the segments before and after it, 0 where
/// they are one straight line.
pub type BendRange = [f64; 2];

/// The bends of a joint without limits.
pub const FREE_BEND: BendRange = [0.0, PI];

/// The limits of a chain's joints.
#[derive(Clone, Copy, Debug, Default)]
pub struct JointLimits<'a> {
    /// A range for each point of the chain; none at all for a chain without limits. That of the last point limits nothing.
    pub bends: &'a [BendRange],
    /// The direction in which the segment before the first point goes on, if there is one: it limits the first joint.
    pub before: Option<DVec3>,
}

impl JointLimits<'_> {
    fn are_free(&self) -> bool {
        self.bends.iter().all(|range| *range == FREE_BEND)
    }

    /// The direction nearest to the unit vector `direction` that a joint allows after a segment in the direction `before`.
    pub fn allowed(&self, joint: usize, before: DVec3, direction: DVec3) -> DVec3 {
        let Some([least, most]) = self.bends.get(joint) else {
            return direction;
        };
        let (along, bend) = (before.normalize_or(DVec3::X), before.angle_between(direction));
        if (*least..=*most).contains(&bend) {
            return direction;
        }
        // A straight or a folded joint may bend towards any side. The first rejection from a nearly parallel direction is
        // not quite perpendicular.
        let across = direction.reject_from_normalized(along).try_normalize();
        let across = across.and_then(|across| across.reject_from_normalized(along).try_normalize());
        let across = across.unwrap_or_else(|| along.any_orthonormal_vector());
        let (sine, cosine) = bend.clamp(*least, *most).sin_cos();
        along * cosine + across * sine
    }
}

/// The chain, with its last point at `target`, or as near to it as the chain can come: its first point stays, and so do
/// the distances of neighbours, which must not be 0. The others move little.
pub fn pulled_chain(points: &[DVec3], target: DVec3) -> Vec<DVec3> {
    pulled_within(points, target, JointLimits::default())
}

/// The same with joints that bend within `limits`. A chain that is beyond them comes into them. Narrow limits can keep the
/// passes from a target that another pose would reach; the chain then ends as near to it as they come.
pub fn pulled_within(points: &[DVec3], target: DVec3, limits: JointLimits<'_>) -> Vec<DVec3> {
    let chain = pulled_in(MOST_LIMITED_PASSES, points, target, limits);
    let [.., end] = *points else { return chain };
    let whole: f64 = points.windows(2).map(|pair| pair[0].distance(pair[1])).sum();
    let missed = chain[chain.len() - 1].distance(target);
    if limits.are_free() || missed <= ARRIVED * whole {
        return chain;
    }
    // Joints at their limits block some ways: in small steps the chain stays with poses that are near to each other.
    let mut walking = points.to_vec();
    for step in 1..STEPS {
        let goal = end.lerp(target, f64::from(step) / f64::from(STEPS));
        reach(&mut walking, goal, limits, FEW_PASSES);
    }
    let last = reach(&mut walking, target, limits, MOST_LIMITED_PASSES);
    if last < missed { walking } else { chain }
}

/// [`pulled_within`] for callers that ask many times and go on from the last answer: it looks for no way around limits, and
/// may stop before it arrives.
pub fn pulled_briefly(points: &[DVec3], target: DVec3, limits: JointLimits<'_>) -> Vec<DVec3> {
    pulled_in(FEW_PASSES, points, target, limits)
}

/// The pulled chain after so many passes, if it has limits.
fn pulled_in(limited_passes: usize, points: &[DVec3], target: DVec3, limits: JointLimits<'_>) -> Vec<DVec3> {
    let mut chain = points.to_vec();
    let [root, .., end] = *points else { return chain };
    if end == target {
        return chain;
    }
    if !limits.are_free() {
        reach(&mut chain, target, limits, limited_passes);
        return chain;
    }
    let whole: f64 = points.windows(2).map(|pair| pair[0].distance(pair[1])).sum();
    if target.distance(root) >= whole * (1.0 - STRETCHED) {
        stretch(&mut chain, target);
    } else {
        reach(&mut chain, target, JointLimits::default(), MOST_PASSES);
    }
    chain
}

/// Stretches a chain towards a target that it just or never reaches, where the passes converge slowly.
fn stretch(chain: &mut [DVec3], target: DVec3) {
    let way = (target - chain[0]).normalize_or(DVec3::X);
    let mut before = chain[0];
    for point in 1..chain.len() {
        let length = chain[point].distance(before);
        before = chain[point];
        chain[point] = chain[point - 1] + way * length;
    }
}

/// Passes from the end to the first point and back, until the end arrives or rests; returns its distance from the target.
fn reach(chain: &mut [DVec3], target: DVec3, limits: JointLimits<'_>, most_passes: usize) -> f64 {
    let (root, last) = (chain[0], chain.len() - 1);
    let lengths: Vec<f64> = chain.windows(2).map(|pair| pair[0].distance(pair[1])).collect();
    let whole: f64 = lengths.iter().sum();
    let (mut missed, mut looked) = (f64::INFINITY, f64::INFINITY);
    for pass in 1..=most_passes {
        bend_straight(chain, target, whole);
        chain[last] = target;
        for point in (0..last).rev() {
            let mut way = way(chain[point + 1], chain[point]);
            if point + 1 < last {
                way = limits.allowed(point + 1, chain[point + 1] - chain[point + 2], way);
            }
            chain[point] = chain[point + 1] + way * lengths[point];
        }
        chain[0] = root;
        for point in 0..last {
            let mut way = way(chain[point], chain[point + 1]);
            let segment_before = match point {
                0 => limits.before,
                point => Some(chain[point] - chain[point - 1]),
            };
            if let Some(segment_before) = segment_before {
                way = limits.allowed(point, segment_before, way);
            }
            chain[point + 1] = chain[point] + way * lengths[point];
        }
        missed = chain[last].distance(target);
        let looks = pass % LOOK == 0 && !limits.are_free();
        if missed <= ARRIVED * whole || (looks && missed > SLOW * looked) {
            break;
        }
        if looks {
            looked = missed;
        }
    }
    missed
}

/// The direction from one point to another.
fn way(from: DVec3, to: DVec3) -> DVec3 {
    (to - from).normalize_or(DVec3::X)
}

/// Bends a chain that is straight towards the target, because passes along one line never leave the line.
fn bend_straight(chain: &mut [DVec3], target: DVec3, whole: f64) {
    let root = chain[0];
    let Some(along) = (chain[1] - root).try_normalize() else {
        return;
    };
    let off = |point: &DVec3| (*point - root).reject_from_normalized(along).length();
    if chain.iter().chain([&target]).all(|point| off(point) < 1e-6 * whole) {
        let across = along.any_orthonormal_vector();
        let last = chain.len() - 1;
        for point in &mut chain[1..last] {
            *point += across * (1e-3 * whole);
        }
    }
}
