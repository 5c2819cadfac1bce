//! Warnings about a handle's turn beyond a method's limit.

use std::f64::consts::{PI, TAU};

use glam::{DAffine3, DVec3};
use pliant_deform::{Method, Role};
use pliant_mesh::shapes;

use crate::rig::{Scene, settle};

/// The method's warning about a limb whose end turns about the limb.
fn said(name: &str, degrees: f64, fixed: bool) -> Vec<String> {
    let mut scene = Scene::new(shapes::tube(10, 16, 5.0)).with(Role::Handle(0), |p| p.z > 4.5);
    scene = match fixed {
        true => scene.with(Role::Fixed, |p| p.z < 0.5),
        false => scene.with(Role::Handle(1), |p| p.z < 0.5),
    };
    scene.method = Method::from_name(name).unwrap();
    let mut bound = scene.bind();
    let turn = DAffine3::from_rotation_z(degrees * PI / 180.0);
    // If nothing is fixed, both ends turn alike.
    bound.set_targets(&vec![turn; scene.handle_count]).unwrap();
    let about = |said: &&pliant_deform::Warning| said.contains("turns by");
    bound.warnings().iter().filter(about).map(ToString::to_string).collect()
}

/// The share of its radius that a limb with a neck keeps at its narrowest ring when its end is turned, and the largest
/// turn of an edge along it, in radians.
fn twisted(name: &str, degrees: f64, neck: f64) -> (f64, f64) {
    let mut drawn = shapes::tube(16, 40, 5.0);
    let radius = |z: f64| 0.5 * (1.0 - (1.0 - neck) * (-(3.0 * (z - 2.5)).powi(2)).exp());
    for p in &mut drawn.positions {
        let scale = radius(p.z);
        p.x *= scale;
        p.y *= scale;
    }
    let mut scene = Scene::new(drawn)
        .with(Role::Fixed, |p| p.z < 0.5)
        .with(Role::Handle(0), |p| p.z > 4.5);
    scene.method = Method::from_name(name).unwrap();
    let (displacements, _) = settle(&mut scene.bind(), &[DAffine3::from_rotation_z(degrees * PI / 180.0)]);
    let rest = scene.positions();
    let share = |v: usize| (rest[v] + displacements[v]).truncate().length() / rest[v].truncate().length();
    let angle = |v: usize| {
        let (from, to) = (rest[v].truncate(), (rest[v] + displacements[v]).truncate());
        from.angle_to(to)
    };
    let along = |v: usize| (0..rest.len()).find(|&w| rest[w].z > rest[v].z && on_one_line(rest[v], rest[w]));
    let steps = (0..rest.len()).filter_map(|v| Some((angle(along(v)?) - angle(v)).rem_euclid(TAU)));
    let steps = steps.map(|step| step.min(TAU - step));
    (
        (0..rest.len()).map(share).fold(f64::INFINITY, f64::min),
        steps.fold(0.0, f64::max),
    )
}

/// Returns true if two points are at the same place around the limb.
fn on_one_line(p: DVec3, q: DVec3) -> bool {
    p.truncate().angle_to(q.truncate()).abs() < 1e-6
}

/// A method's effect on a limb at half a turn.
#[derive(Clone, Copy, PartialEq)]
enum Beyond {
    Narrows,
    NarrowsNecks,
    TwistsInOnePlace,
}

/// Methods that don't follow half a turn, the largest turn that they follow, and their effect beyond.
const LIMITED: [(&str, f64, Beyond); 12] = [
    ("bilaplacian", 90.0, Beyond::Narrows),
    ("wrinkles", 90.0, Beyond::Narrows),
    ("rbf", 90.0, Beyond::Narrows),
    ("mls", 90.0, Beyond::TwistsInOnePlace),
    ("lattice", 90.0, Beyond::Narrows),
    ("cage", 90.0, Beyond::Narrows),
    ("embedded", 120.0, Beyond::NarrowsNecks),
    ("arap", 140.0, Beyond::NarrowsNecks),
    ("primo", 140.0, Beyond::NarrowsNecks),
    ("shells", 150.0, Beyond::NarrowsNecks),
    ("frames", 140.0, Beyond::Narrows),
    ("space-primo", 160.0, Beyond::NarrowsNecks),
];

#[test]
fn methods_that_fail_between_large_turns_say_so_and_name_others() {
    for (name, follows, _) in LIMITED {
        assert!(said(name, follows, true).is_empty(), "{name}");
        for turn in [follows + 10.0, -follows - 10.0, 180.0] {
            let said = said(name, turn, true);
            let is_told = |said: &String| said.contains(name) && said.contains("poisson");
            assert!(!said.is_empty() && said.iter().all(is_told), "{name} {said:?}");
            assert!(turn.abs() < 140.0 || !said[0].contains("arap or"), "{name} {said:?}");
        }
        let said = said(name, 170.0, false);
        assert!(said.is_empty(), "{name}: what all turns is not narrowed");
    }
}

#[test]
fn methods_follow_turns_up_to_where_their_sentence_says_and_poisson_follows_half_a_turn() {
    /// The least share of its radius that a limb keeps.
    const KEPT: f64 = 0.7;
    /// The largest turn from ring to ring if 180° are spread over all or most of 32 rings, in radians.
    const SPREAD: f64 = 0.6;
    for (name, follows, beyond) in LIMITED {
        if beyond != Beyond::TwistsInOnePlace {
            let (kept, step) = twisted(name, follows, 0.6);
            assert!(kept > KEPT && step < SPREAD, "{name} {kept} {step}");
        }
        let [(plain, step), (neck, _)] = [1.0, 0.3].map(|neck| twisted(name, 175.0, neck));
        let is_as_said = match beyond {
            Beyond::Narrows => plain < KEPT,
            Beyond::NarrowsNecks => plain > KEPT && neck < KEPT,
            Beyond::TwistsInOnePlace => step > SPREAD,
        };
        assert!(is_as_said, "{name} {plain} {neck} {step}");
    }
    for neck in [1.0, 0.6, 0.3, 0.2] {
        // In a neck the turn is rightly concentrated.
        let (kept, step) = twisted("poisson", 180.0, neck);
        assert!(kept > KEPT && (step < SPREAD || neck < 0.5), "{neck} {kept} {step}");
    }
}
