//! The laws of curves, of their frames and of motions along them.
#![allow(clippy::unwrap_used, reason = "tests")]

use std::f64::consts::{PI, TAU};

use glam::{DAffine3, DMat3, DQuat, DVec3};
use pliant_mesh::{
    BendRange, Curve, CurveMotion, CurvePath, CurveRefused, FREE_BEND, JointLimits, pulled_chain, pulled_within,
};

/// Open and closed curves, in a plane and out of it, evenly and unevenly spaced.
fn curves() -> Vec<Curve> {
    let line = (0..5).map(|i| DVec3::new(0.3, -1.0, f64::from(i * i) + 2.0)).collect();
    let helix = (0..9)
        .map(|i| f64::from(i) * 0.7)
        .map(|a| DVec3::new(a.cos(), a.sin(), 0.4 * a));
    let bow = vec![
        DVec3::ZERO,
        DVec3::X,
        DVec3::new(1.2, 0.3, 0.0),
        DVec3::new(1.3, 2.0, 0.0),
    ];
    let ring = |wave: f64| {
        let at = move |i: i32| {
            let a = f64::from(i) * TAU / 12.0;
            DVec3::new(3.0 * a.cos(), 2.0 * a.sin(), wave * (2.0 * a + 0.4).sin())
        };
        (0..12).map(at).collect()
    };
    let open = [line, helix.collect(), bow, vec![DVec3::ONE, DVec3::NEG_X]];
    let open = open.map(|points: Vec<DVec3>| Curve::new(points, false).unwrap());
    let closed = [ring(0.0), ring(1.0)].map(|points: Vec<DVec3>| Curve::new(points, true).unwrap());
    open.into_iter().chain(closed).collect()
}

/// Points around a curve.
fn around(curve: &Curve) -> Vec<DVec3> {
    let radius = 0.1 * curve.length();
    let each = curve
        .station_places()
        .step_by(7)
        .map(|place| curve.position(place))
        .enumerate();
    each.map(|(i, on)| on + radius * DVec3::new((i as f64).sin(), (2.0 * i as f64).cos(), (0.7 * i as f64).sin()))
        .collect()
}

fn plain(curve: &Curve) -> (Vec<f64>, Vec<f64>) {
    let count = curve.points().len();
    (vec![0.0; count], vec![1.0; count])
}

fn motion(rest: &Curve, moves: impl Fn(DVec3) -> DVec3) -> CurveMotion {
    let (twist, scale) = plain(rest);
    let moved = rest.points().iter().map(|point| moves(*point)).collect();
    CurveMotion::new(rest.clone(), moved, &twist, &scale).unwrap()
}

/// The curve with a further control point half way in each segment.
fn refined(curve: &Curve) -> Curve {
    let places = curve.point_places();
    let halves = places.windows(2).map(|pair| curve.position(0.5 * (pair[0] + pair[1])));
    let points = curve.points().iter().copied();
    let mut all = Vec::new();
    let mut halves = halves;
    for point in points {
        all.push(point);
        all.extend(halves.next());
    }
    Curve::new(all, curve.is_closed()).unwrap()
}

/// A point of the circle of `radius` that leaves the origin along x and turns towards y.
fn on_arc(radius: f64, length: f64) -> DVec3 {
    let angle = length / radius;
    radius * DVec3::new(angle.sin(), 1.0 - angle.cos(), 0.0)
}

/// A straight curve of length 10 from the origin along x, its end turned by `angle` about z, its length kept.
fn arc(angle: f64, count: usize) -> CurveMotion {
    let length = |i: usize| 10.0 * i as f64 / (count - 1) as f64;
    let rest = Curve::new((0..count).map(|i| DVec3::X * length(i)).collect(), false).unwrap();
    motion(&rest, |p| on_arc(10.0 / angle, p.x))
}

#[test]
fn places_are_lengths_and_the_curve_passes_through_its_points() {
    for curve in curves() {
        let places = curve.point_places();
        assert_eq!(places[0], 0.0);
        assert_eq!(*places.last().unwrap(), curve.length());
        for (place, point) in places.iter().zip(curve.points()) {
            assert!(curve.position(*place).distance(*point) < 1e-12 * curve.length());
        }
        // A polyline of many chords is as long.
        let count = 20_000;
        let at = |i: usize| curve.position(curve.length() * i as f64 / f64::from(count as u32));
        let chords: Vec<f64> = (0..count).map(|i| at(i).distance(at(i + 1))).collect();
        let sum: f64 = chords.iter().sum();
        assert!(
            (sum - curve.length()).abs() < 1e-6 * curve.length(),
            "{sum} {}",
            curve.length()
        );
        let step = curve.length() / count as f64;
        assert!(chords.iter().all(|chord| (chord - step).abs() < 1e-3 * step));
    }
}

#[test]
fn frames_are_orthonormal_follow_the_tangent_and_do_not_turn_about_it() {
    for curve in curves() {
        let step = 1e-4 * curve.length();
        for i in 1..50 {
            let place = curve.length() * f64::from(i) / 50.0;
            let frame = curve.frame(place);
            assert!((frame * frame.transpose()).abs_diff_eq(DMat3::IDENTITY, 1e-12));
            assert!(frame.determinant() > 0.0);
            let way = (curve.position(place + step) - curve.position(place - step)).normalize();
            assert!(way.distance(frame.z_axis) < 1e-3, "{way} {}", frame.z_axis);
            let turn = (curve.frame(place + step).x_axis - curve.frame(place - step).x_axis).dot(frame.y_axis);
            // Only a closed curve's frames turn, evenly, by at most half a turn altogether.
            let most = if curve.is_closed() { PI } else { 1e-3 };
            assert!(turn.abs() / (2.0 * step) * curve.length() < most, "{turn}");
        }
        if curve.is_closed() {
            assert!(curve.frame(0.0).abs_diff_eq(curve.frame(curve.length()), 1e-9));
        }
    }
}

#[test]
fn the_nearest_place_is_nearer_than_all_others() {
    for curve in curves() {
        for point in around(&curve) {
            let place = curve.nearest(point);
            let found = curve.position(place).distance(point);
            for i in 0..=400 {
                let other = curve.position(curve.length() * f64::from(i) / 400.0).distance(point);
                assert!(found <= other + 1e-9 * curve.length());
            }
            let arm = (point - curve.position(place)).dot(curve.frame(place).z_axis);
            let is_end = !curve.is_closed() && (place == 0.0 || place == curve.length());
            assert!(is_end || arm.abs() < 1e-9 * curve.length(), "{arm}");
        }
    }
}

#[test]
fn a_curve_that_moves_rigidly_moves_everything_rigidly() {
    let turns = [0.0, 0.3, 1.5, 3.0, PI];
    for curve in curves() {
        for (index, angle) in turns.into_iter().enumerate() {
            let axis = DVec3::new(0.2, -0.5, 0.3 + index as f64).normalize();
            let map =
                DAffine3::from_rotation_translation(DQuat::from_axis_angle(axis, angle), DVec3::new(0.4, 2.0, -1.0));
            let is_straight = curve.points().len() == 2 || curve.points().iter().all(|p| p.x == 0.3);
            // Nothing tells how far a straight curve turned about itself: it has the smallest turn.
            let tangent = curve.frame(0.0).z_axis;
            let map = match is_straight {
                true => DAffine3::from_rotation_translation(
                    DQuat::from_rotation_arc(tangent, map.transform_vector3(tangent)),
                    map.translation,
                ),
                false => map,
            };
            for curve in [curve.clone(), refined(&curve)] {
                let moves = motion(&curve, |p| map.transform_point3(p));
                for point in around(&curve) {
                    let found = point + moves.displacement(point);
                    let wanted = map.transform_point3(point);
                    assert!(
                        found.distance(wanted) < 1e-12 * curve.length(),
                        "{:e}",
                        found.distance(wanted)
                    );
                    assert!(moves.map(point).abs_diff_eq(map, 1e-11));
                }
            }
        }
    }
}

#[test]
fn control_points_at_rest_move_nothing_to_the_bit() {
    for curve in curves() {
        let still = motion(&curve, |p| p);
        assert!(still.is_rest());
        assert!(around(&curve).into_iter().all(|p| still.displacement(p) == DVec3::ZERO));
    }
}

#[test]
fn the_surroundings_of_still_control_points_are_still() {
    let points: Vec<DVec3> = (0..9)
        .map(|i| DVec3::new(0.1 * f64::from(i * i % 5), 0.2 * f64::from(i % 3), f64::from(i)))
        .collect();
    let curve = Curve::new(points, false).unwrap();
    let bend = |p: DVec3| {
        if p.z > 4.5 {
            p + (p.z - 4.5) * DVec3::new(0.7, -0.3, 0.1)
        } else {
            p
        }
    };
    let moves = motion(&curve, bend);
    for point in [DVec3::new(0.8, 0.0, 1.0), DVec3::new(-0.4, 0.9, 1.6)] {
        assert!(moves.displacement(point).length() < 1e-9);
    }
}

#[test]
fn a_straight_curve_bent_to_an_arc_keeps_its_length_and_its_sections() {
    for degrees in [10.0_f64, 90.0, 180.0, 250.0, 300.0] {
        let angle = degrees.to_radians();
        let moves = arc(angle, 25);
        let radius = 10.0 / angle;
        for i in 0..=100 {
            let x = f64::from(i) / 10.0;
            for arm in [DVec3::ZERO, DVec3::Y, DVec3::Z, DVec3::new(0.0, -0.6, 0.8)] {
                let found = DVec3::X * x + arm + moves.displacement(DVec3::X * x + arm);
                let wanted = on_arc(radius, x) + DQuat::from_rotation_z(x / radius) * arm;
                assert!(
                    found.distance(wanted) < 1e-3,
                    "{degrees} {x} {arm}: {:e}",
                    found.distance(wanted)
                );
            }
        }
        let way = CurvePath::of(&moves);
        assert!((way.largest_turn_rad() - angle).abs() < 0.1 * angle);
        // Half way it is the arc of half the angle.
        let still = way.points_at(0.5)[0];
        for (point, i) in way.points_at(0.5).iter().zip(0..) {
            let wanted = on_arc(2.0 * radius, 10.0 * f64::from(i) / 24.0);
            assert!((*point - still).distance(wanted) < 0.02, "{degrees}: {point} {wanted}");
        }
    }
}

#[test]
fn twist_and_scale_are_those_of_the_control_points_and_full_turns_count() {
    let rest = Curve::new((0..5).map(|i| DVec3::Z * f64::from(i)).collect(), false).unwrap();
    let twist = [0.0, 90.0, 180.0, 270.0, 360.0];
    let scale = [1.0, 1.0, 2.0, 2.0, 0.5];
    let moves = CurveMotion::new(rest.clone(), rest.points().to_vec(), &twist, &scale).unwrap();
    for i in 0..=40 {
        let z = f64::from(i) / 10.0;
        let found = DVec3::new(1.0, 0.0, z) + moves.displacement(DVec3::new(1.0, 0.0, z));
        let angle = TAU * z / 4.0;
        let arm = found - DVec3::Z * z;
        assert!(arm.normalize().distance(DVec3::new(angle.cos(), angle.sin(), 0.0)) < 1e-12);
        assert!((0.5 - 1e-12..=2.0 + 1e-12).contains(&arm.length()));
        if let Some(scale) = scale.get((i / 10) as usize).filter(|_| i % 10 == 0) {
            assert!((arm.length() - scale).abs() < 1e-12);
        }
    }
    assert!((CurvePath::of(&moves).largest_turn_rad() - TAU).abs() < 1e-12);
}

#[test]
fn a_way_ends_at_its_ends_and_nothing_shrinks_on_it() {
    for curve in curves() {
        let map = DAffine3::from_rotation_translation(DQuat::from_axis_angle(DVec3::Y, PI), DVec3::new(3.0, 0.0, 1.0));
        let way = CurvePath::of(&motion(&curve, |p| map.transform_point3(p)));
        assert_eq!(way.points_at(0.0), curve.points());
        assert_eq!(
            way.points_at(1.0),
            curve
                .points()
                .iter()
                .map(|p| map.transform_point3(*p))
                .collect::<Vec<_>>()
        );
        for t in [0.25, 0.5, 0.75] {
            let points = way.points_at(t);
            for (new, old) in points.windows(2).zip(curve.points().windows(2)) {
                let (new, old) = (new[0].distance(new[1]), old[0].distance(old[1]));
                assert!((new - old).abs() < 1e-9 * old, "{new} {old}");
            }
        }
    }
}

#[test]
fn points_that_make_no_curve_are_refused() {
    let line = || (0..4).map(|i| DVec3::X * f64::from(i)).collect::<Vec<_>>();
    let refused = |points: Vec<DVec3>, is_closed| Curve::new(points, is_closed).unwrap_err();
    assert_eq!(
        refused(vec![DVec3::X], false),
        CurveRefused::TooFew { found: 1, least: 2 }
    );
    assert_eq!(
        refused(vec![DVec3::X, DVec3::Y], true),
        CurveRefused::TooFew { found: 2, least: 3 }
    );
    let mut wrong = line();
    wrong[2].y = f64::NAN;
    assert_eq!(refused(wrong.clone(), false), CurveRefused::NotFinite { point: 2 });
    wrong[2] = wrong[1];
    assert_eq!(refused(wrong, false), CurveRefused::Equal { point: 1, next: 2 });
    let ring = vec![DVec3::X, DVec3::Y, DVec3::Z, DVec3::X];
    assert_eq!(refused(ring, true), CurveRefused::Equal { point: 3, next: 0 });
    let rest = Curve::new(line(), false).unwrap();
    let (twist, scale) = plain(&rest);
    let move_by = |moved: Vec<DVec3>, twist: &[f64], scale: &[f64]| {
        CurveMotion::new(rest.clone(), moved, twist, scale).unwrap_err()
    };
    assert!(matches!(
        move_by(line()[1..].to_vec(), &twist, &scale),
        CurveRefused::Count { .. }
    ));
    assert!(matches!(
        move_by(line(), &[f64::NAN; 4], &scale),
        CurveRefused::Twist { .. }
    ));
    assert!(matches!(move_by(line(), &twist, &[0.0; 4]), CurveRefused::Scale { .. }));
}

#[test]
fn a_pulled_chain_keeps_its_lengths_and_arrives_where_it_can() {
    let chains: [Vec<DVec3>; 3] = [
        (0..6).map(|i| DVec3::X * f64::from(i)).collect(),
        (0..9)
            .map(|i| DVec3::new(f64::from(i), f64::from(i * i % 4), 0.3 * f64::from(i % 2)))
            .collect(),
        vec![DVec3::ZERO, DVec3::Y * 2.0, DVec3::new(0.5, 3.0, 0.0)],
    ];
    for chain in chains {
        let lengths = |points: &[DVec3]| {
            points
                .windows(2)
                .map(|pair| pair[0].distance(pair[1]))
                .collect::<Vec<f64>>()
        };
        let whole: f64 = lengths(&chain).iter().sum();
        let rays = [DVec3::X, DVec3::Y, DVec3::NEG_X, DVec3::new(0.48, -0.6, 0.64)];
        for (ray, share) in rays
            .into_iter()
            .flat_map(|ray| [0.5, 0.8, 0.95, 0.999, 1.0, 1.7].map(|share| (ray, share)))
        {
            let target = chain[0] + ray * (share * whole);
            let pulled = pulled_chain(&chain, target);
            assert_eq!(pulled[0], chain[0]);
            for (new, old) in lengths(&pulled).iter().zip(lengths(&chain)) {
                assert!((new - old).abs() < 1e-9 * whole);
            }
            let missed = pulled[pulled.len() - 1].distance(target);
            assert!(
                (missed - whole * (share - 1.0).max(0.0)).abs() < 1e-6 * whole,
                "{share}: {missed:e}"
            );
        }
        assert_eq!(pulled_chain(&chain, chain[chain.len() - 1]), chain);
    }
}

/// The bends of a chain's joints, the first one after a segment in the direction `before`.
fn bends(chain: &[DVec3], before: Option<DVec3>) -> Vec<f64> {
    let ways = chain.windows(2).map(|pair| pair[1] - pair[0]);
    let ways: Vec<DVec3> = before.into_iter().chain(ways).collect();
    ways.windows(2).map(|pair| pair[0].angle_between(pair[1])).collect()
}

#[test]
fn a_pulled_chain_with_limits_bends_within_them_keeps_its_lengths_and_follows_a_way_of_allowed_poses() {
    // A leg: a hip, a knee that is never straight, and an ankle; and a tail that bends little everywhere.
    let leg = vec![
        DVec3::ZERO,
        DVec3::new(0.3, -2.0, 0.0),
        DVec3::new(-0.2, -3.8, 0.1),
        DVec3::new(0.6, -4.0, 0.1),
    ];
    let tail: Vec<DVec3> = (0..9)
        .map(|i| DVec3::new(f64::from(i), 0.02 * f64::from(i * i), 0.0))
        .collect();
    let leg_bends: Vec<BendRange> = vec![[0.0, 1.2], [0.1, 2.4], [0.3, 1.8], FREE_BEND];
    let tail_bends: Vec<BendRange> = vec![[0.0, 0.35]; 9];
    for (chain, allowed, before) in [(leg, leg_bends, DVec3::NEG_Y), (tail, tail_bends, DVec3::X)] {
        let lengths =
            |points: &[DVec3]| -> Vec<f64> { points.windows(2).map(|pair| pair[0].distance(pair[1])).collect() };
        let whole: f64 = lengths(&chain).iter().sum();
        for before in [None, Some(before)] {
            let limits = JointLimits {
                bends: &allowed,
                before,
            };
            let allowed = &allowed[usize::from(before.is_none())..];
            let within = |points: &[DVec3], case: &str| {
                assert_eq!(points[0], chain[0], "{case}");
                for (new, old) in lengths(points).iter().zip(lengths(&chain)) {
                    assert!((new - old).abs() < 1e-9 * whole, "{case}: {new} {old}");
                }
                for (bend, [least, most]) in bends(points, before).into_iter().zip(allowed) {
                    assert!(
                        (least - 1e-9..=most + 1e-9).contains(&bend),
                        "{case}: {bend} beyond {least} to {most}"
                    );
                }
            };
            within(&chain, "at rest");
            // Targets anywhere, most of them out of reach.
            for number in 0..40 {
                let turn = 2.4 * f64::from(number);
                let ray = DVec3::new(turn.cos(), turn.sin(), 1.0 - f64::from(number) / 20.0).normalize();
                let target = chain[0] + ray * (whole * 0.07 * f64::from(number % 17));
                within(&pulled_within(&chain, target, limits), &format!("{number}"));
            }
            // Every joint goes over its whole range, and the chain follows the end of such poses from where it is.
            let mut follows = chain.clone();
            for step in 0..=24 {
                let share = 0.5 - 0.5 * (f64::from(step) / 24.0 * TAU).cos();
                let bend = |[least, most]: BendRange| least + (0.1 + 0.8 * share) * (most - least);
                let mut way = before.unwrap_or(chain[1] - chain[0]).normalize();
                let mut pose = vec![chain[0]];
                for (joint, length) in lengths(&chain).into_iter().enumerate() {
                    if joint > 0 || before.is_some() {
                        let angle = bend(limits.bends[joint]).min(0.9);
                        way = DQuat::from_axis_angle(DVec3::new(0.1, 0.2, 1.0).cross(way).normalize(), angle) * way;
                    }
                    pose.push(pose[joint] + way * length);
                }
                let target = pose[pose.len() - 1];
                follows = pulled_within(&follows, target, limits);
                let missed = follows[follows.len() - 1].distance(target);
                within(&follows, &format!("step {step}"));
                assert!(missed < 1e-6 * whole, "step {step}: {missed:e}");
            }
        }
    }
}

/// A sequence of numbers that looks random (splitmix64).
struct Random(u64);

impl Random {
    /// A number from 0 to 1.
    fn share(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut mixed = self.0;
        mixed = (mixed ^ (mixed >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        (mixed ^ (mixed >> 31)) as f64 / u64::MAX as f64
    }

    fn direction(&mut self) -> DVec3 {
        let (turn, height) = (TAU * self.share(), 2.0 * self.share() - 1.0);
        let radius = (1.0 - height * height).sqrt();
        DVec3::new(radius * turn.cos(), radius * turn.sin(), height)
    }
}

#[test]
fn narrow_limits_keep_hardly_a_chain_from_what_another_pose_reaches() {
    let mut random = Random(7);
    let (mut count, mut missed) = (0, 0);
    for segments in [2, 3, 4, 6, 9] {
        for number in 0..60 {
            // Ranges of 6 to 24 degrees, some of which begin at a straight joint.
            let bends: Vec<BendRange> = (0..=segments)
                .map(|_| {
                    let least = if number % 2 == 0 { 0.0 } else { random.share() };
                    [least, least + 0.1 + 0.3 * random.share()]
                })
                .collect();
            let lengths: Vec<f64> = (0..segments).map(|_| 0.5 + random.share()).collect();
            let before = (number % 3 == 0).then_some(DVec3::X);
            let mut pose = || {
                let mut points = vec![DVec3::ZERO];
                let mut along = before;
                for (length, [least, most]) in lengths.iter().zip(&bends) {
                    let ray = random.direction();
                    let way = along.map_or(ray, |along| {
                        let across = ray.reject_from(along).normalize_or(along.any_orthonormal_vector());
                        let bend = least + (most - least) * random.share();
                        (along * bend.cos() + across * bend.sin()).normalize()
                    });
                    points.push(points[points.len() - 1] + way * *length);
                    along = Some(way);
                }
                points
            };
            let (from, to) = (pose(), pose());
            let limits = JointLimits { bends: &bends, before };
            let pulled = pulled_within(&from, to[segments], limits);
            let whole: f64 = lengths.iter().sum();
            count += 1;
            missed += usize::from(pulled[segments].distance(to[segments]) > 1e-6 * whole);
        }
    }
    assert!(missed * 100 <= count, "{missed} of {count}");
}

#[test]
fn a_chain_without_limits_is_pulled_to_the_bit_as_with_free_ones() {
    let chain: Vec<DVec3> = (0..7)
        .map(|i| DVec3::new(f64::from(i), f64::from(i % 3), 0.2 * f64::from(i % 2)))
        .collect();
    let bends = [FREE_BEND; 7];
    let limits = JointLimits {
        bends: &bends,
        before: Some(DVec3::Y),
    };
    for target in [DVec3::new(2.0, 1.0, 3.0), DVec3::new(40.0, 0.0, 0.0)] {
        assert_eq!(pulled_within(&chain, target, limits), pulled_chain(&chain, target));
    }
}

#[test]
fn a_place_at_a_control_point_has_the_frame_of_the_places_beside_it() {
    let points: Vec<DVec3> = (0..25).map(|i| DVec3::new(f64::from(i), 1.0, 1.0)).collect();
    let rest = Curve::new(points.clone(), false).unwrap();
    for degrees in [27.0_f64, 81.0, 135.0, 189.0, 243.0, 300.0] {
        let radius = 24.0 / degrees.to_radians();
        let on_arc = |p: &DVec3| {
            let (sine, cosine) = (p.x / radius).sin_cos();
            DVec3::new(radius * sine, 1.0 + radius * (1.0 - cosine), 1.0)
        };
        let (twist, scale) = plain(&rest);
        let bent = CurveMotion::new(rest.clone(), points.iter().map(on_arc).collect(), &twist, &scale).unwrap();
        let path = CurvePath::of(&bent);
        for share in [0.1, 0.3, 0.5, 0.7, 0.9, 1.0] {
            let part = CurveMotion::new(rest.clone(), path.points_at(share), &twist, &scale).unwrap();
            for place in 0..=24 {
                let turn = part.turn_at(f64::from(place));
                let wanted = DQuat::from_rotation_z(share * f64::from(place) / radius);
                assert!(turn.dot(wanted).abs() > 0.999, "{degrees} {share} {place}: {turn}");
            }
        }
    }
}
