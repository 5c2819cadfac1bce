//! The laws of all methods that bend the space around the points.

use std::collections::HashMap;
use std::f64::consts::PI;

use crate::rig::{Scene, apart, far, settle, turned};
use crate::shared;
use glam::{DAffine3, DMat3, DVec3};
use pliant_deform::{Bound, Method, MlsTransforms, OptionValue, Role};
use pliant_mesh::{Drawn, DrawnVertex, shapes};

/// Every method with the options that change its result.
pub fn methods() -> Vec<Method> {
    let with = |name: &str| Method::from_name(name).unwrap();
    let set = |name: &str, option: &str, value: OptionValue| with(name).with([(option, value)]).unwrap();
    let mut methods = vec![
        with("rbf"),
        with("lattice"),
        set("lattice", "resolution", OptionValue::Whole(2)),
        set("lattice", "basis", OptionValue::Name("bernstein")),
        set("lattice", "norm", OptionValue::Name("displacement")),
        set("lattice", "falloff", OptionValue::Number(0.0)),
        with("cage"),
        set("cage", "detail", OptionValue::Whole(3)),
        set("cage", "coordinates", OptionValue::Name("harmonic"))
            .with([("detail", OptionValue::Whole(3))])
            .unwrap(),
        set("cage", "coordinates", OptionValue::Name("green"))
            .with([("detail", OptionValue::Whole(3))])
            .unwrap(),
    ];
    for transforms in MlsTransforms::ALL {
        methods.push(set("mls", "transforms", OptionValue::Name(transforms.name())));
    }
    let few = [
        ("nodes", OptionValue::Whole(24)),
        ("tolerance", OptionValue::Number(1e-9)),
    ];
    methods.push(with("embedded").with(few).unwrap());
    let few = [
        ("cells", OptionValue::Whole(100)),
        ("tolerance", OptionValue::Number(1e-9)),
    ];
    methods.push(with("space-primo").with(few).unwrap());
    methods
}

/// The methods that hold handles exactly.
fn interpolating() -> impl Iterator<Item = Method> {
    methods()
        .into_iter()
        .filter(|method| ["rbf", "mls", "embedded", "space-primo"].contains(&method.name()))
}

fn scene(drawn: Drawn, method: &Method) -> Scene {
    let mut scene = Scene::new(drawn);
    scene.method = method.clone();
    scene
}

/// Moves the handles, takes steps until nothing changes, and returns the displacements.
fn settled(bound: &mut Bound, targets: &[DAffine3]) -> Vec<DVec3> {
    settle(bound, targets).0
}

/// The same on a new binding.
fn moved(scene: &Scene, targets: &[DAffine3]) -> Vec<DVec3> {
    settled(&mut scene.bind(), targets)
}

#[test]
fn a_rigid_motion_of_all_handles_moves_everything_rigidly() {
    for method in methods() {
        for (name, drawn) in shapes::classes() {
            let scene = scene(drawn, &method).with_ends(false);
            let centre = scene.model.bounds().unwrap().centre();
            let bound = &mut scene.bind();
            for angle in [0.0, 1.0, PI, -2.0] {
                let motion = turned(centre, angle, DVec3::new(2.0, -1.0, 0.5) * scene.diagonal());
                let (displacements, _) = settle(bound, &vec![motion; scene.handle_count]);
                let expected: Vec<DVec3> = scene
                    .positions()
                    .iter()
                    .map(|p| motion.transform_point3(*p) - *p)
                    .collect();
                let error = apart(&displacements, &expected) / scene.diagonal();
                assert!(error < 1e-7, "{name} {method:?} {angle}: {error:e}");
            }
        }
    }
}

#[test]
fn what_is_fixed_and_what_rests_stays_to_the_bit() {
    for method in methods() {
        for (name, drawn) in shapes::classes() {
            let scene = scene(drawn, &method).with_ends(true);
            let bound = &mut scene.bind();
            let (displacements, _) = settle(bound, &far(&scene));
            for (role, displacement) in scene.roles.iter().zip(&displacements) {
                assert!(
                    *role != Role::Fixed || *displacement == DVec3::ZERO,
                    "{name} {method:?}"
                );
            }
            let rest = vec![DAffine3::IDENTITY; scene.handle_count];
            let (at_rest, _) = settle(bound, &rest);
            assert!(at_rest.iter().all(|d| *d == DVec3::ZERO), "{name} {method:?}");
            let jacobians = bound.jacobians().unwrap();
            assert!(jacobians.iter().all(|j| *j == glam::Mat3::ZERO));
            let (again, _) = settle(bound, &far(&scene));
            assert!(again == displacements, "{name} {method:?}: rest forgets");
        }
    }
}

#[test]
fn handles_are_met_or_the_distance_is_told() {
    for method in methods() {
        for (name, drawn) in shapes::classes() {
            let scene = scene(drawn, &method).with_ends(true);
            let bound = &mut scene.bind();
            let targets = far(&scene);
            let (mut displacements, _) = settle(bound, &targets);
            let missed = scene.roles.iter().zip(scene.positions()).zip(&displacements);
            let missed = missed.filter_map(|((role, rest), displacement)| match role {
                Role::Handle(h) => {
                    let expected = targets[usize::from(*h)].transform_point3(*rest) - *rest;
                    Some(displacement.distance(expected))
                }
                _ => None,
            });
            let missed = missed.fold(0.0, f64::max);
            let told = bound.step(&mut displacements).unwrap().handle_residual;
            let rounding = 1e-9 * scene.diagonal() + 1e-14 * scene.positions()[0].length();
            assert!((missed - told).abs() < rounding, "{name} {method:?}: {missed} {told}");
            if interpolating().any(|other| other == method) {
                assert!(told == 0.0, "{name} {method:?}");
            }
        }
    }
}

#[test]
fn turning_the_whole_problem_turns_the_result() {
    // A lattice's box, a cage's voxels, and rigid cells are along the axes of space.
    let is_free = |method: &&Method| !["lattice", "cage", "space-primo"].contains(&method.name());
    for method in methods().iter().filter(is_free) {
        // Rounding chooses among equally good centres: that does not matter only if all are used.
        let exact = method.with([("tolerance", OptionValue::Number(1e-9))]);
        let method = &exact.unwrap_or_else(|_| method.clone());
        for (name, mut drawn) in shapes::classes() {
            // Rounding also chooses among nodes at equal distances: symmetric shapes are made uneven.
            let (centre, size) = (shapes::model(drawn.clone()).bounds().unwrap().centre(), 0.3);
            for p in &mut drawn.positions {
                let q = (*p - centre) / size;
                *p += 0.02
                    * size
                    * DVec3::new(
                        (q.y + 0.7 * q.z).sin(),
                        (1.1 * q.z + q.x).sin(),
                        (q.x - 0.8 * q.y).sin(),
                    );
            }
            let with_ends = |drawn| scene(drawn, method).with_ends(true);
            // Two points do not determine the turn of space about the line through them.
            let here = with_ends(drawn.clone());
            if here.roles.iter().filter(|role| **role != Role::Free).count() < 3 {
                continue;
            }
            shared::turned_problem_turns_the_result(drawn, with_ends, settled, &format!("{name} {method:?}"));
        }
    }
}

#[test]
fn the_result_is_the_same_bit_for_bit_on_any_number_of_threads() {
    for method in methods() {
        // This is enough for more than one chunk.
        let scene = scene(shapes::torus(90, 50), &method).with_ends(true);
        let result = || {
            let bound = &mut scene.bind();
            (settle(bound, &far(&scene)).0, bound.jacobians())
        };
        shared::same_on_any_number_of_threads(result, method.name());
    }
}

#[test]
fn extreme_targets_give_finite_shapes_and_do_not_spoil_the_next() {
    for method in methods() {
        for (name, drawn) in shapes::classes() {
            // Descents from far off end early here: this law does not ask for the very minimum.
            let coarse = method.with([("tolerance", OptionValue::Number(1e-5))]);
            let scene = scene(drawn, coarse.as_ref().unwrap_or(&method)).with_ends(true);
            shared::extremes_leave_no_trace(&scene, settled, &format!("{name} {method:?}"));
        }
    }
}

#[test]
fn handles_and_what_is_fixed_may_be_anything() {
    for method in methods() {
        let single = |v: usize| move |p: DVec3| p == shapes::icosphere(1).positions[v];
        let sphere = || scene(shapes::icosphere(1), &method);
        for scene in [
            // The handle has one vertex, first with nothing fixed, then with one vertex fixed.
            sphere().with(Role::Handle(0), single(3)),
            sphere().with(Role::Handle(0), single(3)).with(Role::Fixed, single(7)),
            // Nothing free.
            sphere().with(Role::Handle(0), |_| true),
            sphere().with(Role::Fixed, |_| true).with(Role::Handle(0), single(3)),
            // Adjacent handles.
            sphere()
                .with(Role::Fixed, |p| p.z < 0.0)
                .with(Role::Handle(0), |p| p.z > 0.0 && p.x < 0.0)
                .with(Role::Handle(1), |p| p.z > 0.0 && p.x >= 0.0),
        ] {
            let targets = far(&scene);
            assert!(moved(&scene, &targets).iter().all(|d| d.is_finite()), "{method:?}");
        }
    }
}

/// Eight-sided crumbs of the radius `size` about the vertices of a shape, each loose.
fn crumbs(shape: &Drawn, size: f64) -> Drawn {
    let corners = [DVec3::X, DVec3::NEG_X, DVec3::Y, DVec3::NEG_Y, DVec3::Z, DVec3::NEG_Z];
    let (mut positions, mut triangles) = (Vec::new(), Vec::new());
    for &middle in &shape.positions {
        let first = positions.len() as u32;
        positions.extend(corners.map(|corner| middle + corner * size));
        for [a, b, c] in [
            [0, 2, 4],
            [2, 1, 4],
            [1, 3, 4],
            [3, 0, 4],
            [2, 0, 5],
            [1, 2, 5],
            [3, 1, 5],
            [0, 3, 5],
        ] {
            triangles.push([a, b, c].map(|corner| DrawnVertex(first + corner)));
        }
    }
    Drawn::once(positions, triangles)
}

#[test]
fn jacobians_are_the_derivatives_of_the_displacements() {
    let size = 1e-5;
    for method in methods() {
        // In a symmetric shape two points often have the same distance from a third: there some methods' maps have a
        // crease.
        let mut uneven = shapes::icosphere(2);
        for (number, p) in (0..).zip(&mut uneven.positions) {
            let noise = |k: f64| (f64::from(number) * k).sin();
            *p += 0.05 * DVec3::new(noise(1.3), noise(2.9), noise(4.7));
        }
        let shape = crumbs(&uneven, size);
        let scene = scene(shape.clone(), &method)
            .with(Role::Fixed, |p| p.z < -0.5)
            .with(Role::Handle(0), |p| p.z > 0.7)
            .with(Role::Handle(1), |p| p.x > 0.9);
        let bound: &mut Bound = &mut scene.bind();
        let targets = [
            turned(DVec3::Z, 0.7, DVec3::X * 0.3),
            turned(DVec3::X, -0.4, DVec3::Y * 0.2),
        ];
        let (displacements, _) = settle(bound, &targets);
        let jacobians = bound.jacobians().unwrap();
        // Welding numbers the vertices again.
        let numbers: HashMap<[u64; 3], usize> = (0..)
            .zip(scene.positions())
            .map(|(vertex, p)| (p.to_array().map(f64::to_bits), vertex))
            .collect();
        let (mut tested, mut creased) = (0, 0);
        for corners in shape.positions.chunks(6) {
            let corners: Vec<usize> = corners
                .iter()
                .map(|p| numbers[&p.to_array().map(f64::to_bits)])
                .collect();
            if corners.iter().any(|&corner| scene.roles[corner] != Role::Free) {
                continue;
            }
            tested += 1;
            let difference = |axis: usize| {
                let [ahead, behind] = [2 * axis, 2 * axis + 1].map(|corner| displacements[corners[corner]]);
                (ahead - behind) / (2.0 * size)
            };
            let expected = DMat3::from_cols(difference(0), difference(1), difference(2));
            let sum: DMat3 = corners.iter().map(|&corner| jacobians[corner].as_dmat3()).sum();
            let found = sum * (1.0 / 6.0);
            let error = (found - expected)
                .to_cols_array()
                .into_iter()
                .fold(0.0, |a: f64, b| a.max(b.abs()));
            // The mean over a crumb that a crease crosses has an error of the crease's share, which is small like the
            // crumb.
            assert!(error < 1e-2, "{method:?} {tested}: {error:e}\n{found}\n{expected}");
            creased += usize::from(error > 1e-5);
        }
        assert!(
            tested > 50 && creased <= tested / 30,
            "{method:?}: {creased} of {tested}"
        );
    }
}

#[test]
fn what_lies_beside_each_other_stays_so_though_nothing_joins_it() {
    let jitter = 1e-4;
    for method in methods() {
        let mut shape = shapes::soup(&shapes::icosphere(3));
        let corner_of: Vec<[u64; 3]> = shape.positions.iter().map(|p| p.to_array().map(f64::to_bits)).collect();
        for (number, p) in shape.positions.iter_mut().enumerate() {
            let noise = |seed: usize| ((number * 7919 + seed * 104_729) % 1009) as f64 / 1009.0 - 0.5;
            *p += DVec3::new(noise(1), noise(2), noise(3)) * jitter;
        }
        let scene = scene(shape.clone(), &method)
            .with(Role::Fixed, |p| p.z < -0.3)
            .with(Role::Handle(0), |p| p.z > 0.8);
        let target = turned(DVec3::Z, 0.6, DVec3::new(0.2, 0.1, 0.3));
        let displacements = moved(&scene, &[target]);
        let mut first: HashMap<[u64; 3], DVec3> = HashMap::new();
        let mut widest: f64 = 0.0;
        for ((drawn, corner), p) in (0..).zip(&corner_of).zip(&shape.positions) {
            let vertex = scene.model.drawn.surface_vertex(DrawnVertex(drawn)).unwrap();
            let bent = *p + displacements[vertex.index()];
            widest = widest.max(bent.distance(*first.entry(*corner).or_insert(bent)));
        }
        assert!(widest < 10.0 * jitter, "{method:?}: {widest:e}");
    }
}
