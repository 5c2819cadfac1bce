//! Filters of a trajectory in time.

use glam::DVec3;

use super::span::HandlePlace;

/// The Gaussian is cut off at this many standard deviations.
const REACH: f64 = 4.0;

/// The shifts of a handle by a filter with a Gaussian of standard deviation `width`, in frames, which adds `gain` times the
/// quick motions. `places` has the handle's place in each frame of the filter's span, and its parent's if it has one: its
/// way is then filtered as the parent sees it.
pub(crate) fn filter_shifts(places: &[(HandlePlace, Option<HandlePlace>)], width: f64, gain: f64) -> Vec<DVec3> {
    let seen = places.iter().map(|(own, parent)| match parent {
        Some(parent) => own.seen_from(parent),
        None => own.centre(),
    });
    let quick = quick_motions(&seen.collect::<Vec<DVec3>>(), width);
    let shifts = quick.iter().zip(places).map(|(quick, (_, parent))| {
        let shift = *quick * gain;
        parent.map_or(shift, |parent| parent.world_from_own(shift))
    });
    shifts.collect()
}

/// The quick motions of a trajectory: its difference from its mean by a Gaussian with the standard deviation `width`, in
/// frames. Beyond its ends the trajectory is continued by its image in the end point, so both ends are at 0.
fn quick_motions(trajectory: &[DVec3], width: f64) -> Vec<DVec3> {
    let reach = (REACH * width).ceil() as i64;
    let weight = |step: i64| (-0.5 * (step as f64 / width).powi(2)).exp();
    let sum: f64 = (-reach..=reach).map(weight).sum();
    let frames = 0..trajectory.len() as i64;
    let quick = |frame: i64| {
        let ways = (-reach..=reach).map(|step| (at(trajectory, frame + step) - at(trajectory, frame)) * weight(step));
        -ways.sum::<DVec3>() / sum
    };
    frames.map(quick).collect()
}

/// The place at a frame that may be beyond the ends, any number of images away.
fn at(trajectory: &[DVec3], frame: i64) -> DVec3 {
    let last = trajectory.len() as i64 - 1;
    let own = |frame: i64| trajectory[frame as usize];
    if last == 0 {
        return own(0);
    }
    // Two images in the ends one after the other are a shift by twice the way between the ends.
    let (shifts, frame) = (frame.div_euclid(2 * last), frame.rem_euclid(2 * last));
    let place = if frame <= last {
        own(frame)
    } else {
        2.0 * own(last) - own(2 * last - frame)
    };
    place + (own(last) - own(0)) * (2 * shifts) as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steady_motion_has_no_quick_part_and_the_ends_have_none_either() {
        let steady: Vec<DVec3> = (0..20)
            .map(|frame| DVec3::new(1.0, 0.5, -2.0) * f64::from(frame))
            .collect();
        assert!(quick_motions(&steady, 2.0).iter().all(|way| way.length() < 1e-12));
        let shaken: Vec<DVec3> = (0..20).map(|frame| DVec3::Y * f64::from(frame % 3)).collect();
        for width in [0.5, 3.0, 40.0] {
            let quick = quick_motions(&shaken, width);
            assert!(quick[0].length() < 1e-12 && quick[19].length() < 1e-12);
            assert!(quick.iter().all(|way| way.is_finite()));
        }
        assert_eq!(quick_motions(&[DVec3::X], 2.0), [DVec3::ZERO]);
    }

    #[test]
    fn without_its_quick_part_a_trajectory_bends_less() {
        let shaken: Vec<DVec3> = (0..40).map(|frame| DVec3::Y * (f64::from(frame) * 1.7).sin()).collect();
        let quick = quick_motions(&shaken, 2.0);
        let bend = |ways: &[DVec3]| {
            ways.windows(3)
                .map(|way| (way[0] - 2.0 * way[1] + way[2]).length())
                .sum::<f64>()
        };
        let moved = |gain: f64| -> Vec<DVec3> { shaken.iter().zip(&quick).map(|(a, b)| *a + *b * gain).collect() };
        assert!(bend(&moved(-1.0)) < 0.2 * bend(&shaken));
        assert!(bend(&moved(1.0)) > 1.8 * bend(&shaken));
    }
}
