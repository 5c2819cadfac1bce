//! Curves as chains: a pulled point takes the others along at their distances, and pinned points stay.

use glam::DVec3;
use pliant_mesh::pulled_chain;

/// The most times that both sides of a pulled point between two pins answer each other.
const MOST_ANSWERS: usize = 200;

/// The distance at which both sides meet, as a share of the chain's length.
const MET: f64 = 1e-10;

/// The chain with the given point pulled to a target, or as near to it as the pins let it come. Pinned points, given by
/// their numbers, stay, and so does all beyond the nearest pin on either side. Without a pin before the pulled point the
/// first point is one, and the points behind the pulled one keep their distances from it; the first point itself pulls
/// the chain from its other end.
pub(super) fn pulled_at(chain: &[DVec3], pinned: &[u32], point: usize, target: DVec3) -> Vec<DVec3> {
    let pin = |number: &u32| *number as usize;
    let before = pinned.iter().map(pin).filter(|pin| *pin < point).max();
    let behind = pinned
        .iter()
        .map(pin)
        .filter(|pin| (point + 1..chain.len()).contains(pin))
        .min();
    let last = chain.len() - 1;
    let (before, behind) = match (before, behind) {
        (None, None) if point == 0 => (None, Some(last)),
        // A free end hangs on the pin behind it.
        (None, Some(behind)) => (None, Some(behind)),
        (before, behind) => (Some(before.unwrap_or(0)), behind),
    };
    let mut pulled = chain.to_vec();
    match (before, behind) {
        (Some(before), Some(behind)) => {
            if let Some([left, right]) = between(chain, before, point, behind, target) {
                pulled[before..=point].copy_from_slice(&left);
                pulled[point..=behind].copy_from_slice(&right);
            }
        }
        // The side without a pin moves along.
        (Some(before), None) => {
            let own = pulled_chain(&chain[before..=point], target);
            pulled[before..=point].copy_from_slice(&own);
            let way = pulled[point] - chain[point];
            pulled[point + 1..].iter_mut().for_each(|own| *own += way);
        }
        (None, behind) => {
            let behind = behind.unwrap_or(last);
            let own = pulled_backwards(&chain[point..=behind], target);
            pulled[point..=behind].copy_from_slice(&own);
            let way = pulled[point] - chain[point];
            pulled[..point].iter_mut().for_each(|own| *own += way);
        }
    }
    pulled
}

/// The chain with its first point pulled to a target; the last one stays.
fn pulled_backwards(chain: &[DVec3], target: DVec3) -> Vec<DVec3> {
    let reversed: Vec<DVec3> = chain.iter().rev().copied().collect();
    let mut pulled = pulled_chain(&reversed, target);
    pulled.reverse();
    pulled
}

/// Both sides of a point between two pins, from each pin to the point and from the point to the other one, pulled to a
/// target: each in turn goes to where the other one has come. `None` if they do not meet, because the pins hold them.
fn between(chain: &[DVec3], before: usize, point: usize, behind: usize, target: DVec3) -> Option<[Vec<DVec3>; 2]> {
    let whole: f64 = chain[before..=behind]
        .windows(2)
        .map(|pair| pair[0].distance(pair[1]))
        .sum();
    let mut goal = target;
    for _ in 0..MOST_ANSWERS {
        let left = pulled_chain(&chain[before..=point], goal);
        let met = left[point - before];
        let right = pulled_backwards(&chain[point..=behind], met);
        goal = right[0];
        if goal.distance(met) <= MET * whole {
            return Some([left, right]);
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::pulled_at;

    fn chain() -> Vec<DVec3> {
        let point = |x: i32| DVec3::new(f64::from(x), 0.1 * f64::from(x * x), 0.0);
        (0..7).map(point).collect()
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
}
