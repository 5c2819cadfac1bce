//! Soft handles: weights with the same meaning on every mesh, hard handles at one end and none at the other.

use glam::{DAffine3, DVec3};
use pliant_deform::{ArapEnergy, BilaplacianOrder, BindError, Constraints, Role};
use pliant_mesh::{Cancel, Progress, shapes};

use crate::bilaplacian::of_order;
use crate::nonlinear::{Iterative, scene};
use crate::rig::{Scene, apart, back_substitute, settle, step, turned};

/// A square plate held at its rim, with a square in it as the handle.
fn plate(cells: usize, order: BilaplacianOrder, weight: Option<f64>) -> Scene {
    let inside = |v: f64, from: f64, to: f64| v > from - 1e-9 && v < to + 1e-9;
    let mut scene = Scene::new(shapes::grid(cells, cells))
        .with(Role::Fixed, |p| {
            !(inside(p.x, 0.101, 0.899) && inside(p.y, 0.101, 0.899))
        })
        .with(Role::Handle(0), |p| inside(p.x, 0.3, 0.7) && inside(p.y, 0.3, 0.7));
    scene.method = of_order(order);
    scene.soft = vec![weight];
    scene
}

/// The handle's mean displacement for a target of 1.
fn height(scene: &Scene) -> f64 {
    let displacements = scene.moved(&[DAffine3::from_translation(DVec3::Z)]);
    let own = scene
        .roles
        .iter()
        .zip(&displacements)
        .filter(|(role, _)| **role == Role::Handle(0));
    let (sum, count) = own.fold((0.0, 0.0), |(sum, count), (_, d)| (sum + d.z, count + 1.0));
    sum / count
}

#[test]
fn a_heavier_weight_comes_nearer_from_nothing_to_a_hard_handle() {
    for order in BilaplacianOrder::ALL {
        let weights = [1e-6, 1e-3, 0.1, 1.0, 10.0, 1e3, 1e6, 1e12];
        let heights = weights.map(|weight| height(&plate(20, order, Some(weight))));
        assert!(
            heights[0] < 1e-4 && heights[7] > 1.0 - 1e-6 && heights.windows(2).all(|pair| pair[0] < pair[1] + 1e-7),
            "{order:?} {heights:?}"
        );
        let soft = plate(20, order, Some(1e12)).moved(&[turned(DVec3::ZERO, 0.3, DVec3::Z)]);
        let hard = plate(20, order, None).moved(&[turned(DVec3::ZERO, 0.3, DVec3::Z)]);
        assert!(apart(&soft, &hard) < 1e-5, "{order:?} {}", apart(&soft, &hard));
        assert!(
            heights[3] > 0.1 && heights[3] < 0.9,
            "a weight of 1 gives way: {order:?} {heights:?}"
        );
    }
}

#[test]
fn a_heavier_weight_comes_nearer_as_rigid_as_possible_too() {
    for energy in ArapEnergy::ALL {
        let method = Iterative::Arap(energy);
        let tube = |weight: Option<f64>| {
            let mut scene = scene(shapes::tube(12, 16, 4.0), method)
                .with(Role::Fixed, |p| p.z < 0.5)
                .with(Role::Handle(0), |p| p.z > 3.5);
            scene.soft = vec![weight];
            scene
        };
        let target = turned(DVec3::Z * 3.5, 0.8, DVec3::X);
        let (hard, _) = settle(&mut tube(None).bind(), &[target]);
        let size = tube(None).diagonal();
        let errors = [1e-6, 1e-3, 0.1, 1.0, 10.0, 1e3, 1e9].map(|weight| {
            let scene = tube(Some(weight));
            let (soft, _) = settle(&mut scene.bind(), &[target]);
            let handle = scene.roles.iter().map(|role| matches!(role, Role::Handle(_)));
            let own = handle.zip(soft.iter().zip(&hard)).filter(|(is_own, _)| *is_own);
            own.map(|(_, (a, b))| a.distance_squared(*b)).sum::<f64>().sqrt() / size
        });
        assert!(
            errors.windows(2).all(|pair| pair[1] < pair[0]) && errors[6] < 1e-5 && errors[0] > 0.1,
            "{energy:?} {errors:?}"
        );
    }
}

#[test]
fn soft_handles_that_move_alike_carry_everything_rigidly() {
    for energy in ArapEnergy::ALL {
        let mut scene = scene(shapes::torus(20, 10), Iterative::Arap(energy)).with_ends(false);
        scene.soft = vec![Some(0.1); scene.handle_count];
        let motion = turned(DVec3::X, 2.0, DVec3::new(1.0, -3.0, 0.5));
        let (shape, _) = settle(&mut scene.bind(), &vec![motion; scene.handle_count]);
        for (p, d) in scene.positions().iter().zip(&shape) {
            let error = (*p + *d).distance(motion.transform_point3(*p)) / scene.diagonal();
            assert!(error < 1e-6, "{energy:?}: {error:e}");
        }
    }
}

#[test]
fn a_weight_means_the_same_at_every_resolution_and_in_every_unit() {
    for order in BilaplacianOrder::ALL {
        for weight in [0.3, 3.0, 30.0] {
            let heights = [20, 40, 80].map(|cells| height(&plate(cells, order, Some(weight))));
            // The held part and the handle end half a cell further out, an error of first order.
            let [coarse, fine] = [heights[1] / heights[0] - 1.0, heights[2] / heights[1] - 1.0];
            assert!(
                fine.abs() < 0.06 && fine.abs() < 0.6 * coarse.abs() + 1e-3,
                "{order:?} {weight} {heights:?}"
            );
            let scale = DAffine3::from_scale(DVec3::splat(1024.0));
            let mut large = plate(20, order, Some(weight));
            for position in &mut large.model.surface.positions {
                *position = scale.transform_point3(*position);
            }
            let risen = large.moved(&[DAffine3::from_translation(DVec3::Z * 1024.0)]);
            let most = risen.iter().map(|d| d.z).fold(0.0, f64::max) / 1024.0;
            let here = plate(20, order, Some(weight)).moved(&[DAffine3::from_translation(DVec3::Z)]);
            assert!(
                (most - here.iter().map(|d| d.z).fold(0.0, f64::max)).abs() < 1e-7,
                "{order:?} {weight}"
            );
        }
    }
}

#[test]
fn a_stiffer_surface_gives_a_soft_handle_less() {
    let heights = [0.1, 1.0, 10.0].map(|stiffness| {
        let mut scene = plate(20, BilaplacianOrder::ThinPlate, Some(1.0));
        scene.stiffness.fill(stiffness);
        height(&scene)
    });
    assert!(heights[0] > heights[1] && heights[1] > heights[2], "{heights:?}");
}

#[test]
fn the_laws_of_hard_handles_hold_for_soft_ones_on_every_class() {
    for (name, drawn) in shapes::classes() {
        for fixed in [true, false] {
            for soft in [
                vec![Some(2.0), None],
                vec![None, Some(50.0)],
                vec![Some(0.5), Some(300.0)],
            ] {
                let mut scene = Scene::new(drawn.clone()).with_ends(fixed);
                scene.soft = soft[..scene.handle_count].to_vec();
                let label = format!("{name} {fixed} {soft:?}");
                let bound = &mut scene.bind();
                let targets: Vec<DAffine3> = (0..scene.handle_count)
                    .map(|handle| turned(scene.positions()[0], 0.7 + handle as f64, DVec3::X))
                    .collect();
                let by_bases = step(bound, &targets);
                let solution = back_substitute(bound, &targets);
                let size = solution.iter().map(|d| d.length()).fold(0.0, f64::max);
                // Bare points follow by a rigid fit, which magnifies differences.
                let first_bare = scene.model.topology.bare_points().start;
                let off = apart(&by_bases[..first_bare], &solution[..first_bare]);
                assert!(off < 1e-6 * size, "{label} {off:e}");
                let mut out = by_bases.clone();
                let energy = bound.step(&mut out).unwrap().energy;
                let least = bound.energy_of(&solution).unwrap();
                assert!(
                    (energy - least).abs() <= 1e-5 * least + 1e-9,
                    "{label}: {energy} {least}"
                );
                let mut other = solution.clone();
                for (vertex, d) in other.iter_mut().enumerate() {
                    let is_soft =
                        matches!(scene.roles[vertex], Role::Handle(h) if scene.soft[usize::from(h)].is_some());
                    if is_soft || scene.roles[vertex] == Role::Free {
                        *d += DVec3::splat(1e-3 * size * ((vertex * 7919 % 1009) as f64 / 1009.0 - 0.5));
                    }
                }
                assert!(bound.energy_of(&other).unwrap() > least, "{label}");
                if !fixed {
                    let all = vec![DAffine3::from_translation(DVec3::Z); scene.handle_count];
                    let worst = step(bound, &all)
                        .iter()
                        .map(|d| d.distance(DVec3::Z))
                        .fold(0.0, f64::max);
                    assert!(worst < 1e-9, "{label}: {worst:e}");
                }
            }
        }
    }
}

#[test]
fn a_weight_that_is_none_is_refused_and_another_method_says_that_it_holds_hard() {
    for value in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let refused = plate(8, BilaplacianOrder::ThinPlate, Some(value))
            .try_bind()
            .unwrap_err();
        assert!(matches!(refused, BindError::SoftWeight { handle: 0, .. }), "{refused}");
    }
    let mut scene = plate(8, BilaplacianOrder::ThinPlate, Some(1.0));
    scene.soft.push(None);
    assert!(matches!(
        scene.try_bind(),
        Err(BindError::Length {
            found: 2,
            expected: 1,
            ..
        })
    ));
    scene.soft.pop();
    scene.method = pliant_deform::Method::from_name("primo").unwrap();
    let bound = scene.bind();
    assert!(
        bound.warnings().iter().any(|said| said.contains("handle 0 is soft")),
        "{:?}",
        bound.warnings()
    );
    let problem = pliant_deform::Problem {
        constraints: Constraints::default(),
        ..scene.problem(&scene.method)
    };
    let ordering = pliant_deform::Ordering::of(&scene.model.topology, 1, &Progress::new(), &Cancel::new()).unwrap();
    let hard = problem.bind(&ordering, &Progress::new(), &Cancel::new()).unwrap();
    assert!(!hard.warnings().iter().any(|said| said.contains("soft")));
}
