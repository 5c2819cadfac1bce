//! The limbs that a point on a scan means, and those beside them that a person can choose.

use glam::DVec3;
use pliant_mesh::{Cancel, Joint, Shape, face_area, joint_of};
use pliant_tests::{datum, try_open};

/// The joint at a place of a scan, and the share of the scan's area that its limb has; `None` without the scan.
fn joint_at(file: &str, at: [f64; 3], up: i32) -> Option<(Joint, f64)> {
    let loaded = try_open(&datum(file)?).unwrap();
    let model = &loaded.model;
    let shape = Shape {
        triangles: &model.surface.triangles,
        topology: &model.topology,
        positions: &model.surface.positions,
    };
    let (triangle, point) = shape.nearest(DVec3::from(at)).unwrap();
    let joint = joint_of(&shape, triangle, point, up, &Cancel::new()).unwrap().unwrap();
    let mut areas = [0.0; 2];
    for triangle in &model.surface.triangles {
        let area = face_area(triangle.map(|v| model.surface.positions[v.index()]));
        areas[usize::from(joint.limb.binary_search(&triangle[0]).is_ok())] += area;
    }
    Some((joint, areas[1] / (areas[0] + areas[1])))
}

#[test]
fn a_point_of_a_hand_means_the_hand_and_the_arm_is_farther() {
    const HAND: [f64; 3] = [-0.7522, 1.3277, -0.0281];
    let Some((hand, share)) = joint_at("scans/human_neutral.obj", HAND, 0) else {
        return;
    };
    // A wrist, in metres; a hand is about a fiftieth of a person's skin.
    assert!((0.02..0.03).contains(&hand.radius), "{}", hand.radius);
    assert!((0.015..0.03).contains(&share), "{share}");
    let part = joint_at("scans/human_neutral.obj", HAND, -1).unwrap();
    assert!(part.0.up == -1 && part.1 < share, "{}", part.1);
    let arm = joint_at("scans/human_neutral.obj", HAND, 2).unwrap();
    assert!((0.07..0.09).contains(&arm.1), "{}", arm.1);
}

#[test]
fn a_neck_as_wide_as_its_head_is_the_next_candidate() {
    const SKULL: [f64; 3] = [0.501, 0.859, 0.541];
    let Some((_, guess)) = joint_at("scans/homer.obj", SKULL, 0) else {
        return;
    };
    let (neck, share) = joint_at("scans/homer.obj", SKULL, 1).unwrap();
    assert_eq!(neck.up, 1);
    assert!(share > 1.15 * guess && share < 0.2, "{guess}, {share}");
    // The chin, below the mouth.
    assert!((0.72..0.77).contains(&neck.centre.y), "{}", neck.centre);
}
