//! Laws of every bound problem, on every class of mesh.

use crate::rig::{Scene, apart, back_substitute, step, turned};
use glam::{DAffine3, DMat3, DVec3};
use pliant_deform::{Role, SolveError};
use pliant_mesh::shapes;

/// A different affine map for each handle, of the model's own size, about its middle.
fn targets(scene: &Scene) -> Vec<DAffine3> {
    let centre = scene.model.bounds().unwrap().centre();
    let size = scene.diagonal();
    (0..scene.handle_count)
        .map(|h| {
            let number = h as f64;
            turned(centre, 0.4 + number, DVec3::new(0.1, -0.2, 0.05 * number) * size)
                * DAffine3::from_translation(centre)
                * DAffine3::from_scale(DVec3::new(1.2, 0.9, 1.0))
                * DAffine3::from_translation(-centre)
        })
        .collect()
}

#[test]
fn where_nothing_is_fixed_a_translation_moves_everything_by_itself() {
    for (name, drawn) in shapes::classes() {
        let scene = Scene::new(drawn).with_ends(false);
        let shift = DVec3::new(0.7, -3.0, 0.2) * scene.diagonal();
        let bound = &mut scene.bind();
        let all = vec![DAffine3::from_translation(shift); scene.handle_count];
        for displacements in [step(bound, &all), back_substitute(bound, &all)] {
            let worst = displacements.iter().map(|d| d.distance(shift)).fold(0.0, f64::max);
            assert!(worst < 1e-9 * shift.length(), "{name}: {worst:e}");
        }
    }
}

#[test]
fn bases_equal_back_substitution_and_energies_agree() {
    for (name, drawn) in shapes::classes() {
        for fixed in [true, false] {
            let scene = Scene::new(drawn.clone()).with_ends(fixed);
            let bound = &mut scene.bind();
            let by_bases = step(bound, &targets(&scene));
            let by_solving = back_substitute(bound, &targets(&scene));
            assert!(apart(&by_bases, &by_solving) < 1e-6 * scene.diagonal(), "{name}");
            let mut out = by_bases.clone();
            let energy = bound.step(&mut out).unwrap().energy;
            let direct = bound.step_by_back_substitution(&mut out).unwrap().energy;
            assert!(
                (energy - direct).abs() <= 1e-7 * direct.max(1e-9),
                "{name}: {energy} {direct}"
            );
        }
    }
}

#[test]
fn handles_go_where_they_are_told_and_what_is_fixed_stays() {
    for (name, drawn) in shapes::classes() {
        let scene = Scene::new(drawn).with_ends(true);
        let targets = targets(&scene);
        let displacements = scene.moved(&targets);
        for ((&role, &rest), &displacement) in scene.roles.iter().zip(scene.positions()).zip(&displacements) {
            match role {
                Role::Fixed => assert_eq!(displacement, DVec3::ZERO, "{name}"),
                Role::Handle(h) => {
                    let expected = targets[usize::from(h)].transform_point3(rest) - rest;
                    assert!(
                        displacement.distance(expected) < 1e-9 * scene.diagonal() + 1e-14 * rest.length(),
                        "{name}"
                    );
                }
                Role::Free => assert!(displacement.is_finite(), "{name}"),
            }
        }
    }
}

#[test]
fn displacements_are_linear_in_the_transforms() {
    for (name, drawn) in shapes::classes() {
        let scene = Scene::new(drawn).with_ends(true);
        let bound = &mut scene.bind();
        let whole = targets(&scene);
        let mut sum = vec![DVec3::ZERO; scene.positions().len()];
        for handle in 0..scene.handle_count {
            let mut alone = vec![DAffine3::IDENTITY; scene.handle_count];
            // Half of the change, twice: superposition and homogeneity at once.
            let change = whole[handle].matrix3 - DMat3::IDENTITY;
            alone[handle] = DAffine3 {
                matrix3: DMat3::IDENTITY + change * 0.5,
                translation: whole[handle].translation * 0.5,
            };
            for (sum, part) in sum.iter_mut().zip(step(bound, &alone)) {
                *sum += 2.0 * part;
            }
        }
        assert!(apart(&sum, &step(bound, &whole)) < 1e-8 * scene.diagonal(), "{name}");
    }
}

#[test]
fn handles_that_stay_move_nothing_to_the_last_bit() {
    for (name, drawn) in shapes::classes() {
        let scene = Scene::new(drawn).with_ends(true);
        let bound = &mut scene.bind();
        step(bound, &targets(&scene));
        for displacement in step(bound, &vec![DAffine3::IDENTITY; scene.handle_count]) {
            assert_eq!(displacement, DVec3::ZERO, "{name}");
        }
    }
}

#[test]
fn any_other_shape_with_the_same_constraints_has_more_energy() {
    for (name, drawn) in shapes::classes() {
        let scene = Scene::new(drawn).with_ends(true);
        let bound = &mut scene.bind();
        let solution = back_substitute(bound, &targets(&scene));
        let least = bound.energy_of(&solution).unwrap();
        if bound.solved_count() == 0 {
            continue;
        }
        let solved = bound.handle_bases().unwrap().vertices().to_vec();
        for seed in 1..6_u32 {
            let mut other = solution.clone();
            for &vertex in &solved {
                let noise = |k: u32| f64::from((vertex * 7919 + k * 104_729 + seed * 31_337) % 1009) / 1009.0 - 0.5;
                other[vertex as usize] += DVec3::new(noise(1), noise(2), noise(3)) * 1e-3 * scene.diagonal();
            }
            assert!(bound.energy_of(&other).unwrap() > least, "{name}");
        }
    }
}

#[test]
fn weights_and_what_is_fixed_make_up_one() {
    // If one handle holds each end, the second end's weight is that of a fixed end.
    let free_ends = Scene::new(shapes::tube(16, 24, 6.0))
        .with(Role::Handle(0), |p| p.z > 5.5)
        .with(Role::Handle(1), |p| p.z < 0.5);
    let fixed_end = Scene::new(shapes::tube(16, 24, 6.0))
        .with(Role::Handle(0), |p| p.z > 5.5)
        .with(Role::Fixed, |p| p.z < 0.5);
    let (both, one) = (free_ends.bind(), fixed_end.bind());
    let (both, one) = (both.handle_bases().unwrap(), one.handle_bases().unwrap());
    assert_eq!(both.vertices(), one.vertices());
    for row in 0..both.vertices().len() {
        assert!((both.weight(row, 0) + both.weight(row, 1) - 1.0).abs() < 1e-6);
        assert!((both.weight(row, 0) - one.weight(row, 0)).abs() < 1e-6);
    }
}

#[test]
fn units_and_place_do_not_matter() {
    let reference = Scene::new(shapes::icosphere(3)).with_ends(true);
    let expected = reference.moved(&targets(&reference));
    let offset = DVec3::new(4.0e3, 2.5e3, -1.0e3);
    for scale in [1e-3, 1.0, 1e6] {
        let place = DAffine3::from_translation(offset * scale) * DAffine3::from_scale(DVec3::splat(scale));
        let mut scene = Scene::new(shapes::moved(&shapes::icosphere(3), place));
        assert_eq!(scene.roles.len(), reference.roles.len());
        // Rounding in the offset may reorder vertices: find each one's partner by its position.
        let back: Vec<DVec3> = scene.positions().iter().map(|p| *p / scale - offset).collect();
        let partner: Vec<usize> = back
            .iter()
            .map(|p| {
                let key = |i: &usize| reference.positions()[*i].distance(*p);
                (0..reference.roles.len())
                    .min_by(|a, b| key(a).total_cmp(&key(b)))
                    .unwrap()
            })
            .collect();
        scene.roles = partner.iter().map(|&i| reference.roles[i]).collect();
        scene.handle_count = reference.handle_count;
        let moved: Vec<DAffine3> = targets(&reference)
            .iter()
            .map(|target| place * *target * place.inverse())
            .collect();
        for (displacement, &i) in scene.moved(&moved).iter().zip(&partner) {
            assert!(
                (*displacement / scale).distance(expected[i]) < 1e-6 * reference.diagonal(),
                "{scale}"
            );
        }
    }
}

#[test]
fn the_number_of_threads_does_not_show() {
    let run = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| {
            let scene = Scene::new(shapes::together(&[
                shapes::icosphere(4),
                shapes::moved(
                    &shapes::torus(40, 30),
                    DAffine3::from_translation(DVec3::new(4.0, 0.0, 0.0)),
                ),
                shapes::moved(
                    &shapes::icosphere(1),
                    DAffine3::from_translation(DVec3::new(0.0, 4.0, 0.0)),
                ),
            ]))
            .with(Role::Fixed, |p| p.z < -0.6)
            .with(Role::Handle(0), |p| p.z > 0.8 && p.x < 2.0)
            .with(Role::Handle(1), |p| p.x > 5.2);
            let bound = &mut scene.bind();
            let frame = step(bound, &targets(&scene));
            let energy = bound.step(&mut frame.clone()).unwrap().energy;
            (frame, back_substitute(bound, &targets(&scene)), energy)
        })
    };
    let one = run(1);
    assert_eq!(one, run(2));
    assert_eq!(one, run(3));
}

#[test]
fn what_is_not_finite_does_not_get_out() {
    let scene = Scene::new(shapes::icosphere(2)).with_ends(true);
    let bound = &mut scene.bind();
    let mut targets = targets(&scene);
    targets[0].translation.x = f64::NAN;
    assert_eq!(
        bound.set_targets(&targets),
        Err(SolveError::TargetNotFinite { handle: 0 })
    );
    assert_eq!(
        bound.set_targets(&[]),
        Err(SolveError::TargetCount {
            found: 0,
            expected: scene.handle_count
        })
    );
    targets[0] = DAffine3::from_scale(DVec3::splat(f64::MAX));
    targets[0].translation = DVec3::splat(f64::MAX);
    let mut displacements = vec![DVec3::ONE; scene.positions().len()];
    bound.set_targets(&targets).unwrap();
    assert!(matches!(
        bound.step(&mut displacements),
        Err(SolveError::NotFinite { .. })
    ));
    assert!(displacements.iter().all(|displacement| *displacement == DVec3::ZERO));
}
