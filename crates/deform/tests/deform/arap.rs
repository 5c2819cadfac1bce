//! The laws of as-rigid-as-possible deformation.

use crate::rig::{Scene, apart, turned};
use glam::{DAffine3, DMat3, DVec3};
use pliant_deform::{Arap, ArapEnergy, Bound, Method, Role};
use pliant_mesh::{Drawn, DrawnVertex, SurfaceVertex, shapes};

fn arap(energy: ArapEnergy, tolerance: f64) -> Method {
    let mut options = Arap::default();
    options.energy = energy;
    options.tolerance = tolerance;
    options.max_iterations = 2000;
    Method::Arap(options)
}

/// With the tolerance 1e-10.
fn scene(drawn: Drawn, energy: ArapEnergy) -> Scene {
    let mut scene = Scene::new(drawn);
    scene.method = arap(energy, 1e-10);
    scene
}

/// Steps until finished; the last displacements and every step's energy.
fn solve(bound: &mut Bound, targets: &[DAffine3]) -> (Vec<DVec3>, Vec<f64>) {
    let mut displacements = vec![DVec3::NAN; bound.vertex_count()];
    bound.set_targets(targets).unwrap();
    let mut energies = Vec::new();
    loop {
        let step = bound.step(&mut displacements).unwrap();
        energies.push(step.energy);
        assert!(step.energy >= 0.0 && step.energy.is_finite());
        assert!(displacements.iter().all(|d| d.is_finite()));
        if step.finished {
            return (displacements, energies);
        }
    }
}

fn scaled(centre: DVec3, scale: DVec3) -> DAffine3 {
    DAffine3::from_translation(centre) * DAffine3::from_scale(scale) * DAffine3::from_translation(-centre)
}

/// Turns and moves each handle differently, by about half a turn and half the size.
fn far(scene: &Scene) -> Vec<DAffine3> {
    let (centre, size) = (scene.model.bounds().unwrap().centre(), scene.diagonal());
    (0..scene.handle_count)
        .map(|h| turned(centre, 1.5 + h as f64, DVec3::new(0.3, -0.2, 0.1 * h as f64) * size))
        .collect()
}

#[test]
fn a_rigid_motion_of_all_handles_moves_everything_rigidly() {
    for energy in ArapEnergy::ALL {
        for (name, drawn) in shapes::classes() {
            let scene = scene(drawn, energy).with_ends(false);
            let centre = scene.model.bounds().unwrap().centre();
            let bound = &mut scene.bind();
            for angle in [0.0, 1.0, 3.0, -2.0] {
                let motion = turned(centre, angle, DVec3::new(2.0, -1.0, 0.5) * scene.diagonal());
                let (displacements, energies) = solve(bound, &vec![motion; scene.handle_count]);
                let expected: Vec<DVec3> = scene
                    .positions()
                    .iter()
                    .map(|&p| motion.transform_point3(p) - p)
                    .collect();
                let error = apart(&displacements, &expected) / scene.diagonal();
                assert!(error < 1e-6, "{name} {energy:?} {angle}: {error:e}");
                assert!(energies.len() < 10, "{name} {energy:?} {angle}: {}", energies.len());
            }
        }
    }
}

#[test]
fn the_energy_never_rises_and_handles_go_where_they_are_told() {
    for energy in ArapEnergy::ALL {
        for (name, drawn) in shapes::classes() {
            for fixed in [true, false] {
                let scene = scene(drawn.clone(), energy).with_ends(fixed);
                let bound = &mut scene.bind();
                for targets in [
                    far(&scene),
                    vec![DAffine3::from_translation(DVec3::X); scene.handle_count],
                ] {
                    let (displacements, energies) = solve(bound, &targets);
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
                let (displacements, energies) = solve(bound, &vec![DAffine3::IDENTITY; scene.handle_count]);
                assert_eq!(energies, [0.0], "{name} {energy:?} {fixed}");
                assert!(displacements.iter().all(|d| *d == DVec3::ZERO), "{name}");
            }
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
            assert_eq!(bound.energy_rest(), 0.0);
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
    let (displacements, _) = solve(bound, &[DAffine3::from_translation(shift)]);
    let worst = displacements.iter().map(|d| d.length()).fold(0.0, f64::max);
    assert!(worst < 3.0 * shift.length(), "{worst}");
}

fn mirrored(drawn: &Drawn) -> Drawn {
    let mut image = drawn.clone();
    for p in &mut image.positions {
        p.x = -p.x;
    }
    for corners in &mut image.triangles {
        let [a, b, c]: [DrawnVertex; 3] = *corners;
        *corners = [a, c, b];
    }
    image
}

#[test]
fn a_mirrored_scene_gives_the_mirrored_shape() {
    let flip = DAffine3::from_scale(DVec3::new(-1.0, 1.0, 1.0));
    for energy in ArapEnergy::ALL {
        let tube = shapes::moved(
            &shapes::tube(10, 20, 8.0),
            DAffine3::from_rotation_y(std::f64::consts::FRAC_PI_2),
        );
        let ends = |drawn: Drawn, side: f64| {
            scene(drawn, energy)
                .with(Role::Fixed, |p| p.x * side < 0.5)
                .with(Role::Handle(0), |p| p.x * side > 7.5)
        };
        let (here, there) = (ends(tube.clone(), 1.0), ends(mirrored(&tube), -1.0));
        let target = turned(DVec3::X * 7.0, 1.2, DVec3::new(-1.0, 1.0, 0.0));
        let (shape, _) = solve(&mut here.bind(), &[target]);
        let (reflection, _) = solve(&mut there.bind(), &[flip * target * flip]);
        let image_of = |p: &DVec3| {
            there
                .positions()
                .iter()
                .position(|q| *q == flip.transform_point3(*p))
                .unwrap()
        };
        let back: Vec<DVec3> = here
            .positions()
            .iter()
            .map(|p| flip.transform_vector3(reflection[image_of(p)]))
            .collect();
        let error = apart(&shape, &back) / here.diagonal();
        assert!(shape.iter().any(|d| d.length() > 1.0));
        assert!(error < 1e-4, "{energy:?}: {error:e}");
    }
}

#[test]
fn the_result_is_the_same_bit_for_bit_on_any_number_of_threads() {
    for energy in ArapEnergy::ALL {
        let mut scene = scene(shapes::torus(90, 40), energy).with_ends(true);
        scene.method = arap(energy, 1e-4);
        let results: Vec<_> = [1, 2, 3]
            .into_iter()
            .map(|threads| {
                let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
                pool.install(|| {
                    let bound = &mut scene.bind();
                    (0..2)
                        .map(|k| solve(bound, &[far(&scene)[k % scene.handle_count]]))
                        .collect::<Vec<_>>()
                })
            })
            .collect();
        assert!(results.iter().all(|result| *result == results[0]));
    }
}

#[test]
fn what_is_painted_stiffer_is_bent_less() {
    for energy in ArapEnergy::ALL {
        let mut last = f64::INFINITY;
        for stiffness in [0.01, 0.1, 1.0, 10.0, 100.0] {
            let mut scene = scene(shapes::tube(12, 24, 8.0), energy)
                .with(Role::Fixed, |p| p.z < 0.5)
                .with(Role::Handle(0), |p| p.z > 7.5);
            let inside = |p: DVec3| p.z > 2.5 && p.z < 5.5;
            for (own, &p) in scene.stiffness.iter_mut().zip(&scene.model.surface.positions) {
                *own = if inside(p) { stiffness } else { 1.0 };
            }
            let (d, _) = solve(&mut scene.bind(), &[turned(DVec3::Z * 7.5, 1.0, DVec3::X)]);
            let mut strain = 0.0;
            for (vertex, &p) in scene.positions().iter().enumerate().filter(|(_, p)| inside(**p)) {
                for &other in scene.model.topology.neighbours(SurfaceVertex(vertex as u32)) {
                    let (rest, q) = (scene.positions()[other.index()] - p, d[other.index()] - d[vertex]);
                    if inside(scene.positions()[other.index()]) {
                        strain += ((rest + q).length() / rest.length() - 1.0).powi(2);
                    }
                }
            }
            assert!(strain < last, "{energy:?} {stiffness}: {strain} {last}");
            last = strain;
        }
    }
}

#[test]
fn extreme_targets_give_finite_shapes_and_do_not_spoil_the_next() {
    for energy in ArapEnergy::ALL {
        for (name, drawn) in shapes::classes() {
            let mut scene = scene(drawn, energy).with_ends(true);
            scene.method = arap(energy, 1e-6);
            let (centre, size) = (scene.model.bounds().unwrap().centre(), scene.diagonal());
            let bound = &mut scene.bind();
            for target in [
                DAffine3::from_translation(DVec3::new(-3.0, 0.1, 0.0) * size),
                turned(centre, std::f64::consts::PI, DVec3::ZERO),
                scaled(centre, DVec3::ZERO),
                scaled(centre, DVec3::splat(-1.0)),
                scaled(centre, DVec3::new(1.0, 1.0, -2.0)),
                scaled(centre, DVec3::splat(1e4)),
                DAffine3::from_mat3(DMat3::ZERO),
                DAffine3::from_translation(DVec3::X * 1e6 * size),
            ] {
                let (_, energies) = solve(bound, &vec![target; scene.handle_count]);
                assert!(energies.windows(2).all(|pair| pair[1] <= pair[0]), "{name}");
            }
            let beyond = vec![DAffine3::from_translation(DVec3::X * 1e200); scene.handle_count];
            bound.set_targets(&beyond).unwrap();
            let mut out = vec![DVec3::NAN; scene.roles.len()];
            let refused = bound.step(&mut out).is_err();
            assert!(out.iter().all(|d| d.is_finite()) && (!refused || out.iter().all(|d| *d == DVec3::ZERO)));
            solve(bound, &far(&scene));
        }
    }
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
            let (displacements, _) = solve(bound, &targets);
            assert!((displacements[0] - DVec3::X).length() < 1e-12);
            assert!((displacements[100] - DVec3::Y).length() < 1e-12);
        }
    }
}

#[test]
fn a_drag_ends_where_one_solve_does() {
    let mut scene = scene(shapes::tube(16, 30, 8.0), ArapEnergy::SpokesAndRims)
        .with(Role::Fixed, |p| p.z < 0.5)
        .with(Role::Handle(0), |p| p.z > 7.5);
    scene.method = arap(ArapEnergy::SpokesAndRims, 1e-9);
    let target = |t: f64| turned(DVec3::Z * 7.5, 1.4 * t, DVec3::X * t);
    let (once, _) = solve(&mut scene.bind(), &[target(1.0)]);
    let bound = &mut scene.bind();
    for frame in 1..20 {
        // As under the hand: a few steps a frame.
        bound.set_targets(&[target(f64::from(frame) / 20.0)]).unwrap();
        let mut out = vec![DVec3::ZERO; scene.roles.len()];
        for iteration in 1..=3 {
            bound.set_targets(&[target(f64::from(frame) / 20.0)]).unwrap();
            assert_eq!(bound.step(&mut out).unwrap().iteration, iteration);
        }
    }
    let (dragged, _) = solve(bound, &[target(1.0)]);
    let error = apart(&once, &dragged) / scene.diagonal();
    assert!(error < 1e-3, "{error:e}");
}

#[test]
fn the_limit_ends_iteration_unconverged() {
    let mut scene = scene(shapes::tube(16, 30, 8.0), ArapEnergy::SpokesAndRims).with_ends(true);
    let mut options = Arap::default();
    options.max_iterations = 3;
    scene.method = Method::Arap(options);
    let bound = &mut scene.bind();
    bound.set_targets(&far(&scene)).unwrap();
    let mut out = vec![DVec3::ZERO; scene.roles.len()];
    let steps: Vec<_> = (0..3).map(|_| bound.step(&mut out).unwrap()).collect();
    assert!(!steps[1].finished && steps[2].finished && !steps[2].converged);
}

/// How far a pulled vertex stands out from its neighbours' mean, in units of the pull: a sheet held at its border, its
/// middle vertex the handle.
fn spike(energy: ArapEnergy, smoothness: f64, side: usize) -> f64 {
    let mut scene = Scene::new(shapes::grid(side, side));
    let mut options = Arap::default();
    options.energy = energy;
    options.smoothness = smoothness;
    options.tolerance = 1e-8;
    options.max_iterations = 2000;
    scene.method = Method::Arap(options);
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
    let (d, _) = solve(&mut scene.bind(), &[DAffine3::from_translation(pull)]);
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
    // Half the edges, and the second difference falls about as their square; a spike's hardly falls.
    let (coarse, fine) = (spike(ArapEnergy::Smooth, 0.01, 16), spike(ArapEnergy::Smooth, 0.01, 32));
    assert!(fine < 0.45 * coarse, "{coarse} {fine}");
    let (coarse, fine) = (
        spike(ArapEnergy::SpokesAndRims, 0.01, 16),
        spike(ArapEnergy::SpokesAndRims, 0.01, 32),
    );
    assert!(fine > 0.6 * coarse, "{coarse} {fine}");
    assert!(spike(ArapEnergy::Smooth, 0.01, 32) < 0.3 * fine, "{fine}");
}
