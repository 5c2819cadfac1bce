//! The laws of coupled prisms.

use crate::rig::{Scene, apart, turned};
use glam::{DAffine3, DMat3, DVec3};
use pliant_deform::{Bound, Method, Primo, Role};
use pliant_mesh::{Drawn, DrawnVertex, SurfaceVertex, shapes};

fn primo(tolerance: f64) -> Method {
    let mut options = Primo::default();
    options.tolerance = tolerance;
    options.max_iterations = 2000;
    Method::Primo(options)
}

/// With the tolerance 1e-10.
fn scene(drawn: Drawn) -> Scene {
    let mut scene = Scene::new(drawn);
    scene.method = primo(1e-10);
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
    for (name, drawn) in shapes::classes() {
        let scene = scene(drawn).with_ends(false);
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
            assert!(error < 1e-6, "{name} {angle}: {error:e}");
            assert!(energies.len() < 10, "{name} {angle}: {}", energies.len());
        }
    }
}

#[test]
fn the_energy_never_rises_and_what_is_constrained_goes_where_it_must() {
    for (name, drawn) in shapes::classes() {
        for fixed in [true, false] {
            let scene = scene(drawn.clone()).with_ends(fixed);
            let bound = &mut scene.bind();
            let shifted = vec![DAffine3::from_translation(DVec3::X); scene.handle_count];
            for targets in [far(&scene), shifted] {
                let (displacements, energies) = solve(bound, &targets);
                for pair in energies.windows(2) {
                    assert!(pair[1] <= pair[0], "{name}: {pair:?}");
                }
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
                    assert!(error <= 1e-9 * scene.diagonal().max(1.0), "{name}: {error:e}");
                }
            }
            let (displacements, energies) = solve(bound, &vec![DAffine3::IDENTITY; scene.handle_count]);
            assert!(displacements.iter().all(|d| *d == DVec3::ZERO), "{name}");
            assert_eq!(energies, [0.0]);
        }
    }
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
    let tube = shapes::moved(
        &shapes::tube(10, 20, 8.0),
        DAffine3::from_rotation_y(std::f64::consts::FRAC_PI_2),
    );
    let ends = |drawn: Drawn, side: f64| {
        scene(drawn)
            .with(Role::Fixed, |p| p.x * side < 0.5)
            .with(Role::Handle(0), |p| p.x * side > 7.5)
    };
    let (here, there) = (ends(tube.clone(), 1.0), ends(mirrored(&tube), -1.0));
    let target = turned(DVec3::X * 7.0, 1.2, DVec3::new(-1.0, 1.0, 0.0));
    let (shape, _) = solve(&mut here.bind(), &[target]);
    let (reflection, _) = solve(&mut there.bind(), &[flip * target * flip]);
    let image_of = |p: &DVec3| {
        let image = flip.transform_point3(*p);
        there.positions().iter().position(|q| *q == image).unwrap()
    };
    let back: Vec<DVec3> = here
        .positions()
        .iter()
        .map(|p| flip.transform_vector3(reflection[image_of(p)]))
        .collect();
    let error = apart(&shape, &back) / here.diagonal();
    assert!(shape.iter().any(|d| d.length() > 1.0));
    assert!(error < 1e-4, "{error:e}");
}

#[test]
fn the_result_is_the_same_bit_for_bit_on_any_number_of_threads() {
    let mut scene = scene(shapes::torus(40, 30)).with_ends(true);
    scene.method = primo(1e-4);
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

#[test]
fn what_is_painted_stiffer_is_bent_less() {
    let mut last = f64::INFINITY;
    for stiffness in [0.01, 0.1, 1.0, 10.0, 100.0] {
        let mut scene = scene(shapes::tube(12, 24, 8.0))
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
        assert!(strain < last, "{stiffness}: {strain} {last}");
        last = strain;
    }
}

#[test]
fn a_thicker_sheet_bends_more_evenly() {
    // A cantilever whose end is turned: the thicker, the less any single joint bends.
    let mut last = f64::INFINITY;
    for thickness in [0.01, 0.05, 0.25] {
        let mut scene = scene(shapes::tube(12, 24, 8.0))
            .with(Role::Fixed, |p| p.z < 0.5)
            .with(Role::Handle(0), |p| p.z > 7.5);
        let mut options = Primo::default();
        options.thickness = thickness;
        scene.method = Method::Primo(options);
        let (d, _) = solve(&mut scene.bind(), &[turned(DVec3::Z * 7.5, 1.2, DVec3::ZERO)]);
        let moved: Vec<DVec3> = scene.positions().iter().zip(&d).map(|(p, d)| *p + *d).collect();
        let mut normals = Vec::new();
        pliant_mesh::vertex_normals(
            &scene.model.surface.triangles,
            &scene.model.topology,
            &moved,
            &mut normals,
        );
        let mut rest_normals = Vec::new();
        let rest = scene.positions();
        pliant_mesh::vertex_normals(
            &scene.model.surface.triangles,
            &scene.model.topology,
            rest,
            &mut rest_normals,
        );
        let angle = |n: &[DVec3], a: usize, b: usize| n[a].dot(n[b]).clamp(-1.0, 1.0).acos();
        let sharpest = scene
            .model
            .topology
            .edges()
            .map(|[a, b]| (angle(&normals, a.index(), b.index()) - angle(&rest_normals, a.index(), b.index())).abs())
            .fold(0.0, f64::max);
        assert!(sharpest < last, "{thickness}: {sharpest} {last}");
        last = sharpest;
    }
}

#[test]
fn extreme_targets_give_finite_shapes_and_do_not_spoil_the_next() {
    for (name, drawn) in shapes::classes() {
        let mut scene = scene(drawn).with_ends(true);
        scene.method = primo(1e-5);
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

#[test]
fn a_handle_of_one_vertex_carries_and_turns_what_is_around_it() {
    for fixed in [true, false] {
        let mut scene = scene(shapes::torus(20, 10));
        scene.roles[0] = Role::Handle(0);
        scene.handle_count = 1;
        if fixed {
            scene.roles[100] = Role::Fixed;
        }
        let here = scene.positions()[0];
        let ring: Vec<usize> = scene
            .model
            .topology
            .neighbours(SurfaceVertex(0))
            .iter()
            .map(|v| v.index())
            .collect();
        let bound = &mut scene.bind();
        let target = turned(here, 0.7, DVec3::new(0.2, 0.1, 0.3));
        let (displacements, _) = solve(bound, &[target]);
        let moved = |v: usize| scene.positions()[v] + displacements[v];
        assert!(moved(0).distance(target.transform_point3(here)) < 1e-12);
        for v in ring {
            let error = moved(v).distance(target.transform_point3(scene.positions()[v]));
            let edge = scene.positions()[v].distance(here);
            assert!(error < 0.3 * edge, "{fixed}: {error} of {edge}");
        }
        if fixed {
            assert_eq!(displacements[100], DVec3::ZERO);
        }
    }
}

#[test]
fn a_drag_ends_where_one_solve_does() {
    let mut scene = scene(shapes::tube(16, 30, 8.0))
        .with(Role::Fixed, |p| p.z < 0.5)
        .with(Role::Handle(0), |p| p.z > 7.5);
    scene.method = primo(1e-9);
    let target = |t: f64| turned(DVec3::Z * 7.5, 1.4 * t, DVec3::X * t);
    let (once, _) = solve(&mut scene.bind(), &[target(1.0)]);
    let bound = &mut scene.bind();
    for frame in 1..20 {
        // As under the hand: a few steps a frame.
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
    let mut scene = scene(shapes::tube(16, 30, 8.0)).with_ends(true);
    let mut options = Primo::default();
    options.max_iterations = 3;
    options.tolerance = 1e-12;
    scene.method = Method::Primo(options);
    let bound = &mut scene.bind();
    bound.set_targets(&far(&scene)).unwrap();
    let mut out = vec![DVec3::ZERO; scene.roles.len()];
    let steps: Vec<_> = (0..3).map(|_| bound.step(&mut out).unwrap()).collect();
    assert!(!steps[1].finished && steps[2].finished && !steps[2].converged);
}

#[test]
fn neither_unit_nor_place_matters() {
    let shape = |place: DAffine3| {
        let scene = scene(shapes::moved(&shapes::tube(10, 20, 8.0), place));
        let back = place.inverse();
        let scene = scene
            .with(Role::Fixed, |p| back.transform_point3(p).z < 0.5)
            .with(Role::Handle(0), |p| back.transform_point3(p).z > 7.5);
        let target = place * turned(DVec3::Z * 7.5, 1.2, DVec3::X) * back;
        let (d, energies) = solve(&mut scene.bind(), &[target]);
        let mut ends: Vec<DVec3> = scene
            .positions()
            .iter()
            .zip(&d)
            .map(|(p, d)| back.transform_point3(*p + *d))
            .collect();
        ends.sort_by(|a, b| (a.x + 1.7 * a.y + 2.3 * a.z).total_cmp(&(b.x + 1.7 * b.y + 2.3 * b.z)));
        (ends, energies.last().copied().unwrap())
    };
    let (here, energy) = shape(DAffine3::IDENTITY);
    for scale in [1e-3, 1e5] {
        let place = DAffine3::from_translation(DVec3::new(400.0, -200.0, 100.0) * scale)
            * DAffine3::from_scale(DVec3::splat(scale));
        let (there, other) = shape(place);
        assert!((energy - other).abs() < 1e-6 * energy, "{scale}: {energy} {other}");
        assert!(apart(&here, &there) < 1e-4, "{scale}: {:e}", apart(&here, &there));
    }
}

#[test]
fn more_prisms_than_are_solved_for_directly_obey_the_same_laws() {
    let mut scene = scene(shapes::torus(130, 90)).with_ends(true);
    scene.method = primo(1e-6);
    assert!(scene.model.surface.triangles.len() * 2 / 3 + 500 > 16_000);
    let bound = &mut scene.bind();
    let (_, energies) = solve(bound, &far(&scene));
    assert!(energies.windows(2).all(|pair| pair[1] <= pair[0]));
    assert!(energies.len() < 100, "{}", energies.len());
    let unheld = Scene {
        method: primo(1e-6),
        ..Scene::new(shapes::torus(130, 90))
    }
    .with_ends(false);
    let motion = turned(DVec3::ZERO, 2.0, DVec3::X);
    let (displacements, _) = solve(&mut unheld.bind(), &vec![motion; unheld.handle_count]);
    let expected: Vec<DVec3> = unheld
        .positions()
        .iter()
        .map(|&p| motion.transform_point3(p) - p)
        .collect();
    assert!(apart(&displacements, &expected) < 1e-6 * unheld.diagonal());
}
