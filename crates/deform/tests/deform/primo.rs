//! The laws of coupled prisms.

use crate::nonlinear::{self, Iterative};
use crate::rig::{Scene, apart, far, settle, turned};
use glam::{DAffine3, DVec3};
use pliant_deform::{Method, Primo, Role};
use pliant_mesh::{Drawn, SurfaceVertex, shapes};

/// With the tolerance 1e-10.
fn scene(drawn: Drawn) -> Scene {
    nonlinear::scene(drawn, Iterative::Primo)
}

#[test]
fn the_energy_never_rises_and_what_is_constrained_goes_where_it_must() {
    for (name, drawn) in shapes::classes() {
        for fixed in [true, false] {
            let scene = scene(drawn.clone()).with_ends(fixed);
            let bound = &mut scene.bind();
            let shifted = vec![DAffine3::from_translation(DVec3::X); scene.handle_count];
            for targets in [far(&scene), shifted] {
                let (displacements, energies) = settle(bound, &targets);
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
            let (displacements, energies) = settle(bound, &vec![DAffine3::IDENTITY; scene.handle_count]);
            assert!(displacements.iter().all(|d| *d == DVec3::ZERO), "{name}");
            assert_eq!(energies, [0.0]);
        }
    }
}

#[test]
fn a_thicker_sheet_bends_more_evenly() {
    // A cantilever whose end is turned: a thicker one bends less at any single joint.
    let mut last = f64::INFINITY;
    for thickness in [0.01, 0.05, 0.25] {
        let mut scene = scene(shapes::tube(12, 24, 8.0))
            .with(Role::Fixed, |p| p.z < 0.5)
            .with(Role::Handle(0), |p| p.z > 7.5);
        let mut options = Primo::default();
        options.thickness = thickness;
        scene.method = Method::from(options);
        let (d, _) = settle(&mut scene.bind(), &[turned(DVec3::Z * 7.5, 1.2, DVec3::ZERO)]);
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
        let (displacements, _) = settle(bound, &[target]);
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
fn neither_unit_nor_place_matters() {
    let shape = |place: DAffine3| {
        let scene = scene(shapes::moved(&shapes::tube(10, 20, 8.0), place));
        let back = place.inverse();
        let scene = scene
            .with(Role::Fixed, |p| back.transform_point3(p).z < 0.5)
            .with(Role::Handle(0), |p| back.transform_point3(p).z > 7.5);
        let target = place * turned(DVec3::Z * 7.5, 1.2, DVec3::X) * back;
        let (d, energies) = settle(&mut scene.bind(), &[target]);
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
    scene.method = Iterative::Primo.ending_at(1e-6);
    assert!(scene.model.surface.triangles.len() * 2 / 3 + 500 > 16_000);
    let bound = &mut scene.bind();
    let (_, energies) = settle(bound, &far(&scene));
    assert!(energies.windows(2).all(|pair| pair[1] <= pair[0]));
    assert!(energies.len() < 100, "{}", energies.len());
    let unheld = Scene {
        method: Iterative::Primo.ending_at(1e-6),
        ..Scene::new(shapes::torus(130, 90))
    }
    .with_ends(false);
    let motion = turned(DVec3::ZERO, 2.0, DVec3::X);
    let (displacements, _) = settle(&mut unheld.bind(), &vec![motion; unheld.handle_count]);
    let expected: Vec<DVec3> = unheld
        .positions()
        .iter()
        .map(|&p| motion.transform_point3(p) - p)
        .collect();
    assert!(apart(&displacements, &expected) < 1e-6 * unheld.diagonal());
}
