//! Laplacian editing: the turns that its transformations follow, their limits, and the effect on the size of details.

use std::f64::consts::FRAC_PI_2;

use crate::poisson::{along_an_arc, bumpy, worst_strain};
use crate::rig::{Scene, apart, step, turned};
use glam::{DAffine3, DVec3};
use pliant_deform::{Method, OptionValue, Role};
use pliant_mesh::shapes;

fn laplacian(options: &[(&str, OptionValue)]) -> Method {
    let method = Method::from_name("laplacian").unwrap();
    method.with(options.iter().copied()).unwrap()
}

fn transforms(name: &'static str) -> Method {
    laplacian(&[("transforms", OptionValue::Name(name))])
}

/// The angle, in radians, by which a peg in the middle of a sheet leans within the sheet, and that by which the sheet
/// leans there, when the sheet's end moves to the target.
fn leans(method: &Method, target: DAffine3) -> [f64; 2] {
    let mut sheet = shapes::grid(60, 20);
    let middle = DVec3::new(1.5, 0.5, 0.0);
    for p in &mut sheet.positions {
        *p = DVec3::new(3.0 * p.x, p.y, 0.0);
        p.z = 0.3 * (-p.distance_squared(middle) / 0.02).exp();
    }
    let mut scene = Scene::new(sheet)
        .with(Role::Fixed, |p| p.x < 0.101)
        .with(Role::Handle(0), |p| p.x > 2.899);
    scene.method = method.clone();
    let moved = scene.moved(&[target]);
    let at = |x: f64, y: f64| {
        let from = |v: &usize| {
            scene.positions()[*v]
                .truncate()
                .distance_squared((middle + DVec3::new(x, y, 0.0)).truncate())
        };
        let vertex = (0..moved.len()).min_by(|a, b| from(a).total_cmp(&from(b))).unwrap();
        scene.positions()[vertex] + moved[vertex]
    };
    let ring = [at(-0.4, 0.0), at(0.4, 0.0), at(0.0, -0.4), at(0.0, 0.4)];
    let normal = (ring[1] - ring[0]).cross(ring[3] - ring[2]);
    let peg = at(0.0, 0.0) - (at(-0.25, 0.0) + at(0.25, 0.0)) * 0.5;
    [peg.angle_between(normal), normal.angle_between(DVec3::Z)]
}

#[test]
fn what_protrudes_leans_with_the_surface_for_moves_and_for_turns_up_to_a_quarter() {
    let moves = DAffine3::from_translation(DVec3::new(-0.3, 0.0, 1.2));
    // Details with their rest length, in the direction of the first shape, lean too little by about a quarter.
    for (target, most) in [(moves, 0.3), (along_an_arc(0.8), 0.3), (along_an_arc(FRAC_PI_2), 0.4)] {
        let [missed, sheet] = leans(&transforms("implicit"), target);
        assert!(missed < most * sheet && sheet > 0.35, "{missed} {sheet}");
        // Without transformations it stays upright in space, and a first guess sees hardly more of its turn.
        let [missed, sheet] = leans(&transforms("none"), target);
        assert!((missed - sheet).abs() < 0.1, "{missed} {sheet}");
        let [guessed, _] = leans(&transforms("initial-guess"), target);
        assert!(guessed < 0.9 * missed, "{guessed} {missed}");
    }
}

#[test]
fn an_initial_guess_serves_bumps_that_do_not_protrude() {
    let moves = DAffine3::from_translation(DVec3::new(-0.3, 0.0, 1.2));
    for target in [moves, along_an_arc(0.8), along_an_arc(FRAC_PI_2)] {
        let strain = |name| {
            let scene = bumpy(&transforms(name));
            worst_strain(&scene, &scene.moved(&[target]))
        };
        let [guessed, none] = ["initial-guess", "none"].map(strain);
        assert!(guessed < 0.6 * none, "{guessed} {none}");
    }
}

#[test]
fn without_transformations_it_is_the_thin_plate() {
    let target = [along_an_arc(1.0)];
    let plate = bumpy(&Method::default());
    let (ours, theirs) = (bumpy(&transforms("none")).moved(&target), plate.moved(&target));
    assert!(apart(&ours, &theirs) < 1e-6);
}

#[test]
fn small_rigid_motions_of_all_handles_are_reproduced_to_second_order() {
    for name in ["implicit", "initial-guess"] {
        for (class, drawn) in shapes::classes() {
            let mut scene = Scene::new(drawn).with_ends(false);
            scene.method = transforms(name);
            let centre = scene.model.bounds().unwrap().centre();
            let bound = &mut scene.bind();
            let mut error = |angle: f64| {
                let motion = turned(centre, angle, DVec3::ZERO);
                let found = step(bound, &vec![motion; scene.handle_count]);
                let moved = |p: &DVec3| motion.transform_point3(*p) - *p;
                let expected: Vec<DVec3> = scene.positions().iter().map(moved).collect();
                apart(&found, &expected) / scene.diagonal()
            };
            // Handles of single vertices do not determine turns.
            if class.starts_with("non-manifold") {
                continue;
            }
            let [small, larger, large] = [1e-3, 1e-2, 1.0].map(&mut error);
            assert!(large < 0.1, "{class} {name}: {large}");
            if name == "implicit" {
                assert!(
                    small < 1e-7 && (larger / small - 100.0).abs() < 20.0,
                    "{class}: {small:e} {larger:e}"
                );
            } else {
                // A first shape without turns sees a little less of any turn.
                assert!(small < 0.1 * 1e-3, "{class}: {small:e}");
            }
        }
    }
}

#[test]
fn more_steps_hold_larger_turns() {
    let strain = |transforms, steps, angle| {
        let scene = bumpy(&laplacian(&[
            ("transforms", OptionValue::Name(transforms)),
            ("steps", OptionValue::Whole(steps)),
        ]));
        worst_strain(&scene, &scene.moved(&[along_an_arc(angle)]))
    };
    let [one, two, four] = [1, 2, 4].map(|steps| strain("implicit", steps, 2.0));
    assert!(one > 1.5 * two && two > 1.5 * four && four < 0.08, "{one} {two} {four}");
    let [one, four] = [1, 4].map(|steps| strain("initial-guess", steps, 2.0));
    assert!(one > 1.2 * four, "{one} {four}");
}

#[test]
fn pulled_details_grow_with_free_scale_and_keep_their_size_with_normalised() {
    let height = |scale: &'static str| {
        let scene = bumpy(&laplacian(&[("scale", OptionValue::Name(scale))]));
        let pulled = scene.moved(&[DAffine3::from_translation(DVec3::X * 1.4)]);
        let middle = (0..pulled.len()).filter(|&v| (scene.positions()[v].x - 1.5).abs() < 0.7);
        middle.map(|v| (scene.positions()[v] + pulled[v]).z).fold(0.0, f64::max)
    };
    let [free, normalised] = ["free", "normalised"].map(height);
    assert!((normalised - 0.02).abs() < 0.002, "{normalised}");
    assert!(free > 1.4 * normalised, "{free} {normalised}");
}

#[test]
fn a_flat_sheet_with_free_borders_keeps_its_width() {
    // Similarities alone would allow every conformal map of it.
    let mut sheet = shapes::grid(40, 40);
    sheet.positions.iter_mut().for_each(|p| p.x *= 2.0);
    let mut scene = Scene::new(sheet)
        .with(Role::Fixed, |p| p.x < 0.11)
        .with(Role::Handle(0), |p| p.x > 1.89);
    scene.method = laplacian(&[]);
    let moved = scene.moved(&[DAffine3::from_translation(DVec3::Z * 0.5)]);
    for (p, d) in scene.positions().iter().zip(&moved) {
        assert!(d.y.abs() < 0.05, "{p} {d}");
    }
}

#[test]
fn large_turns_are_warned_of() {
    let scene = bumpy(&laplacian(&[]));
    let bound = &mut scene.bind();
    step(bound, &[along_an_arc(1.0)]);
    assert!(bound.warnings().is_empty(), "{:?}", bound.warnings());
    step(bound, &[along_an_arc(2.5)]);
    assert!(
        bound.warnings()[0].contains("set `steps` to 2"),
        "{:?}",
        bound.warnings()
    );
    let unturned = bumpy(&transforms("none"));
    let bound = &mut unturned.bind();
    step(bound, &[along_an_arc(1.0)]);
    assert!(
        bound.warnings()[0].contains("turns no details"),
        "{:?}",
        bound.warnings()
    );
    assert!(scene.roles.contains(&Role::Handle(0)));
}
