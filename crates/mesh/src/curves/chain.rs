//! Chains of points whose distances stay: forward and backward reaching inverse kinematics \[AL11\].

use glam::DVec3;

/// Passes in both directions, after which a chain stops wherever its end is.
const MOST_PASSES: usize = 20_000;

/// The distance from the target at which the end has arrived, as a share of the chain's length.
const ARRIVED: f64 = 1e-10;

/// The chain, with its last point at `target`, or as near to it as the chain can come: its first point stays, and so do
/// the distances of neighbours, which must not be 0. The others move little.
pub fn pulled_chain(points: &[DVec3], target: DVec3) -> Vec<DVec3> {
    let mut chain = points.to_vec();
    let [root, .., _] = *points else { return chain };
    let last = chain.len() - 1;
    let lengths: Vec<f64> = points.windows(2).map(|pair| pair[0].distance(pair[1])).collect();
    let whole: f64 = lengths.iter().sum();
    if chain[last] == target {
        return chain;
    }
    if target.distance(root) >= whole {
        // Stretched towards a target that it just or never reaches, where the passes converge slowly.
        let way = (target - root).normalize_or(DVec3::X);
        for (point, length) in lengths.iter().enumerate() {
            chain[point + 1] = chain[point] + way * *length;
        }
        return chain;
    }
    bend_straight(&mut chain, target, whole);
    for _ in 0..MOST_PASSES {
        chain[last] = target;
        for point in (0..last).rev() {
            chain[point] = at_distance(chain[point + 1], chain[point], lengths[point]);
        }
        chain[0] = root;
        for point in 0..last {
            chain[point + 1] = at_distance(chain[point], chain[point + 1], lengths[point]);
        }
        if chain[last].distance(target) <= ARRIVED * whole {
            break;
        }
    }
    chain
}

/// The point on the ray from `centre` towards `point` at a distance.
fn at_distance(centre: DVec3, point: DVec3, distance: f64) -> DVec3 {
    centre + (point - centre).normalize_or(DVec3::X) * distance
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
