use std::f64::consts::PI;

use glam::{DAffine3, DQuat, DVec2, DVec3};

use super::*;
use crate::{Model, SurfaceVertex, shapes};

fn joint_at(model: &Model, triangle: u32) -> Option<Joint> {
    let shape = Shape {
        triangles: &model.surface.triangles,
        topology: &model.topology,
        positions: &model.surface.positions,
    };
    let corners = model.surface.triangles[triangle as usize].map(|v| model.surface.positions[v.index()]);
    let middle = (corners[0] + corners[1] + corners[2]) / 3.0;
    joint_of(&shape, triangle, middle, 0, &Cancel::new()).unwrap()
}

/// A triangle at about this height, on any side.
fn triangle_at(model: &Model, z: f64, side: usize) -> u32 {
    let height = |triangle: &[SurfaceVertex; 3]| {
        let heights = triangle.map(|v| model.surface.positions[v.index()].z);
        heights.iter().sum::<f64>() / 3.0
    };
    let near: Vec<u32> = (0..model.surface.triangles.len() as u32)
        .filter(|&t| (height(&model.surface.triangles[t as usize]) - z).abs() < 0.1)
        .collect();
    near[side % near.len()]
}

/// The triangle whose middle is nearest to a point.
fn triangle_near(model: &Model, point: DVec3) -> u32 {
    let away = |t: &u32| {
        let corners = model.surface.triangles[*t as usize].map(|v| model.surface.positions[v.index()]);
        ((corners[0] + corners[1] + corners[2]) / 3.0).distance(point)
    };
    let all = 0..model.surface.triangles.len() as u32;
    all.min_by(|a, b| away(a).total_cmp(&away(b))).unwrap()
}

/// Two balls of radius 1 about z = 2 and z = -2 with a neck that is narrowest, 0.3, at z = `waist`.
fn dumbbell(rings: usize, waist: f64) -> Model {
    shapes::model(shapes::turned(rings, rings, |share| {
        let z = 3.0 * (PI * share).cos();
        let ball = (1.0 - (z.abs() - 2.0).powi(2)).max(0.0).sqrt();
        let neck = 0.3 + 0.12 * (z - waist).powi(2);
        let radius = if z.abs() > 2.0 { ball } else { ball.max(neck) };
        DVec2::new(if share % 1.0 == 0.0 { 0.0 } else { radius }, z)
    }))
}

#[test]
fn the_joint_of_a_dumbbell_is_its_waist_from_either_ball_and_from_every_side() {
    for (rings, waist) in [(48, 0.0), (80, 0.2), (80, -0.3)] {
        let model = dumbbell(rings, waist);
        let spacing = 3.0 * PI / rings as f64;
        for z in [2.9, 2.3, 1.9, -1.9, -2.3, -2.9] {
            for side in [0, 7, 23, 61] {
                let joint = joint_at(&model, triangle_at(&model, z, side)).unwrap();
                let case = format!("{rings} rings, waist {waist}, from {z} side {side}");
                assert!((joint.centre.z - waist).abs() < spacing, "{case}: {}", joint.centre);
                assert!(joint.centre.truncate().length() < 0.05, "{case}: {}", joint.centre);
                assert!((joint.radius - 0.3).abs() < 0.03, "{case}: {}", joint.radius);
                assert!(joint.axis.z * z.signum() > 0.98, "{case}: {}", joint.axis);
                for (v, p) in (0..).map(SurfaceVertex).zip(&model.surface.positions) {
                    let is_limb = joint.limb.binary_search(&v).is_ok();
                    let beyond = (p.z - waist) * z.signum();
                    assert!(beyond.abs() < spacing || is_limb == (beyond > 0.0), "{case}: {p}");
                    let is_far = joint.far_side.binary_search(&v).is_ok();
                    assert!(!is_far || is_limb, "{case}");
                }
            }
        }
    }
}

#[test]
fn rings_stand_at_even_distances_from_the_joint() {
    let model = dumbbell(96, 0.0);
    let joint = joint_at(&model, triangle_at(&model, 2.5, 3)).unwrap();
    for (number, ring) in joint.rings.iter().enumerate() {
        let share = number as f64 / 3.0 - 1.0;
        assert!(ring.len() >= 96, "{number}: {}", ring.len());
        for end in ring.iter().flatten() {
            // The neck is nearly straight there.
            assert!((end.z + share * joint.falloff).abs() < 0.06, "{number}: {end}");
        }
    }
}

#[test]
fn a_tube_with_a_narrow_waist_bends_there_and_motion_and_scale_change_nothing() {
    let profile = |share: f64| {
        let z = 6.0 * (1.0 - share);
        let radius = 0.5 - 0.2 * (-(z - 4.0).powi(2) / 0.2).exp();
        DVec2::new(if share % 1.0 == 0.0 { 0.0 } else { radius }, z)
    };
    let drawn = shapes::turned(120, 40, profile);
    let motion = DAffine3::from_scale_rotation_translation(
        DVec3::splat(30.0),
        DQuat::from_rotation_x(0.7) * DQuat::from_rotation_z(2.0),
        DVec3::new(1e3, -4e3, 7.0),
    );
    let model = shapes::model(drawn.clone());
    let moved = shapes::model(shapes::moved(&drawn, motion));
    for point in [DVec3::new(0.5, 0.0, 5.2), DVec3::new(0.0, -0.5, 5.8)] {
        let joint = joint_at(&model, triangle_near(&model, point)).unwrap();
        assert!((joint.centre.z - 4.0).abs() < 0.1, "{}", joint.centre);
        let same = joint_at(&moved, triangle_near(&moved, motion.transform_point3(point))).unwrap();
        assert!(same.centre.distance(motion.transform_point3(joint.centre)) < 30.0 * 0.05);
        assert!((same.radius / joint.radius / 30.0 - 1.0).abs() < 0.01);
        assert!(
            same.limb.len().abs_diff(joint.limb.len()) <= 40,
            "one ring of vertices at most"
        );
    }
}

#[test]
fn a_ball_and_a_sheet_have_no_joint_and_no_class_of_mesh_panics() {
    for drawn in [shapes::icosphere(4), shapes::grid(30, 30)] {
        let model = shapes::model(drawn);
        for triangle in (0..model.surface.triangles.len() as u32).step_by(97) {
            assert_eq!(joint_at(&model, triangle), None);
        }
    }
    for (class, drawn) in shapes::classes() {
        let model = shapes::model(drawn);
        for triangle in (0..model.surface.triangles.len() as u32).step_by(61) {
            let Some(joint) = joint_at(&model, triangle) else {
                continue;
            };
            let sizes = [joint.radius, joint.falloff];
            assert!(sizes.iter().all(|size| size.is_finite() && *size > 0.0), "{class}");
            assert!(
                joint.centre.is_finite() && (joint.axis.length() - 1.0).abs() < 1e-9,
                "{class}"
            );
            assert!(joint.far_side.len() <= joint.limb.len(), "{class}");
        }
    }
}

#[test]
fn a_raised_cancel_stops_the_search() {
    let model = dumbbell(48, 0.0);
    let shape = Shape {
        triangles: &model.surface.triangles,
        topology: &model.topology,
        positions: &model.surface.positions,
    };
    let cancel = Cancel::new();
    cancel.cancel();
    assert!(joint_of(&shape, 0, DVec3::Z, 0, &cancel).is_err());
}
