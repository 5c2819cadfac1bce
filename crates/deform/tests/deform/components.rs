//! The behaviour of components without a handle, a hold, or both; and refusals.

use crate::rig::{Scene, step, turned};
use glam::{DAffine3, DVec3};
use pliant_deform::{Bilaplacian, BindError, Loose, METHODS, Method, Ordering, Role};
use pliant_mesh::{Cancel, Cancelled, Drawn, DrawnVertex, Progress, SurfaceVertex, shapes};

fn at(shape: Drawn, shift: DVec3, scale: f64) -> Drawn {
    shapes::moved(
        &shape,
        DAffine3::from_translation(shift) * DAffine3::from_scale(DVec3::splat(scale)),
    )
}

/// A bar along x, a ball above its far end, a ball above its near end.
fn bar_with_balls() -> Drawn {
    shapes::together(&[
        shapes::bar(12, 2, 2),
        at(shapes::icosphere(1), DVec3::new(11.0, 1.0, 3.2), 0.6),
        at(shapes::icosphere(1), DVec3::new(1.0, 1.0, 3.2), 0.5),
    ])
}

fn vertices_near(scene: &Scene, shape_top: bool, x_above: f64) -> Vec<usize> {
    let positions = scene.positions();
    (0..positions.len())
        .filter(|&v| (positions[v].z > 2.1) == shape_top && positions[v].x > x_above)
        .collect()
}

#[test]
fn loose_components_move_rigidly_with_the_surface_beside_them() {
    let scene = Scene::new(bar_with_balls())
        .with(Role::Fixed, |p| p.x < 4.5 && p.z < 2.1)
        .with(Role::Handle(0), |p| p.x > 6.5 && p.z < 2.1);
    let bound = &mut scene.bind();
    assert_eq!(bound.warnings().len(), 2, "{:?}", bound.warnings());
    let target = turned(DVec3::new(12.0, 1.0, 1.0), 0.7, DVec3::new(1.0, 2.0, 0.5));
    let displacements = step(bound, &[target]);
    // Beside a handle that moves rigidly, the follower has the same motion; beside a fixed part it stays.
    for v in vertices_near(&scene, true, 9.0) {
        let rest = scene.positions()[v];
        assert!(displacements[v].distance(target.transform_point3(rest) - rest) < 1e-9);
    }
    for v in vertices_near(&scene, true, -1.0)
        .into_iter()
        .filter(|&v| scene.positions()[v].x < 9.0)
    {
        assert_eq!(displacements[v], DVec3::ZERO);
    }
}

#[test]
fn a_part_on_a_loose_part_moves_with_it_as_one() {
    // A strap on a bar, and a rivet on the strap's far end.
    let strap = at(shapes::bar(40, 8, 8), DVec3::new(2.0, 0.0, 2.01), 0.25);
    let rivet = at(shapes::icosphere(1), DVec3::new(9.0, 1.0, 4.32), 0.3);
    let mut scene = Scene::new(shapes::together(&[shapes::bar(12, 2, 2), strap, rivet]))
        .with(Role::Fixed, |p| p.x < 1.0 && p.z < 2.005)
        .with(Role::Handle(0), |p| p.x > 11.0 && p.z < 2.005);
    let target = turned(DVec3::new(12.0, 1.0, 1.0), 0.9, DVec3::new(1.0, 2.0, 0.5));
    let parts: Vec<usize> = (0..scene.positions().len())
        .filter(|&v| scene.positions()[v].z > 2.005)
        .collect();
    let displacements = step(&mut scene.bind(), &[target]);
    for (&a, &b) in parts.iter().zip(parts.iter().rev()) {
        let (p, q) = (scene.positions()[a], scene.positions()[b]);
        let apart = (p + displacements[a]).distance(q + displacements[b]);
        assert!(
            (apart - p.distance(q)).abs() < 1e-9,
            "strap and rivet are one rigid body"
        );
    }
    assert!(displacements[parts[0]].length() > 0.1);
    // On a strap that bends along, the rivet moves like the strap beside it.
    scene.loose = Loose::Bend;
    let rivet_of = |v: &usize| scene.positions()[*v].z > 4.015;
    let rivet: Vec<usize> = parts.iter().copied().filter(rivet_of).collect();
    let component = scene.model.topology.component(SurfaceVertex(rivet[0] as u32));
    scene.parts = vec![(component, Loose::Follow)];
    let displacements = step(&mut scene.bind(), &[target]);
    let foot = *rivet
        .iter()
        .min_by(|&&a, &&b| scene.positions()[a].z.total_cmp(&scene.positions()[b].z))
        .unwrap();
    let beside = parts.iter().copied().filter(|v| !rivet.contains(v)).min_by(|&a, &b| {
        let distance = |v: usize| scene.positions()[v].distance(scene.positions()[foot]);
        distance(a).total_cmp(&distance(b))
    });
    let gap = displacements[beside.unwrap()].distance(displacements[foot]);
    assert!(gap < 0.15 * displacements[foot].length(), "{gap}");
}

#[test]
fn a_follower_keeps_its_shape_whatever_its_patch_does() {
    let scene = Scene::new(bar_with_balls())
        .with(Role::Fixed, |p| p.x < 1.0 && p.z < 2.1)
        .with(Role::Handle(0), |p| p.x > 11.5 && p.z < 2.1);
    let stretched = DAffine3::from_scale(DVec3::new(1.5, 0.2, 3.0));
    let displacements = step(&mut scene.bind(), &[stretched]);
    let ball = vertices_near(&scene, true, 9.0);
    let mut moved = 0.0_f64;
    for &a in &ball {
        moved = moved.max(displacements[a].length());
        for &b in &ball {
            let (p, q) = (scene.positions()[a], scene.positions()[b]);
            assert!(((p + displacements[a]).distance(q + displacements[b]) - p.distance(q)).abs() < 1e-9);
        }
    }
    assert!(moved > 0.1);
}

#[test]
fn loose_components_rest_when_they_are_told_to() {
    let mut scene = Scene::new(bar_with_balls()).with(Role::Handle(0), |p| p.z < 0.5);
    scene.loose = Loose::Rest;
    let displacements = scene.moved(&[DAffine3::from_translation(DVec3::X)]);
    for (displacement, rest) in displacements.iter().zip(scene.positions()) {
        let expected = if rest.z > 2.1 { DVec3::ZERO } else { DVec3::X };
        assert!(displacement.distance(expected) < 1e-9);
    }
}

/// A bar along x and a flat strip above all of its length.
fn bar_with_strap() -> Drawn {
    let strap = shapes::moved(
        &shapes::bar(48, 4, 1),
        DAffine3::from_translation(DVec3::new(0.0, 0.5, 2.4)) * DAffine3::from_scale(DVec3::new(0.25, 0.25, 0.05)),
    );
    shapes::together(&[shapes::bar(12, 2, 2), strap])
}

#[test]
fn a_strap_that_bends_along_goes_with_each_end_as_what_lies_under_it_does() {
    let mut scene = Scene::new(bar_with_strap())
        .with(Role::Fixed, |p| p.x < 5.5 && p.z < 2.1)
        .with(Role::Handle(0), |p| p.x > 6.5 && p.z < 2.1);
    scene.loose = Loose::Bend;
    let target = turned(DVec3::new(6.5, 1.0, 1.0), 0.9, DVec3::new(0.0, 0.3, 1.0));
    let bent = step(&mut scene.bind(), &[target]);
    let strap = vertices_near(&scene, true, -1.0);
    assert!(strap.len() > 300);
    for &v in &strap {
        let rest = scene.positions()[v];
        let carried = target.transform_point3(rest) - rest;
        if rest.x > 11.0 {
            assert!(bent[v].distance(carried) < 1e-9, "{rest}");
        } else if rest.x < 1.0 {
            assert!(bent[v].length() < 1e-12, "{rest}");
        }
    }
    // Between the two it does not tear: neighbours stay neighbours.
    for corners in &scene.model.surface.triangles {
        for (a, b) in [(0, 1), (1, 2), (2, 0)].map(|(a, b)| (corners[a].index(), corners[b].index())) {
            let (p, q) = (scene.positions()[a], scene.positions()[b]);
            if p.z > 2.1 {
                let stretch = (p + bent[a]).distance(q + bent[b]) / p.distance(q);
                assert!((0.3..3.0).contains(&stretch), "{stretch} at {p}");
            }
        }
    }
    // A rigid motion of everything is followed exactly.
    let mut whole = Scene::new(bar_with_strap()).with(Role::Handle(0), |p| p.z < 2.1);
    whole.loose = Loose::Bend;
    for (v, displacement) in step(&mut whole.bind(), &[target]).iter().enumerate() {
        let rest = whole.positions()[v];
        assert!(displacement.distance(target.transform_point3(rest) - rest) < 1e-9);
    }
}

#[test]
fn single_components_do_what_they_are_told_whatever_the_others_do() {
    let mut scene = Scene::new(bar_with_balls()).with(Role::Handle(0), |p| p.z < 2.1);
    let far = vertices_near(&scene, true, 9.0);
    let part = scene.model.topology.component(SurfaceVertex(far[0] as u32));
    scene.parts = vec![(part, Loose::Follow), (part, Loose::Rest)];
    let displacements = scene.moved(&[DAffine3::from_translation(DVec3::X)]);
    for (v, displacement) in displacements.iter().enumerate() {
        let expected = if far.contains(&v) { DVec3::ZERO } else { DVec3::X };
        assert!(displacement.distance(expected) < 1e-9);
    }
    scene.loose = Loose::Rest;
    scene.parts = vec![(part, Loose::Bend)];
    let bound = scene.bind();
    assert!(
        bound.warnings().iter().any(|sentence| sentence.contains("bends along")),
        "{:?}",
        bound.warnings()
    );
    for (v, displacement) in scene.moved(&[DAffine3::from_translation(DVec3::X)]).iter().enumerate() {
        let stays = scene.positions()[v].z > 2.1 && !far.contains(&v);
        let expected = if stays { DVec3::ZERO } else { DVec3::X };
        assert!(displacement.distance(expected) < 1e-9);
    }
}

#[test]
fn a_component_that_is_only_fixed_or_beyond_a_fixed_band_stays_and_costs_nothing() {
    let drawn = shapes::together(&[
        shapes::tube(12, 30, 30.0),
        at(shapes::icosphere(2), DVec3::new(9.0, 0.0, 0.0), 1.0),
    ]);
    let scene = Scene::new(drawn)
        .with(Role::Fixed, |p| (p.z > 9.5 && p.z < 11.5 && p.x < 5.0) || p.x > 9.9)
        .with(Role::Handle(0), |p| p.z < 0.5 && p.x < 5.0);
    let bound = &mut scene.bind();
    // Nine rings of twelve between the handle and the band of two rings.
    assert_eq!(bound.solved_count(), 9 * 12);
    assert_eq!(
        bound.free_count(),
        scene.roles.iter().filter(|role| **role == Role::Free).count()
    );
    let displacements = step(bound, &[turned(DVec3::ZERO, 1.0, DVec3::X)]);
    for (displacement, rest) in displacements.iter().zip(scene.positions()) {
        assert_eq!(*displacement == DVec3::ZERO, rest.z > 9.5 || rest.x > 5.0, "{rest}");
    }
}

#[test]
fn many_loose_components_are_counted_in_one_sentence() {
    let mut parts = vec![shapes::bar(4, 2, 2)];
    parts.extend((0..9).map(|i| at(shapes::icosphere(0), DVec3::new(f64::from(i) * 3.0, 9.0, 0.0), 1.0)));
    let scene = Scene::new(shapes::together(&parts))
        .with(Role::Handle(0), |p| p.y < 3.0 && p.x < 1.0)
        .with(Role::Fixed, |p| p.y < 3.0 && p.x > 3.0);
    let bound = scene.bind();
    assert_eq!(bound.warnings().len(), 1);
    assert!(
        bound.warnings()[0].starts_with("9 components (108 vertices"),
        "{}",
        bound.warnings()[0]
    );
}

#[test]
fn without_handles_or_without_anything_free_there_is_nothing_to_solve() {
    let scene = Scene::new(shapes::icosphere(2));
    assert!(scene.moved(&[]).iter().all(|displacement| *displacement == DVec3::ZERO));
    for declaration in METHODS {
        let mut scene = Scene::new(shapes::icosphere(2)).with(Role::Handle(0), |_| true);
        scene.method = (declaration.default)();
        let moved = scene.moved(&[DAffine3::from_translation(DVec3::Y)]);
        let farthest = moved.iter().map(|d| d.distance(DVec3::Y)).fold(0.0, f64::max);
        assert!(farthest < 1e-9, "{}: {farthest}", declaration.name);
    }
    let scene = Scene::new(Drawn::default());
    assert!(scene.moved(&[]).is_empty());
}

#[test]
fn a_handle_of_one_vertex_pulls() {
    let scene = Scene::new(shapes::grid(12, 12))
        .with(Role::Fixed, |p| p.x < 0.01 || p.x > 0.99)
        .with(Role::Handle(0), |p| p.distance(DVec3::new(0.5, 0.5, 0.0)) < 0.01);
    let handle = scene.roles.iter().position(|role| *role == Role::Handle(0)).unwrap();
    let displacements = scene.moved(&[DAffine3::from_translation(DVec3::Z)]);
    assert_eq!(displacements[handle], DVec3::Z);
    for neighbour in scene.model.topology.neighbours(SurfaceVertex(handle as u32)) {
        assert!(displacements[neighbour.index()].z > 0.3);
    }
}

#[test]
fn refusals_name_the_culprit() {
    let fresh = || Scene::new(shapes::icosphere(1)).with_ends(true);
    let mut scene = fresh();
    scene.handle_count = 2;
    assert_eq!(scene.try_bind().err(), Some(BindError::EmptyHandle { handle: 1 }));
    scene.handle_count = 0;
    assert!(matches!(
        scene.try_bind().err(),
        Some(BindError::UnknownHandle {
            handle: 0,
            handle_count: 0,
            ..
        })
    ));
    let mut scene = fresh();
    scene.stiffness[5] = 0.0;
    assert_eq!(
        scene.try_bind().err(),
        Some(BindError::Stiffness { vertex: 5, value: 0.0 })
    );
    let mut scene = fresh();
    scene.roles.pop();
    assert!(matches!(
        scene.try_bind().err(),
        Some(BindError::Length {
            found: 41,
            expected: 42,
            ..
        })
    ));
    let scene = fresh();
    let other = Ordering::of(&scene.model.topology, 1, &Progress::new(), &Cancel::new()).unwrap();
    // A plate that also resists stretching can't be solved with the Laplacian's factor alone.
    let mut plate = Bilaplacian::default();
    plate.stretching = 1.0;
    let method = Method::from(plate);
    let refused = scene
        .problem(&method)
        .bind(&other, &Progress::new(), &Cancel::new())
        .err();
    assert!(matches!(
        refused,
        Some(BindError::Ordering {
            found_power: 1,
            expected_power: 2,
            ..
        })
    ));
    let none = scene
        .problem(&method)
        .bind(None, &Progress::new(), &Cancel::new())
        .err();
    assert_eq!(none, Some(BindError::NoOrdering { expected_power: 2 }));
}

#[test]
fn cancelling_stops_ordering_and_binding() {
    let scene = Scene::new(shapes::icosphere(2)).with_ends(true);
    let cancel = Cancel::new();
    let ordering = Ordering::of(&scene.model.topology, 2, &Progress::new(), &cancel).unwrap();
    cancel.cancel();
    assert_eq!(
        Ordering::of(&scene.model.topology, 2, &Progress::new(), &cancel),
        Err(Cancelled)
    );
    let method = Method::default();
    let refused = scene.problem(&method).bind(&ordering, &Progress::new(), &cancel).err();
    assert_eq!(refused, Some(BindError::Cancelled(Cancelled)));
}

#[test]
fn crumbs_by_the_ten_thousand_go_with_the_surface_beside_them() {
    let bar = shapes::bar(3, 3, 12);
    let crumb = |number: usize| {
        let at = DVec3::new((number % 100) as f64, (number / 100) as f64, 200.0) * 0.1;
        let corners = [at, at + DVec3::X * 0.01, at + DVec3::Y * 0.01];
        Drawn::once(corners.to_vec(), vec![[0, 1, 2].map(DrawnVertex)])
    };
    let mut all = vec![bar];
    all.extend((0..10_500).map(crumb));
    let scene = Scene::new(shapes::together(&all)).with(Role::Handle(0), |p| p.z < 2.0);
    let shift = DVec3::new(0.5, -0.25, 1.0);
    let bound = &mut scene.bind();
    for displacement in step(bound, &[DAffine3::from_translation(shift)]) {
        assert!(displacement.distance(shift) < 1e-9, "{displacement}");
    }
}
