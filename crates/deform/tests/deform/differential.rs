//! The laws of all methods that change differential coordinates and reassemble the surface.

use std::f64::consts::PI;

use crate::rig::{Scene, apart, far, step, turned};
use crate::shared;
use glam::{DAffine3, DVec3};
use pliant_deform::{Method, OptionValue, Role};
use pliant_mesh::{Drawn, shapes};

/// Every method with the options that change its result.
pub fn methods() -> Vec<Method> {
    let with = |name: &str, options: &[(&str, OptionValue)]| {
        let method = Method::from_name(name).unwrap();
        method.with(options.iter().copied()).unwrap()
    };
    let named = |option, name: &'static str| [(option, OptionValue::Name(name))];
    vec![
        with("poisson", &[]),
        with("poisson", &named("propagation", "geodesic")),
        with("poisson", &named("propagation", "material")),
        with("laplacian", &[]),
        with("laplacian", &named("scale", "free")),
        with(
            "laplacian",
            &[("steps", OptionValue::Whole(3)), ("ring", OptionValue::Whole(2))],
        ),
        with("laplacian", &named("transforms", "initial-guess")),
        with("laplacian", &named("transforms", "none")),
        with("frames", &[]),
        with("bilaplacian", &named("detail", "normal-displacements")),
        with("bilaplacian", &named("detail", "deformation-transfer")),
        with("bilaplacian", &named("detail", "displacement-volumes")),
    ]
}

fn scene(drawn: Drawn, method: &Method) -> Scene {
    let mut scene = Scene::new(drawn);
    scene.method = method.clone();
    scene
}

/// A tube along z, fixed below, with its upper end as the handle.
pub fn tube(method: &Method) -> Scene {
    scene(shapes::tube(12, 24, 8.0), method)
        .with(Role::Fixed, |p| p.z < 0.5)
        .with(Role::Handle(0), |p| p.z > 7.5)
}

#[test]
fn a_rigid_motion_of_all_handles_moves_everything_rigidly() {
    // Laplacian editing linearises turns.
    for method in methods().iter().filter(|method| method.name() != "laplacian") {
        for (name, drawn) in shapes::classes() {
            let scene = scene(drawn, method).with_ends(false);
            let centre = scene.model.bounds().unwrap().centre();
            let bound = &mut scene.bind();
            for angle in [0.0, 1.0, PI, -2.0] {
                let motion = turned(centre, angle, DVec3::new(2.0, -1.0, 0.5) * scene.diagonal());
                let displacements = step(bound, &vec![motion; scene.handle_count]);
                let moved = |p: &DVec3| motion.transform_point3(*p) - *p;
                let expected: Vec<DVec3> = scene.positions().iter().map(moved).collect();
                let error = apart(&displacements, &expected) / scene.diagonal();
                assert!(error < 1e-7, "{name} {method:?} {angle}: {error:e}");
            }
        }
    }
}

#[test]
fn where_nothing_is_fixed_a_translation_moves_everything_by_itself() {
    for method in methods() {
        for (name, drawn) in shapes::classes() {
            let scene = scene(drawn, &method).with_ends(false);
            let shift = DVec3::new(0.7, -3.0, 0.2) * scene.diagonal();
            let moved = scene.moved(&vec![DAffine3::from_translation(shift); scene.handle_count]);
            let worst = moved.iter().map(|d| d.distance(shift)).fold(0.0, f64::max);
            assert!(worst < 1e-7 * shift.length(), "{name} {method:?}: {worst:e}");
        }
    }
}

#[test]
fn handles_go_where_they_are_told_and_what_rests_stays_to_the_bit() {
    for method in methods() {
        for (name, drawn) in shapes::classes() {
            let scene = scene(drawn, &method).with_ends(true);
            let bound = &mut scene.bind();
            let targets = far(&scene);
            let displacements = step(bound, &targets);
            for ((&role, &rest), &displacement) in scene.roles.iter().zip(scene.positions()).zip(&displacements) {
                match role {
                    Role::Fixed => assert_eq!(displacement, DVec3::ZERO, "{name}"),
                    Role::Handle(h) => {
                        let expected = targets[usize::from(h)].transform_point3(rest) - rest;
                        let error = displacement.distance(expected);
                        assert!(error < 1e-9 * scene.diagonal() + 1e-14 * rest.length(), "{name}");
                    }
                    Role::Free => {}
                }
            }
            let rest = vec![DAffine3::IDENTITY; scene.handle_count];
            assert!(
                step(bound, &rest).iter().all(|d| *d == DVec3::ZERO),
                "{name} {method:?}"
            );
            assert!(
                step(bound, &targets) == displacements,
                "{name} {method:?}: rest forgets"
            );
        }
    }
}

#[test]
fn turning_the_whole_problem_turns_the_result() {
    for method in methods() {
        for (name, drawn) in shapes::classes() {
            let with_ends = |drawn| scene(drawn, &method).with_ends(true);
            shared::turned_problem_turns_the_result(drawn, with_ends, step, &format!("{name} {method:?}"));
        }
    }
}

#[test]
fn the_result_is_the_same_bit_for_bit_on_any_number_of_threads() {
    for method in methods() {
        // This is enough for more than one chunk.
        let scene = scene(shapes::torus(90, 40), &method).with_ends(true);
        let result = || {
            let bound = &mut scene.bind();
            let frame = step(bound, &far(&scene));
            let energy = bound.step(&mut frame.clone()).unwrap().energy;
            (frame, energy)
        };
        shared::same_on_any_number_of_threads(result, method.name());
    }
}

#[test]
fn extreme_targets_give_finite_shapes_and_do_not_spoil_the_next() {
    for method in methods() {
        for (name, drawn) in shapes::classes() {
            let scene = scene(drawn, &method).with_ends(true);
            shared::extremes_leave_no_trace(&scene, step, &format!("{name} {method:?}"));
        }
    }
}

#[test]
fn a_heavier_soft_handle_comes_nearer_to_a_hard_one() {
    for method in methods() {
        let target = turned(DVec3::Z * 7.5, 0.8, DVec3::X);
        let hard = tube(&method).moved(&[target]);
        let errors = [1e-3, 0.1, 10.0, 1e3, 1e9].map(|weight| {
            let mut scene = tube(&method);
            scene.soft = vec![Some(weight)];
            let soft = scene.moved(&[target]);
            let own = (0..soft.len()).filter(|&v| scene.roles[v] == Role::Handle(0));
            own.map(|v| soft[v].distance(hard[v])).fold(0.0, f64::max) / scene.diagonal()
        });
        assert!(
            errors.windows(2).all(|pair| pair[1] < pair[0]) && errors[4] < 1e-5 && errors[0] > 0.05,
            "{method:?} {errors:?}"
        );
    }
}

#[test]
fn nothing_else_has_as_little_energy() {
    for method in methods() {
        let scene = tube(&method);
        let bound = &mut scene.bind();
        let shape = step(bound, &[turned(DVec3::Z * 7.5, 1.0, DVec3::X)]);
        let Some(least) = bound.energy_of(&shape) else { continue };
        let reported = bound.step(&mut shape.clone()).unwrap().energy;
        assert!(
            (reported - least).abs() <= 1e-9 * least,
            "{method:?}: {reported} {least}"
        );
        for seed in 0..5 {
            let mut other = shape.clone();
            for (vertex, d) in other.iter_mut().enumerate() {
                if scene.roles[vertex] == Role::Free {
                    *d += DVec3::splat(0.01 * ((vertex * 7919 + seed * 31) % 1009) as f64 / 1009.0);
                }
            }
            assert!(bound.energy_of(&other).unwrap() > least, "{method:?}");
        }
    }
}
