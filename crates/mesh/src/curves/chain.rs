//! Chains of points whose distances stay: forward and backward reaching inverse kinematics \[AL11\], with limits to the
//! bends of its joints. Passes over a chain put one segment after another and come to rest where two limits block each
//! other; from there `joint_search.rs` turns all joints together.

use glam::DVec3;

use super::joint_limits::JointLimits;
use super::joint_search::posed;

/// Passes in both directions, after which a chain stops wherever its end is.
const MOST_PASSES: usize = 20_000;

/// The same for a chain with limits, whose passes may come to rest away from the target.
const MOST_LIMITED_PASSES: usize = 1_000;

/// The same for callers that ask many times.
const FEW_PASSES: usize = 100;

/// The distance from the target at which the end has arrived, as a share of the chain's length.
const ARRIVED: f64 = 1e-10;

/// The number of passes after which a chain with limits is checked for whether it still comes nearer.
const LOOK: usize = 32;

/// It rests if more than this share of the way to the target is left since the last look.
const SLOW: f64 = 0.98;

/// A chain whose target is within this share of its length from its full reach is straight.
const STRETCHED: f64 = 1e-9;

/// The chain, with its last point at `target`, or as near to it as the chain can come: its first point stays, and so do
/// the distances of neighbours, which must not be 0. The others move little.
pub fn pulled_chain(points: &[DVec3], target: DVec3) -> Vec<DVec3> {
    pulled_within(points, target, JointLimits::default())
}

/// The same with joints that bend within `limits`. A chain that is beyond them comes into them. In rare cases narrow limits
/// keep it from a target that another pose would reach; the chain then ends as near to it as it has come.
pub fn pulled_within(points: &[DVec3], target: DVec3, limits: JointLimits<'_>) -> Vec<DVec3> {
    let chain = pulled_in(MOST_LIMITED_PASSES, points, target, limits);
    let whole: f64 = points.windows(2).map(|pair| pair[0].distance(pair[1])).sum();
    let has_arrived = |end: &DVec3| end.distance(target) <= ARRIVED * whole;
    if limits.are_free() || chain.last().is_none_or(has_arrived) {
        return chain;
    }
    posed([&chain, points], target, limits)
}
/// [`pulled_within`] for callers that ask many times and go on from the last answer: it may stop before it arrives.
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

/// Passes from the end to the first point and back, until the end arrives or rests.
fn reach(chain: &mut [DVec3], target: DVec3, limits: JointLimits<'_>, most_passes: usize) {
    let (root, last) = (chain[0], chain.len() - 1);
    let lengths: Vec<f64> = chain.windows(2).map(|pair| pair[0].distance(pair[1])).collect();
    let whole: f64 = lengths.iter().sum();
    let mut looked = f64::INFINITY;
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
        let missed = chain[last].distance(target);
        let looks = pass % LOOK == 0 && !limits.are_free();
        if missed <= ARRIVED * whole || (looks && missed > SLOW * looked) {
            break;
        }
        if looks {
            looked = missed;
        }
    }
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
