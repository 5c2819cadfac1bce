//! The laws of as-rigid-as-possible deformation.

use crate::nonlinear::{self, Iterative};
use crate::rig::{Scene, apart, far, settle, turned};
use glam::{DAffine3, DVec3};
use pliant_deform::{Arap, ArapEnergy, Method, Role};
use pliant_mesh::{Drawn, SurfaceVertex, shapes};

/// With the tolerance 1e-10.
fn scene(drawn: Drawn, energy: ArapEnergy) -> Scene {
    nonlinear::scene(drawn, Iterative::Arap(energy))
}

#[test]
fn the_energy_never_rises_and_handles_go_where_they_are_told() {
    for energy in ArapEnergy::ALL {
        for (name, drawn) in shapes::classes() {
            for (fixed, soft) in [(true, None), (false, None), (true, Some(3.0)), (false, Some(3.0))] {
                let mut scene = scene(drawn.clone(), energy).with_ends(fixed);
                scene.soft = vec![None; scene.handle_count];
                scene.soft[0] = soft;
                let bound = &mut scene.bind();
                for targets in [
                    far(&scene),
                    vec![DAffine3::from_translation(DVec3::X); scene.handle_count],
                ] {
                    let (displacements, energies) = settle(bound, &targets);
                    for pair in energies.windows(2) {
                        assert!(pair[1] <= pair[0], "{name} {energy:?}: {pair:?}");
                    }
                    let last = energies.last().copied().unwrap();
                    let direct = bound.energy_of(&displacements).unwrap();
                    assert!(
                        (last - direct).abs() <= 1e-9 * last + 1e-18,
                        "{name}: {last:e} {direct:e}"
                    );
                    for (vertex, role) in scene.roles.iter().enumerate() {
                        let expected = match role {
                            Role::Fixed => DVec3::ZERO,
                            Role::Handle(0) if soft.is_some() => continue,
                            Role::Handle(handle) => {
                                let p = scene.positions()[vertex];
                                targets[usize::from(*handle)].transform_point3(p) - p
                            }
                            Role::Free => continue,
                        };
                        let error = displacements[vertex].distance(expected);
                        assert!(error <= 1e-8 * scene.diagonal().max(1.0), "{name}: {error:e}");
                    }
                }
                let (displacements, energies) = settle(bound, &vec![DAffine3::IDENTITY; scene.handle_count]);
                assert_eq!(energies, [0.0], "{name} {energy:?} {fixed}");
                assert!(displacements.iter().all(|d| *d == DVec3::ZERO), "{name}");
            }
        }
    }
}

#[test]
fn a_coarse_level_changes_the_way_and_not_the_end() {
    for energy in ArapEnergy::ALL {
        let ends = |method| {
            let scene = nonlinear::scene(shapes::tube(24, 60, 8.0), method)
                .with(Role::Fixed, |p| p.z < 0.5)
                .with(Role::Handle(0), |p| p.z > 7.5);
            let bound = &mut scene.bind();
            let mut shapes = Vec::new();
            // There, back and on, like a hand.
            for t in [0.2, 0.4, 0.6, 0.4, 0.7, 1.0] {
                let (shape, energies) = settle(bound, &[turned(DVec3::Z * 7.5, 1.2 * t, DVec3::X * t)]);
                shapes.push((shape, energies.last().copied().unwrap()));
            }
            (shapes, scene.diagonal())
        };
        let ((alone, size), (led, _)) = (ends(Iterative::Arap(energy)), ends(Iterative::Led(energy)));
        for ((alone, least), (led, energy_led)) in alone.iter().zip(&led) {
            let (error, excess) = (apart(alone, led) / size, (energy_led - least).abs() / least);
            assert!(error < 1e-4 && excess < 1e-7, "{energy:?}: {error:e} {excess:e}");
        }
    }
}

#[test]
fn a_neighbours_end_changes_the_way_and_not_the_end() {
    for energy in ArapEnergy::ALL {
        for method in [Iterative::Arap(energy), Iterative::Led(energy)] {
            // The same tube, straight and swaying.
            let swaying = |by: f64| {
                let mut tube = shapes::tube(24, 60, 8.0);
                for p in &mut tube.positions {
                    p.x += by * (0.5 * p.z).sin();
                }
                nonlinear::scene(tube, method)
                    .with(Role::Fixed, |p| p.z < 0.5)
                    .with(Role::Handle(0), |p| p.z > 7.5)
            };
            let target = |angle: f64| [turned(DVec3::Z * 7.5, angle, DVec3::X)];
            let (neighbour, _) = settle(&mut swaying(0.0).bind(), &target(1.0));
            let scene = swaying(0.1);
            let (alone, energies) = settle(&mut scene.bind(), &target(1.1));
            let begun_at = |start: &[DVec3]| {
                let bound = &mut scene.bind();
                bound.set_targets(&target(1.1)).unwrap();
                assert!(bound.begin_at(start));
                settle(bound, &target(1.1))
            };
            let (led, _) = begun_at(&neighbour);
            let error = apart(&alone, &led) / scene.diagonal();
            assert!(error < 1e-4, "{method:?}: {error:e}");
            // The nearer the start, the sooner the end.
            let (_, from_end) = begun_at(&alone);
            let steps = [from_end.len(), energies.len()];
            assert!(steps[0] < steps[1], "{method:?}: {steps:?}");
            // A start that is worse than the method's own is not taken.
            let wild: Vec<DVec3> = (0..alone.len()).map(|v| DVec3::splat((v % 7) as f64)).collect();
            assert!(begun_at(&wild).0 == alone, "{method:?}");
            assert!(!scene.bind().begin_at(&[DVec3::NAN].repeat(alone.len())), "{method:?}");
            assert!(!scene.bind().begin_at(&alone[1..]), "{method:?}");
        }
    }
}

/// A sheet of needles: every triangle obtuse.
fn obtuse() -> Drawn {
    let mut sheet = shapes::grid(7, 9);
    for p in &mut sheet.positions {
        *p = DVec3::new(p.x + 3.0 * p.y, 0.2 * p.y, 0.1 * (5.0 * p.x).sin());
    }
    sheet
}

#[test]
fn no_shape_has_less_energy_than_the_rest_shape() {
    for energy in ArapEnergy::ALL {
        for drawn in [obtuse(), shapes::torus(20, 10), shapes::broken(&shapes::icosphere(1))] {
            let scene = scene(drawn, energy).with_ends(true);
            let bound = scene.bind();
            let rest = vec![DVec3::ZERO; scene.roles.len()];
            assert!(bound.energy_of(&rest).unwrap() < 1e-28);
            for size in [1e-6, 1e-3, 1.0, 100.0] {
                let noise = |v: usize| {
                    let v = v as f64;
                    DVec3::new((v * 12.9).sin(), (v * 78.2).sin(), (v * 37.7).sin()) * size
                };
                let shape: Vec<DVec3> = (0..rest.len()).map(noise).collect();
                assert!(bound.energy_of(&shape).unwrap() > 0.0, "{energy:?} {size}");
            }
        }
    }
}

#[test]
fn a_sheet_of_obtuse_triangles_bends_smoothly() {
    let scene = scene(obtuse(), ArapEnergy::SpokesAndRims).with_ends(true);
    let bound = &mut scene.bind();
    let shift = DVec3::Z * 1e-3;
    let (displacements, _) = settle(bound, &[DAffine3::from_translation(shift)]);
    let worst = displacements.iter().map(|d| d.length()).fold(0.0, f64::max);
    assert!(worst < 3.0 * shift.length(), "{worst}");
}

#[test]
fn single_vertices_are_handles() {
    for energy in ArapEnergy::ALL {
        for fixed in [true, false] {
            let mut scene = scene(shapes::torus(20, 10), energy);
            scene.roles[0] = Role::Handle(0);
            scene.roles[100] = Role::Handle(1);
            scene.handle_count = 2;
            if fixed {
                scene.roles[55] = Role::Fixed;
            }
            let bound = &mut scene.bind();
            let targets = [
                DAffine3::from_translation(DVec3::X),
                DAffine3::from_translation(DVec3::Y),
            ];
            let (displacements, _) = settle(bound, &targets);
            assert!((displacements[0] - DVec3::X).length() < 1e-12);
            assert!((displacements[100] - DVec3::Y).length() < 1e-12);
        }
    }
}

/// The distance of a pulled vertex from its neighbours' mean, in units of the pull: a sheet held at its border, its
/// middle vertex the handle.
fn spike(energy: ArapEnergy, smoothness: f64, side: usize) -> f64 {
    let mut scene = Scene::new(shapes::grid(side, side));
    let mut options = Arap::default();
    options.energy = energy;
    options.smoothness = smoothness;
    options.tolerance = 1e-8;
    options.max_iterations = 2000;
    scene.method = Method::from(options);
    let bounds = scene.model.bounds().unwrap();
    let (centre, reach) = (bounds.centre(), 0.499 * bounds.extent());
    let middle = |a: &DVec3| a.distance(centre);
    let nearest = scene
        .positions()
        .iter()
        .copied()
        .min_by(|a, b| middle(a).total_cmp(&middle(b)))
        .unwrap();
    let scene = scene
        .with(Role::Fixed, |p| {
            (p.x - centre.x).abs() > reach.x || (p.y - centre.y).abs() > reach.y
        })
        .with(Role::Handle(0), |p| p == nearest);
    let pull = DVec3::Z * 0.2 * scene.diagonal();
    let (d, _) = settle(&mut scene.bind(), &[DAffine3::from_translation(pull)]);
    let handle = scene.positions().iter().position(|p| *p == nearest).unwrap();
    let ring = scene.model.topology.neighbours(SurfaceVertex(handle as u32));
    let mean = ring.iter().map(|v| d[v.index()]).sum::<DVec3>() / ring.len() as f64;
    (d[handle] - mean).length() / pull.length()
}

#[test]
fn a_handle_of_one_vertex_draws_no_spike_with_smoothness() {
    let rims = spike(ArapEnergy::SpokesAndRims, 0.01, 20);
    let mut last = rims;
    for smoothness in [1e-4, 1e-3, 1e-2, 1e-1] {
        let smooth = spike(ArapEnergy::Smooth, smoothness, 20);
        assert!(smooth < last, "{smoothness}: {smooth} {last}");
        last = smooth;
    }
    // With edges of half the length the second difference falls about as their square; a spike's hardly falls.
    let (coarse, fine) = (spike(ArapEnergy::Smooth, 0.01, 16), spike(ArapEnergy::Smooth, 0.01, 32));
    assert!(fine < 0.45 * coarse, "{coarse} {fine}");
    let (coarse, fine) = (
        spike(ArapEnergy::SpokesAndRims, 0.01, 16),
        spike(ArapEnergy::SpokesAndRims, 0.01, 32),
    );
    assert!(fine > 0.6 * coarse, "{coarse} {fine}");
    assert!(spike(ArapEnergy::Smooth, 0.01, 32) < 0.3 * fine, "{fine}");
}

/// A strip that is lifted at one end, free along its sides; the cells' diagonals alternate, because with parallel
/// diagonals a strip that bends also twists.
#[test]
fn a_free_border_bends_like_the_middle_with_smoothness() {
    let (along, across) = (60, 30);
    let mut strip = shapes::grid(along, across);
    for p in &mut strip.positions {
        p.x *= 2.0;
    }
    for (cell, pair) in strip.triangles.chunks_exact_mut(2).enumerate() {
        if (cell / along + cell % along) % 2 == 1 {
            let ([a, b, c], [_, _, d]) = (pair[0], pair[1]);
            pair.copy_from_slice(&[[a, b, d], [b, c, d]]);
        }
    }
    let scene = scene(strip, ArapEnergy::Smooth)
        .with(Role::Fixed, |p| p.x < 0.1)
        .with(Role::Handle(0), |p| p.x > 1.9);
    let lift = DVec3::Z * 0.4;
    let (displacements, _) = settle(&mut scene.bind(), &[DAffine3::from_translation(lift)]);
    let mut heights: Vec<(f64, f64)> = vec![(f64::INFINITY, f64::NEG_INFINITY); along + 1];
    for (p, d) in scene.positions().iter().zip(&displacements) {
        let (least, most) = &mut heights[(p.x * 30.0).round() as usize];
        (*least, *most) = (least.min(d.z), most.max(d.z));
    }
    let bulge = heights.iter().map(|(least, most)| most - least).fold(0.0, f64::max);
    assert!(bulge < 0.02 * lift.z, "{bulge}");
}

#[test]
fn bumps_do_not_slow_the_smooth_energy() {
    let steps = |bump: f64| {
        let mut tube = shapes::tube(40, 100, 8.0);
        for p in &mut tube.positions {
            let out = 1.0 + bump * (9.0 * p.y.atan2(p.x)).sin() * (9.0 * p.z).sin();
            *p = DVec3::new(p.x * out, p.y * out, p.z);
        }
        let mut scene = scene(tube, ArapEnergy::Smooth)
            .with(Role::Fixed, |p| p.z < 0.5)
            .with(Role::Handle(0), |p| p.z > 7.5);
        scene.method = Iterative::Arap(ArapEnergy::Smooth).ending_at(1e-7);
        settle(&mut scene.bind(), &[turned(DVec3::Z * 4.0, 1.2, DVec3::X)])
            .1
            .len()
    };
    let (even, bumpy) = (steps(0.0), steps(0.08));
    assert!(bumpy < 2 * even, "{even} {bumpy}");
}
