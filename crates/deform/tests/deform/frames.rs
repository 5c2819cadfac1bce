//! Rotation-invariant coordinates: the motions that the linear shape reproduces and ignores, and the effect of
//! iterations.

use std::f64::consts::FRAC_PI_2;

use crate::differential::tube;
use crate::poisson::{along_an_arc, bumpy, worst_strain};
use crate::rig::{Scene, apart, far, settle, step, turned};
use glam::{DAffine3, DVec3};
use pliant_deform::{Bilaplacian, BilaplacianOrder, Method, OptionValue, Role};
use pliant_mesh::shapes;

fn frames(iterations: u32) -> Method {
    let method = Method::from_name("frames").unwrap();
    method.with([("iterations", OptionValue::Whole(iterations))]).unwrap()
}

const MOVE: DVec3 = DVec3::new(-0.3, 0.0, 1.2);

#[test]
fn a_turned_handle_bends_the_surface_and_does_not_shear_its_bumps() {
    let plate = bumpy(&Method::default());
    for angle in [0.5, FRAC_PI_2, 2.0] {
        let of_a_plate = worst_strain(&plate, &plate.moved(&[along_an_arc(angle)]));
        let scene = bumpy(&frames(0));
        let strain = worst_strain(&scene, &scene.moved(&[along_an_arc(angle)]));
        assert!(strain < 0.4 * of_a_plate, "{angle}: {strain} {of_a_plate}");
        let (improved, _) = settle(&mut bumpy(&frames(200)).bind(), &[along_an_arc(angle)]);
        let improved = worst_strain(&scene, &improved);
        assert!(improved < strain && improved < 0.01, "{angle}: {improved} {strain}");
    }
}

#[test]
fn the_linear_shape_is_blind_to_moves_and_says_so() {
    let mut scene = bumpy(&frames(0));
    let bound = &mut scene.bind();
    let target = [DAffine3::from_translation(MOVE)];
    let moved = step(bound, &target);
    assert!(
        bound
            .warnings()
            .iter()
            .any(|said| said.contains("turns nothing for moves"))
    );
    let mut membrane = Bilaplacian::default();
    membrane.order = BilaplacianOrder::Membrane;
    scene.method = membrane.into();
    assert!(apart(&moved, &scene.moved(&target)) < 1e-6);
    step(bound, &[turned(DVec3::X * 3.0, 3.1, DVec3::ZERO)]);
    assert!(bound.warnings()[0].contains("half a turn"), "{:?}", bound.warnings());
    step(bound, &[turned(DVec3::X * 3.0, 0.3, DVec3::ZERO)]);
    assert!(bound.warnings().is_empty(), "{:?}", bound.warnings());
}

#[test]
fn iterations_follow_moves_too() {
    let scene = bumpy(&frames(0));
    let blind = worst_strain(&scene, &scene.moved(&[DAffine3::from_translation(MOVE)]));
    let bound = &mut bumpy(&frames(300)).bind();
    let (shape, energies) = settle(bound, &[DAffine3::from_translation(MOVE)]);
    assert!(energies.len() < 300, "the descent ends by itself: {}", energies.len());
    assert!(bound.warnings().is_empty(), "{:?}", bound.warnings());
    let followed = worst_strain(&scene, &shape);
    assert!(followed < 0.25 * blind, "{followed} {blind}");
}

#[test]
fn iterations_never_raise_the_energy_and_end_at_a_minimum() {
    for (name, drawn) in shapes::classes() {
        for fixed in [true, false] {
            let mut scene = Scene::new(drawn.clone()).with_ends(fixed);
            scene.method = frames(50);
            let (_, energies) = settle(&mut scene.bind(), &far(&scene));
            let falls = |pair: &[f64]| pair[1] <= pair[0] * (1.0 + 1e-9);
            assert!(energies.windows(2).all(falls), "{name}: {energies:?}");
        }
    }
    let scene = tube(&frames(3000));
    let bound = &mut scene.bind();
    let target = [turned(DVec3::Z * 7.5, 1.0, DVec3::X)];
    let (shape, energies) = settle(bound, &target);
    assert!(energies.len() > 3 && energies.len() < 3000, "{}", energies.len());
    let least = bound.energy_of(&shape).unwrap();
    for seed in 0..5 {
        let mut other = shape.clone();
        for (vertex, d) in other.iter_mut().enumerate() {
            if scene.roles[vertex] == Role::Free {
                *d += DVec3::splat(0.01 * ((vertex * 7919 + seed * 31) % 1009) as f64 / 1009.0);
            }
        }
        assert!(bound.energy_of(&other).unwrap() > least);
    }
    // A drag ends at the shape of a single solve.
    let bound = &mut scene.bind();
    for share in [0.3, 0.6] {
        settle(bound, &[turned(DVec3::Z * 7.5, share, DVec3::X * share)]);
    }
    assert!(settle(bound, &target).0 == shape);
}

#[test]
fn a_rigid_motion_of_all_handles_is_a_fixed_point() {
    for (name, drawn) in shapes::classes() {
        let mut scene = Scene::new(drawn).with_ends(false);
        scene.method = frames(20);
        let motion = turned(DVec3::ONE, 2.0, DVec3::new(2.0, -1.0, 0.5) * scene.diagonal());
        let (shape, energies) = settle(&mut scene.bind(), &vec![motion; scene.handle_count]);
        let moved = |p: &DVec3| motion.transform_point3(*p) - *p;
        let expected: Vec<DVec3> = scene.positions().iter().map(moved).collect();
        let error = apart(&shape, &expected) / scene.diagonal();
        assert!(
            error < 1e-6 && energies.iter().all(|energy| *energy < 1e-9),
            "{name}: {error:e}"
        );
    }
}
