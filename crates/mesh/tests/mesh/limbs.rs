//! Joints of limbs that are as thick as they are long.
#![allow(clippy::unwrap_used, reason = "a test that can't go on fails")]

use std::f64::consts::PI;
use std::ops::Range;

use glam::DVec2;
use pliant_mesh::{Cancel, Drawn, Joint, Model, Shape, SurfaceVertex, joint_of, shapes};

/// A triangle at about this height, on any side, and its middle.
fn triangle_at(model: &Model, z: f64, side: usize) -> (u32, glam::DVec3) {
    let middle = |t: u32| {
        let corners = model.surface.triangles[t as usize].map(|v: SurfaceVertex| model.surface.positions[v.index()]);
        (corners[0] + corners[1] + corners[2]) / 3.0
    };
    let all = 0..model.surface.triangles.len() as u32;
    let near: Vec<u32> = all.filter(|&t| (middle(t).z - z).abs() < 0.1).collect();
    let chosen = near[side % near.len()];
    (chosen, middle(chosen))
}

/// Checks a joint that was found from a height and side: its height, its radius, and that it points up.
fn assert_upright(joint: &Joint, (z, side): (f64, usize), heights: Range<f64>, radius: f64) {
    let from = format!("from {z}, side {side}");
    assert!(heights.contains(&joint.centre.z), "{from}: {}", joint.centre);
    assert!((joint.radius - radius).abs() < 0.05, "{from}: {}", joint.radius);
    assert!(joint.axis.z > 0.95, "{from}: {}", joint.axis);
}

#[test]
fn a_limb_that_is_as_thick_as_it_is_long_bends_where_it_meets_the_body() {
    // A ball of radius 1 about 0 with a stump that widens from 0.45 at the ball to 0.5 and ends at z = 2.2.
    let profile = |share: f64| {
        let z = 0.6 + 1.6 * (PI * share).cos();
        let stump = (0.45 + 0.06 * (z - 0.9)) * (1.0 - ((z - 1.7).max(0.0) / 0.5).powi(2)).max(0.0).sqrt();
        let ball = (1.0 - z * z).max(0.0).sqrt();
        DVec2::new(if share % 1.0 == 0.0 { 0.0 } else { ball.max(stump) }, z)
    };
    let model = shapes::model(shapes::turned(72, 72, profile));
    let shape = Shape {
        triangles: &model.surface.triangles,
        topology: &model.topology,
        positions: &model.surface.positions,
    };
    for z in [2.1, 1.8, 1.5, 1.2] {
        for side in [0, 5, 31] {
            let (triangle, middle) = triangle_at(&model, z, side);
            let joint = joint_of(&shape, triangle, middle, 0, &Cancel::new()).unwrap();
            let joint = joint.unwrap_or_else(|| panic!("no joint from {z}, side {side}"));
            assert_upright(&joint, (z, side), 0.7..1.4, 0.46);
        }
    }
}

/// The joint under a triangle.
fn joint_at(model: &Model, place: (u32, glam::DVec3)) -> Option<Joint> {
    candidate_at(model, place, 0)
}

/// The candidate `up` of the joint under a triangle.
fn candidate_at(model: &Model, (triangle, middle): (u32, glam::DVec3), up: i32) -> Option<Joint> {
    let shape = Shape {
        triangles: &model.surface.triangles,
        topology: &model.topology,
        positions: &model.surface.positions,
    };
    joint_of(&shape, triangle, middle, up, &Cancel::new()).unwrap()
}

/// Turned about the z axis from `top` to `bottom`, with closed ends.
fn turned(top: f64, bottom: f64, radius: impl Fn(f64) -> f64) -> Drawn {
    shapes::turned(90, 60, |share| {
        let z = 0.5 * (top + bottom) + 0.5 * (top - bottom) * (PI * share).cos();
        DVec2::new(if share % 1.0 == 0.0 { 0.0 } else { radius(z).max(1e-3) }, z)
    })
}

#[test]
fn the_head_of_a_bust_is_a_limb_though_it_is_larger_than_the_rest() {
    // A ball of radius 1 on a neck of 0.25 on a ball of radius 0.55.
    let ball = |z: f64, radius: f64| (radius * radius - z * z).max(0.0).sqrt();
    let profile = |z: f64| {
        let neck = if (-0.9..1.2).contains(&z) { 0.25 } else { 0.0 };
        ball(z - 1.2, 1.0).max(ball(z + 0.9, 0.55)).max(neck)
    };
    let model = shapes::model(turned(2.2, -1.45, profile));
    for z in [2.1, 1.7, 1.2, 0.7] {
        for side in [0, 11, 37] {
            let joint = joint_at(&model, triangle_at(&model, z, side));
            let joint = joint.unwrap_or_else(|| panic!("no joint from {z}, side {side}"));
            assert!((-0.45..0.3).contains(&joint.centre.z), "from {z}: {}", joint.centre);
            assert!((joint.radius - 0.25).abs() < 0.03, "from {z}: {}", joint.radius);
            assert!(joint.axis.z > 0.95, "from {z}: {}", joint.axis);
            // Most of the head keeps its shape.
            let head = |v: &&SurfaceVertex| model.surface.positions[v.index()].z > 0.7;
            let of_head = model.surface.positions.iter().filter(|p| p.z > 0.7).count();
            assert_eq!(
                joint.far_side.iter().filter(head).count(),
                of_head,
                "from {z}, side {side}"
            );
        }
    }
}

#[test]
fn the_tip_of_an_ear_leads_to_its_root() {
    // An ear on a ball of radius 1 widens all the way from its tip at z = 2 to its root, where its radius is 0.22.
    let ball = |z: f64| (1.0 - z * z).max(0.0).sqrt();
    let ear = |z: f64| if z > 0.8 { 0.22 * (2.0 - z).powf(0.6) } else { 0.0 };
    let model = shapes::model(turned(2.0, -1.0, |z| ball(z).max(ear(z))));
    for side in [0, 9, 23, 40] {
        let joint = joint_at(&model, triangle_at(&model, 2.09, side));
        let joint = joint.unwrap_or_else(|| panic!("no joint from side {side}"));
        assert!((0.9..1.3).contains(&joint.centre.z), "side {side}: {}", joint.centre);
        assert!(joint.axis.z > 0.95, "side {side}: {}", joint.axis);
    }
}

#[test]
fn a_tail_like_half_a_ball_leads_to_the_crease_around_it() {
    // A ball of radius 0.3 half out of a ball of radius 1: no ring on it is narrower than those beside it.
    let ball = |z: f64, radius: f64| (radius * radius - z * z).max(0.0).sqrt();
    let model = shapes::model(turned(1.27, -1.0, |z| ball(z, 1.0).max(ball(z - 0.97, 0.3))));
    for z in [1.24, 1.2, 1.12] {
        for side in [0, 11, 37] {
            let joint = joint_at(&model, triangle_at(&model, z, side));
            let joint = joint.unwrap_or_else(|| panic!("no joint from {z}, side {side}"));
            // The crease is at 0.95; half a radius beside it is still on the tail.
            assert_upright(&joint, (z, side), 0.8..1.12, 0.3);
        }
    }
}

#[test]
fn other_parts_do_not_hide_a_limb() {
    let profile = |share: f64| {
        let z = 3.0 * (PI * share).cos();
        let ball = (1.0 - (z.abs() - 2.0).powi(2)).max(0.0).sqrt();
        let radius = if z.abs() > 2.0 {
            ball
        } else {
            ball.max(0.3 + 0.12 * z * z)
        };
        DVec2::new(if share % 1.0 == 0.0 { 0.0 } else { radius }, z)
    };
    let body = shapes::turned(60, 40, profile);
    let mut eye = shapes::icosphere(2);
    eye.positions
        .iter_mut()
        .for_each(|p| *p = *p * 0.2 + glam::DVec3::new(0.0, 0.8, 2.5));
    let joint = |model: &Model| {
        let (triangle, middle) = triangle_at(model, 2.4, 3);
        let shape = Shape {
            triangles: &model.surface.triangles,
            topology: &model.topology,
            positions: &model.surface.positions,
        };
        joint_of(&shape, triangle, middle, 0, &Cancel::new()).unwrap()
    };
    let (alone, with_eye) = (
        shapes::model(body.clone()),
        shapes::model(shapes::together(&[body, eye])),
    );
    let (alone, with_eye) = (joint(&alone).unwrap(), joint(&with_eye).unwrap());
    assert!(alone.centre.distance(with_eye.centre) < 1e-9, "{}", with_eye.centre);
    assert_eq!(alone.limb.len(), with_eye.limb.len());
}

#[test]
fn a_finger_leads_to_its_hand_and_the_candidate_before_the_guess_is_its_own() {
    // A finger of 0.03 on an arm of 0.2 on a ball of radius 1.
    let model = shapes::model(turned(2.7, -1.0, |z| {
        let ball = (1.0 - z * z).max(0.0).sqrt();
        let part = |radius: f64, length: f64| {
            let rest = (length - z).max(0.0);
            if rest < radius {
                (rest * (2.0 * radius - rest)).sqrt()
            } else {
                radius
            }
        };
        ball.max(part(0.2, 2.4)).max(part(0.03, 2.7))
    }));
    for side in [0, 7, 19] {
        let place = triangle_at(&model, 2.62, side);
        let guess = joint_at(&model, place).unwrap();
        assert_upright(&guess, (2.62, side), 0.8..2.2, 0.2);
        let finger = candidate_at(&model, place, -1).unwrap();
        assert_eq!((guess.up, finger.up), (0, -1));
        assert_upright(&finger, (2.62, side), 2.3..2.5, 0.03);
        // There are no more on that side.
        assert_eq!(candidate_at(&model, place, -5).unwrap(), finger);
    }
}

#[test]
fn a_ring_across_a_palm_is_no_wrist() {
    // Fingers as one of 0.22 on a palm of 0.34, a wrist of 0.14, an arm of 0.24 and a ball of radius 1.
    let model = shapes::model(turned(3.4, -1.0, |z| {
        let ball = (1.0 - z * z).max(0.0).sqrt();
        let tip = (3.4 - z).clamp(0.0, 0.22);
        let fingers = (tip * (0.44 - tip)).sqrt();
        let bump = |at: f64, height: f64, width: f64| height * (-((z - at) / width).powi(2)).exp();
        let limb = if z < 3.0 { 0.22 } else { fingers };
        ball.max(limb + bump(2.55, 0.12, 0.14) - bump(2.1, 0.08, 0.18) + bump(1.5, 0.02, 0.3))
    }));
    for side in [0, 7, 19] {
        let place = triangle_at(&model, 3.1, side);
        let guess = joint_at(&model, place).unwrap();
        assert_upright(&guess, (3.1, side), 1.9..2.3, 0.14);
    }
}
