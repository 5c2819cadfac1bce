//! Meshes that are coarse, uneven or beside other parts: bends stay whole, and other parts change nothing.

use glam::{DAffine3, DQuat, DVec3};
use pliant_deform::{
    Bilaplacian, Cage, Embedded, Lattice, METHODS, Method, Needs, Primo, RigidMotion, Role, Shells, SpacePrimo,
};
use pliant_mesh::{Distortion, Drawn, DrawnVertex, shapes};

use crate::rig::{Scene, settle};

/// A tube about z whose lowest ring is fixed and whose highest one is a handle.
fn held(tube: Drawn, length: f64, method: Method) -> Scene {
    let mut scene = Scene::new(tube)
        .with(Role::Fixed, |p| p.z < 1e-6)
        .with(Role::Handle(0), |p| p.z > length - 1e-6);
    scene.method = method;
    scene
}

/// Turns the upper end about the tube's middle.
fn bent(length: f64, degrees: f64) -> DAffine3 {
    let middle = DVec3::Z * (0.5 * length);
    DAffine3::from_translation(middle)
        * DAffine3::from_rotation_x(degrees.to_radians())
        * DAffine3::from_translation(-middle)
}

/// The effect of bending the scene's upper end by 60°.
fn distorted_by_a_bend(scene: &Scene, length: f64) -> Distortion {
    let (displacements, _) = settle(&mut scene.bind(), &[bent(length, 60.0)]);
    let positions = scene.positions().iter().zip(&displacements);
    let moved: Vec<DVec3> = positions.map(|(p, d)| *p + *d).collect();
    Distortion::of(&scene.model.surface, &scene.model.topology, &moved)
}

#[test]
fn methods_of_space_bend_coarse_tubes_and_long_triangles_without_tearing_them() {
    // Vertices closer within rings than between; long triangles like those of a lathe; both at once.
    let tubes = [(8, 6, 12.0), (64, 10, 8.0), (100, 12, 20.0), (6, 24, 12.0)];
    for (around, along, length) in tubes {
        for method in [Method::from(Embedded::default()), SpacePrimo::default().into()] {
            let name = method.name();
            let scene = held(shapes::tube(around, along, length), length, method);
            let distortion = distorted_by_a_bend(&scene, length);
            assert!(
                distortion.edge_stretch_max < 3.0 && distortion.flipped_faces == 0,
                "{name} on {around} x {along}: {distortion:?}"
            );
        }
    }
}

#[test]
fn rigid_cells_fill_a_shape_that_the_region_cuts_open_however_many_they_are() {
    let length = 10.0;
    let bar = shapes::moved(&shapes::bar(4, 4, 20), DAffine3::from_scale(DVec3::splat(0.5)));
    // Cut open at the border of the fixed part, and open by itself.
    let mut open = bar.clone();
    let is_lid = |t: &[DrawnVertex; 3]| t.iter().all(|v| bar.positions[v.index()].z < 1e-9);
    open.triangles.retain(|t| !is_lid(t));
    for drawn in [bar.clone(), open] {
        for cells in [400, 3000] {
            let mut options = SpacePrimo::default();
            options.cells = cells;
            let mut scene = Scene::new(drawn.clone())
                .with(Role::Fixed, |p| p.z < 0.3 * length)
                .with(Role::Handle(0), |p| p.z > length - 1e-6);
            scene.method = options.into();
            let distortion = distorted_by_a_bend(&scene, length);
            assert!((distortion.volume_ratio - 1.0).abs() < 0.05, "{cells}: {distortion:?}");
        }
    }
}

/// Methods with options in sizes of the bending part.
fn measured() -> [Method; 3] {
    let mut stretching = Bilaplacian::default();
    stretching.stretching = 50.0;
    [Shells::default().into(), Primo::default().into(), stretching.into()]
}

/// The displacements of the tube's drawn vertices, turned back by `motion`.
fn of_tube(drawn: Drawn, count: usize, motion: DAffine3, method: &Method) -> Vec<DVec3> {
    let back = motion.inverse();
    let length = 6.0;
    let mut scene = Scene::new(drawn)
        .with(Role::Fixed, |p| back.transform_point3(p).z < 1e-6)
        .with(Role::Handle(0), |p| {
            let p = back.transform_point3(p);
            (p.z - length).abs() < 1e-6 && p.truncate().length() < 2.0
        });
    let far = |p: DVec3| back.transform_point3(p).truncate().length() > 50.0;
    for (role, &p) in scene.roles.iter_mut().zip(&scene.model.surface.positions) {
        if far(p) {
            *role = Role::Free;
        }
    }
    scene.method = method.clone();
    let target = motion * bent(length, 70.0) * back;
    let (displacements, _) = settle(&mut scene.bind(), &[target]);
    let of_drawn = (0..count as u32).map(DrawnVertex);
    let own = |v| scene.model.drawn.surface_vertex(v).unwrap();
    of_drawn
        .map(|v| back.transform_vector3(displacements[own(v).index()]))
        .collect()
}

#[test]
fn neither_a_speck_nor_a_turn_of_the_scan_changes_a_bend() {
    let tube = shapes::tube(10, 12, 6.0);
    let count = tube.positions.len();
    let speck = shapes::moved(
        &shapes::bar(1, 1, 1),
        DAffine3::from_translation(DVec3::new(300.0, 400.0, -200.0)),
    );
    let turn = DAffine3::from_rotation_translation(
        DQuat::from_rotation_y(0.7) * DQuat::from_rotation_x(1.1),
        DVec3::new(3.0, -9.0, 4.0),
    );
    for method in measured() {
        let alone = of_tube(tube.clone(), count, DAffine3::IDENTITY, &method);
        let beside = shapes::together(&[tube.clone(), speck.clone()]);
        for (drawn, motion) in [(beside, DAffine3::IDENTITY), (shapes::moved(&tube, turn), turn)] {
            let other = of_tube(drawn, count, motion, &method);
            let apart = crate::rig::apart(&alone, &other);
            assert!(apart < 1e-3, "{}: {apart}", method.name());
        }
    }
}

/// Methods of space whose box, grid or nodes cover the bending part, and those that bend all of it.
fn of_space() -> Vec<Method> {
    METHODS
        .iter()
        .map(|declaration| (declaration.default)())
        .filter(|method| method.needs() == Needs::Points && method.name() != "identity")
        .collect()
}

#[test]
fn specks_far_away_change_no_bend_of_space_and_go_along_as_they_are() {
    let tube = shapes::tube(10, 12, 6.0);
    let count = tube.positions.len();
    let half = DAffine3::from_scale(DVec3::splat(0.5));
    let at = |shape: Drawn, place: DVec3| shapes::moved(&shape, DAffine3::from_translation(place) * half);
    let speck = at(shapes::bar(1, 1, 1), DVec3::new(300.0, 400.0, -200.0));
    let other = at(shapes::icosphere(1), DVec3::new(-60.0, 0.0, 3.0));
    for method in of_space() {
        let name = method.name();
        let alone = of_tube(tube.clone(), count, DAffine3::IDENTITY, &method);
        let scene = shapes::together(&[tube.clone(), speck.clone(), other.clone()]);
        let beside = of_tube(scene.clone(), scene.positions.len(), DAffine3::IDENTITY, &method);
        let apart = crate::rig::apart(&alone, &beside[..count]);
        assert!(apart < 1e-6, "{name}: {apart}");
        for part in [count..count + 8, count + 8..scene.positions.len()] {
            let fit = RigidMotion::fit(&scene.positions[part.clone()], &beside[part.clone()]).unwrap();
            let off = part.map(|v| fit.displace(scene.positions[v]).distance(beside[v]));
            assert!(off.fold(0.0, f64::max) < 1e-6, "{name}");
        }
    }
}

#[test]
fn nodes_turn_inside_an_elbow_rather_than_fall_in() {
    for (around, along, length) in [(20, 44, 6.0), (8, 30, 7.0), (32, 90, 8.0)] {
        for nodes in [100, 300] {
            let mut options = Embedded::default();
            options.nodes = nodes;
            let mut scene = Scene::new(shapes::moved(
                &shapes::tube(around, along, length),
                DAffine3::from_scale(DVec3::new(0.5, 0.5, 1.0)),
            ))
            .with(Role::Fixed, |p| p.z < 0.25 * length)
            .with(Role::Handle(0), |p| p.z > 0.75 * length);
            scene.method = options.into();
            let (displacements, _) = settle(&mut scene.bind(), &[bent(length, 120.0)]);
            let moved: Vec<DVec3> = scene
                .positions()
                .iter()
                .zip(&displacements)
                .map(|(p, d)| *p + *d)
                .collect();
            let distortion = Distortion::of(&scene.model.surface, &scene.model.topology, &moved);
            assert!(
                distortion.edge_stretch_max < 4.0 && distortion.flipped_faces == 0,
                "{nodes} nodes on {around} x {along}: {distortion:?}"
            );
        }
    }
}

#[test]
fn points_that_nothing_uses_change_no_bend_of_space() {
    let length = 8.0;
    let tube = shapes::tube(12, 10, length);
    let strays = Drawn::once(
        vec![
            DVec3::new(0.3, 0.2, 3.0),
            DVec3::new(1.1, 0.0, 0.0),
            DVec3::new(0.9, 0.0, length),
            DVec3::new(-200.0, 90.0, 4.0),
        ],
        Vec::new(),
    );
    let methods: [Method; 4] = [
        Lattice::default().into(),
        Cage::default().into(),
        SpacePrimo::default().into(),
        Embedded::default().into(),
    ];
    for method in methods {
        let name = method.name();
        let shape = |drawn: Drawn| {
            let scene = held(drawn, length, method.clone());
            let (displacements, _) = settle(&mut scene.bind(), &[bent(length, 50.0)]);
            let own = |v: u32| scene.model.drawn.surface_vertex(DrawnVertex(v)).unwrap().index();
            (0..tube.positions.len() as u32)
                .map(|v| displacements[own(v)])
                .collect::<Vec<DVec3>>()
        };
        let beside = shape(shapes::together(&[tube.clone(), strays.clone()]));
        let apart = crate::rig::apart(&shape(tube.clone()), &beside);
        assert!(apart < 1e-6, "{name}: {apart}");
    }
}

#[test]
fn shells_that_are_pressed_together_keep_their_areas_and_settle() {
    let length = 8.0;
    let press = DAffine3::from_translation(DVec3::Z * (-0.4 * length));
    for (drawn, target) in [
        (shapes::tube(16, 24, length), bent(length, 120.0)),
        (shapes::tube(12, 20, length), press),
        (shapes::tube(40, 12, length), bent(length, 100.0)),
    ] {
        let scene = held(drawn, length, Shells::default().into());
        let mut bound = scene.bind();
        let (displacements, energies) = settle(&mut bound, &[target]);
        let surface = &scene.model.surface;
        let smallest = surface.triangles.iter().map(|corners| {
            let area = |moved: bool| {
                pliant_mesh::face_area(corners.map(|v| {
                    let shift = if moved { displacements[v.index()] } else { DVec3::ZERO };
                    surface.positions[v.index()] + shift
                }))
            };
            area(true) / area(false)
        });
        let smallest = smallest.fold(f64::INFINITY, f64::min);
        assert!(
            smallest > 0.05 && energies.len() <= 60,
            "{smallest} after {}",
            energies.len()
        );
    }
}
