//! What is said where a handle turns by more than a method follows.

use std::f64::consts::PI;

use glam::DAffine3;
use pliant_deform::{Method, Role};
use pliant_mesh::shapes;

use crate::rig::Scene;

/// What the method says of a limb whose end turns about the limb.
fn said(name: &str, degrees: f64, fixed: bool) -> Vec<String> {
    let mut scene = Scene::new(shapes::tube(10, 16, 5.0)).with(Role::Handle(0), |p| p.z > 4.5);
    scene = match fixed {
        true => scene.with(Role::Fixed, |p| p.z < 0.5),
        false => scene.with(Role::Handle(1), |p| p.z < 0.5),
    };
    scene.method = Method::from_name(name).unwrap();
    let mut bound = scene.bind();
    let turn = DAffine3::from_rotation_z(degrees * PI / 180.0);
    // Where nothing is fixed both ends turn alike.
    bound.set_targets(&vec![turn; scene.handle_count]).unwrap();
    let about = |said: &&pliant_deform::Warning| said.contains("turns by");
    bound.warnings().iter().filter(about).map(ToString::to_string).collect()
}

#[test]
fn methods_that_narrow_a_limb_between_large_turns_say_so_and_name_others() {
    for (name, follows, gives_way) in [
        ("bilaplacian", 90.0, 120.0),
        ("rbf", 90.0, 120.0),
        ("mls", 90.0, 120.0),
        ("lattice", 90.0, 120.0),
        ("cage", 90.0, 120.0),
        ("embedded", 150.0, 175.0),
        ("wrinkles", 90.0, 120.0),
    ] {
        assert!(said(name, follows, true).is_empty(), "{name}");
        for turn in [gives_way, -gives_way, 180.0] {
            let said = said(name, turn, true);
            assert!(
                said.len() == 1 && said[0].contains(name) && said[0].contains("arap"),
                "{name} {said:?}"
            );
        }
        assert!(
            said(name, 180.0, false).is_empty(),
            "{name}: what all turns is not narrowed"
        );
    }
    for name in ["arap", "primo", "shells"] {
        assert!(said(name, 175.0, true).is_empty(), "{name}");
    }
}
