//! Warnings about a handle's turn beyond a method's limit.

use std::f64::consts::{PI, TAU};

use glam::{DAffine3, DVec3};
use pliant_deform::{Arap, ArapEnergy, Bilaplacian, Detail, Method, Role};
use pliant_mesh::shapes;

use crate::rig::{Scene, apart, settle};

fn named(name: &str) -> Method {
    Method::from_name(name).unwrap()
}

/// The method's warning about a limb whose end turns about the limb.
fn said(method: &Method, degrees: f64, fixed: bool) -> Vec<String> {
    let mut scene = Scene::new(shapes::tube(10, 16, 5.0)).with(Role::Handle(0), |p| p.z > 4.5);
    scene = match fixed {
        true => scene.with(Role::Fixed, |p| p.z < 0.5),
        false => scene.with(Role::Handle(1), |p| p.z < 0.5),
    };
    scene.method = method.clone();
    let mut bound = scene.bind();
    let turn = DAffine3::from_rotation_z(degrees * PI / 180.0);
    // If nothing is fixed, both ends turn alike.
    bound.set_targets(&vec![turn; scene.handle_count]).unwrap();
    let about = |said: &&pliant_deform::Warning| said.contains("turns by");
    bound.warnings().iter().filter(about).map(ToString::to_string).collect()
}

#[test]
fn a_handle_that_holds_a_whole_part_has_no_limb_that_could_narrow() {
    let limb = shapes::tube(10, 16, 5.0);
    let beside = shapes::moved(&limb, DAffine3::from_translation(4.0 * DVec3::X));
    for whole in [false, true] {
        let mut scene = Scene::new(shapes::together(&[limb.clone(), beside.clone()]))
            .with(Role::Fixed, |p| p.x < 2.0 || (!whole && p.z < 0.5))
            .with(Role::Handle(0), |p| p.x > 2.0 && (whole || p.z > 4.5));
        for name in ["arap", "bilaplacian", "shells"] {
            scene.method = named(name);
            let mut bound = scene.bind();
            bound.set_targets(&turn_about_limb(175.0)).unwrap();
            let warns = bound.warnings().iter().any(|said| said.contains("turns by"));
            assert_eq!(warns, !whole, "{name}");
        }
    }
}

/// A limb with a neck of this share of its radius, fixed at one end and with a handle at the other.
fn limb(method: &Method, neck: f64) -> Scene {
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
    scene.method = method.clone();
    scene
}

fn turn_about_limb(degrees: f64) -> [DAffine3; 1] {
    [DAffine3::from_rotation_z(degrees * PI / 180.0)]
}

/// The share of its radius that a limb with a neck keeps at its narrowest ring when its end is turned, and the largest
/// turn of an edge along it, in radians.
fn twisted(method: &Method, degrees: f64, neck: f64) -> (f64, f64) {
    let scene = limb(method, neck);
    let (displacements, _) = settle(&mut scene.bind(), &turn_about_limb(degrees));
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
    ("embedded", 95.0, Beyond::NarrowsNecks),
    ("arap", 95.0, Beyond::NarrowsNecks),
    ("primo", 120.0, Beyond::NarrowsNecks),
    ("shells", 125.0, Beyond::NarrowsNecks),
    ("frames", 140.0, Beyond::Narrows),
    ("space-primo", 120.0, Beyond::NarrowsNecks),
];

#[test]
fn methods_that_fail_between_large_turns_say_so_and_name_others() {
    for (name, follows, _) in LIMITED {
        let method = &named(name);
        assert!(said(method, follows, true).is_empty(), "{name}");
        for turn in [follows + 10.0, -follows - 10.0, 180.0] {
            let said = said(method, turn, true);
            let is_told = |said: &String| said.contains(name) && said.contains("poisson");
            assert!(!said.is_empty() && said.iter().all(is_told), "{name} {said:?}");
            assert!(turn.abs() < 140.0 || !said[0].contains("`arap` or"), "{name} {said:?}");
        }
        let said = said(method, 170.0, false);
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
        let method = &named(name);
        if beyond != Beyond::TwistsInOnePlace {
            for neck in [0.6, 0.2] {
                // In a neck the turn is rightly concentrated.
                let (kept, step) = twisted(method, follows, neck);
                assert!(
                    kept > KEPT && (step < SPREAD || neck < 0.5),
                    "{name} {neck} {kept} {step}"
                );
            }
        }
        let [(plain, step), (neck, _)] = [1.0, 0.3].map(|neck| twisted(method, 175.0, neck));
        let is_as_said = match beyond {
            Beyond::Narrows => plain < KEPT,
            Beyond::NarrowsNecks => plain > KEPT && neck < KEPT,
            Beyond::TwistsInOnePlace => step > SPREAD,
        };
        assert!(is_as_said, "{name} {plain} {neck} {step}");
    }
    for neck in [1.0, 0.6, 0.3, 0.2] {
        let (kept, step) = twisted(&named("poisson"), 180.0, neck);
        assert!(kept > KEPT && (step < SPREAD || neck < 0.5), "{neck} {kept} {step}");
    }
}

#[test]
fn the_smooth_energy_follows_half_a_turn_with_every_neck_by_one_solve_and_by_a_drag() {
    let method = Method::from(Arap::first_choice());
    for neck in [1.0, 0.6, 0.3, 0.2] {
        let (kept, _) = twisted(&method, 180.0, neck);
        assert!(kept > 0.7, "{neck} {kept}");
        let scene = limb(&method, neck);
        let (once, energies) = settle(&mut scene.bind(), &turn_about_limb(180.0));
        let mut bound = scene.bind();
        let mut out = once.clone();
        for frame in 1..20 {
            bound.set_targets(&turn_about_limb(9.0 * f64::from(frame))).unwrap();
            for _ in 0..3 {
                bound.step(&mut out).unwrap();
            }
        }
        let (dragged, of_drag) = settle(&mut bound, &turn_about_limb(180.0));
        let [once_energy, drag_energy] = [&energies, &of_drag].map(|energies| energies[energies.len() - 1]);
        assert!(
            (once_energy / drag_energy - 1.0).abs() < 1e-4,
            "{neck} {once_energy} {drag_energy}"
        );
        let error = apart(&once, &dragged) / scene.diagonal();
        assert!(error < 1e-2, "{neck} {error}");
    }
}

#[test]
fn a_drag_that_winds_a_limb_up_ends_no_higher_than_one_solve_does() {
    let smooth = Method::from(Arap::first_choice());
    for method in [smooth, named("primo"), named("shells"), named("embedded")] {
        let scene = limb(&method, 1.0);
        let (_, energies) = settle(&mut scene.bind(), &turn_about_limb(190.0));
        let mut bound = scene.bind();
        let mut out = vec![DVec3::ZERO; scene.positions().len()];
        for frame in 1..19 {
            bound.set_targets(&turn_about_limb(10.0 * f64::from(frame))).unwrap();
            for _ in 0..3 {
                bound.step(&mut out).unwrap();
            }
        }
        let (_, of_drag) = settle(&mut bound, &turn_about_limb(190.0));
        let [once, dragged] = [&energies, &of_drag].map(|energies| energies[energies.len() - 1]);
        assert!(dragged < 1.002 * once, "{} {once} {dragged}", method.name());
    }
}

/// The share of its radius that a limb keeps where it is thinnest when it is folded about an axis beside it.
fn folded(method: &Method, degrees: f64) -> f64 {
    let scene = limb(method, 1.0);
    let pivot = DVec3::new(0.6, 0.0, 2.5);
    let fold = DAffine3::from_translation(pivot)
        * DAffine3::from_rotation_y(degrees * PI / 180.0)
        * DAffine3::from_translation(-pivot);
    let (displacements, _) = settle(&mut scene.bind(), &[fold]);
    let rest = scene.positions();
    let of_ring = |z: f64| (0..rest.len()).filter(move |&v| (rest[v].z - z).abs() < 1e-6);
    let share = |v: usize| {
        let ring = || of_ring(rest[v].z).map(|w| rest[w] + displacements[w]);
        let middle = ring().sum::<DVec3>() / ring().count() as f64;
        (rest[v] + displacements[v]).distance(middle) / rest[v].truncate().length()
    };
    (0..rest.len()).map(share).fold(f64::INFINITY, f64::min)
}

#[test]
fn the_plain_energies_say_from_where_on_folds_crease_a_limb() {
    for energy in [ArapEnergy::Spokes, ArapEnergy::SpokesAndRims] {
        let mut options = Arap::default();
        options.energy = energy;
        let method = Method::from(options);
        assert!(said(&method, 95.0, true).is_empty() && folded(&method, 95.0) > 0.7);
        let between = said(&method, 120.0, true);
        assert!(
            between[0].contains("flattens a limb that is folded, though not one that is twisted")
                && between[0].contains("`arap` with `energy` \"smooth\""),
            "{between:?}"
        );
        assert!(folded(&method, 120.0) < 0.5 && twisted(&method, 120.0, 0.6).0 > 0.7);
        let beyond = said(&method, 150.0, true);
        assert!(
            beyond[0].contains("from 140° on it narrows the limb at thin places"),
            "{beyond:?}"
        );
    }
}

#[test]
fn transferred_details_say_sooner_that_necks_narrow() {
    let mut options = Bilaplacian::default();
    options.detail = Detail::DeformationTransfer;
    let method = Method::from(options);
    assert!(said(&method, 65.0, true).is_empty() && twisted(&method, 65.0, 0.2).0 > 0.7);
    assert!(!said(&method, 90.0, true).is_empty() && twisted(&method, 90.0, 0.2).0 < 0.7);
}

#[test]
fn the_smooth_energy_says_from_where_on_folds_flatten_a_limb() {
    let method = Method::from(Arap::first_choice());
    assert!(said(&method, 140.0, true).is_empty() && folded(&method, 140.0) > 0.7);
    let said = said(&method, 180.0, true);
    assert!(
        said[0].contains("flattens a limb that is folded") && said[0].contains("poisson"),
        "{said:?}"
    );
    assert!(folded(&method, 180.0) < 0.7 && folded(&named("poisson"), 180.0) > 0.7);
}

#[test]
fn a_hand_counts_against_its_forearm_and_not_against_the_shoulder() {
    let about_limb = |degrees: f64| DAffine3::from_rotation_z(degrees.to_radians());
    // A handle all round the limb bounds two limbs; one on a side of it leaves one limb from end to end.
    for (around, turns, warns) in [
        (true, [150.0, 75.0], false),
        (true, [-150.0, 0.0], true),
        (true, [150.0, 150.0], true),
        (false, [150.0, 75.0], true),
    ] {
        let mut scene = Scene::new(shapes::tube(10, 16, 5.0))
            .with(Role::Fixed, |p| p.z < 0.5)
            .with(Role::Handle(0), |p| p.z > 4.5)
            .with(Role::Handle(1), |p| (2.0..3.0).contains(&p.z) && (around || p.x > 0.0));
        for name in ["bilaplacian", "frames", "wrinkles"] {
            scene.method = named(name);
            let mut bound = scene.bind();
            bound.set_targets(&turns.map(about_limb)).unwrap();
            let said: Vec<_> = bound
                .warnings()
                .iter()
                .filter(|said| said.contains("turns by"))
                .collect();
            assert_eq!(!said.is_empty(), warns, "{name}, all round: {around}, {turns:?}");
            // The one that is turned is named, not the one that rests.
            assert!(turns[1] != 0.0 || said[0].contains("handle 0"), "{name} {said:?}");
        }
    }
}
