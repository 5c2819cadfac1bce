//! The laws of the methods that move points with bodies: the embedded graph, and rigid cells of space.

use crate::rig::{Scene, apart, settle, turned};
use glam::{DAffine3, DVec3};
use pliant_deform::{Method, OptionValue, RigidMotion, Role};
use pliant_mesh::shapes;

/// An embedded graph and rigid cells, with a strict end of iteration.
fn methods() -> [Method; 2] {
    [("embedded", "nodes", 60), ("space-primo", "cells", 300)].map(|(name, size, count)| {
        let values = [
            (size, OptionValue::Whole(count)),
            ("tolerance", OptionValue::Number(1e-9)),
        ];
        Method::from_name(name).unwrap().with(values).unwrap()
    })
}

/// A bar with one end fixed, the other the handle.
fn bar(method: &Method) -> Scene {
    let mut scene = Scene::new(shapes::bar(24, 4, 4));
    scene.method = method.clone();
    let bounds = scene.model.bounds().unwrap();
    let share = move |p: DVec3| (p.x - bounds.min.x) / bounds.extent().x;
    scene
        .with(Role::Fixed, |p| share(p) < 0.1)
        .with(Role::Handle(0), |p| share(p) > 0.9)
}

#[test]
fn the_energy_never_rises() {
    for method in methods() {
        let scene = bar(&method);
        let bound = &mut scene.bind();
        for target in [turned(DVec3::ZERO, 0.5, DVec3::Y), turned(DVec3::ZERO, 2.5, DVec3::Z)] {
            let (_, energies) = settle(bound, &[target]);
            assert!(
                energies.len() < 100 && energies.is_sorted_by(|a, b| a >= b),
                "{energies:?}"
            );
        }
    }
}

/// The distance of a part's displacements from the rigid motion that fits them.
fn bent(scene: &Scene, displacements: &[DVec3], part: impl Fn(DVec3) -> bool) -> f64 {
    let own: Vec<usize> = (0..displacements.len())
        .filter(|&v| part(scene.positions()[v]))
        .collect();
    let rest: Vec<DVec3> = own.iter().map(|&v| scene.positions()[v]).collect();
    let moved: Vec<DVec3> = own.iter().map(|&v| displacements[v]).collect();
    let fit = RigidMotion::fit(&rest, &moved).unwrap();
    let expected: Vec<DVec3> = rest.iter().map(|&p| fit.displace(p)).collect();
    apart(&moved, &expected)
}

#[test]
fn painted_stiffness_stiffens() {
    for method in methods() {
        let bounds = bar(&method).model.bounds().unwrap();
        let target = DAffine3::from_translation(bounds.centre() + DVec3::new(-0.3, 0.0, 0.4) * bounds.extent().x)
            * DAffine3::from_rotation_y(-1.2)
            * DAffine3::from_translation(-bounds.centre());
        let middle = |p: DVec3| (0.35..0.6).contains(&((p.x - bounds.min.x) / bounds.extent().x));
        let bends = [1.0, 10.0, 1000.0].map(|paint| {
            let mut scene = bar(&method);
            for (stiffness, p) in scene.stiffness.iter_mut().zip(&scene.model.surface.positions) {
                if middle(*p) {
                    *stiffness = paint;
                }
            }
            let (displacements, _) = settle(&mut scene.bind(), &[target]);
            bent(&scene, &displacements, middle)
        });
        assert!(bends[1] < 0.7 * bends[0] && bends[2] < 0.5 * bends[1], "{bends:?}");
    }
}

#[test]
fn soft_handles_are_followed_the_closer_the_heavier_they_are() {
    for method in methods() {
        let missed = |weight: Option<f64>| {
            let mut scene = bar(&method);
            scene.soft = vec![weight];
            let target = turned(DVec3::ZERO, 0.3, DVec3::Y * 0.5);
            let (displacements, _) = settle(&mut scene.bind(), &[target]);
            let own = (0..scene.roles.len()).filter(|&v| scene.roles[v] == Role::Handle(0));
            own.map(|v| displacements[v].distance(target.transform_point3(scene.positions()[v]) - scene.positions()[v]))
                .fold(0.0, f64::max)
        };
        let all = [Some(1e-3), Some(0.1), Some(5.0), None].map(missed);
        assert!(all.is_sorted_by(|a, b| a > b) && all[3] < 1e-12, "{all:?}");
    }
}

#[test]
fn a_handle_of_one_vertex_turns_what_is_around_it() {
    for method in methods() {
        let tip = DVec3::new(0.0, 0.0, 1.0);
        let mut scene = Scene::new(shapes::icosphere(3));
        scene.method = method.clone();
        let nearest = scene
            .positions()
            .iter()
            .copied()
            .min_by(|a, b| a.distance(tip).total_cmp(&b.distance(tip)));
        let nearest = nearest.unwrap();
        let scene = scene
            .with(Role::Fixed, |p| p.z < -0.8)
            .with(Role::Handle(0), |p| p == nearest);
        let target = turned(nearest, 0.6, DVec3::ZERO);
        let (displacements, _) = settle(&mut scene.bind(), &[target]);
        for (p, d) in scene.positions().iter().zip(&displacements) {
            if p.distance(nearest) < 0.12 {
                let expected = target.transform_point3(*p) - *p;
                assert!(d.dot(expected) >= 0.3 * expected.length_squared(), "{d} {expected}");
            }
        }
    }
}

/// Every edge at the border of the held part keeps about its length.
#[test]
fn the_surface_does_not_tear_at_handles_and_at_what_is_fixed() {
    for method in methods() {
        let mut scene = Scene::new(shapes::grid(41, 41));
        scene.method = method.clone();
        let bounds = scene.model.bounds().unwrap();
        let share = |p: DVec3| (p.x - bounds.min.x) / bounds.extent().x;
        let scene = scene
            .with(Role::Fixed, |p| share(p) < 0.3)
            .with(Role::Handle(0), |p| share(p) > 0.7);
        let target = turned(bounds.centre(), 0.4, DVec3::ZERO);
        let (displacements, _) = settle(&mut scene.bind(), &[target]);
        let at = |v: usize| scene.positions()[v] + displacements[v];
        for [a, b] in scene.model.topology.edges().map(|edge| edge.map(|v| v.index())) {
            let ratio = at(a).distance(at(b)) / scene.positions()[a].distance(scene.positions()[b]);
            assert!((0.6..1.6).contains(&ratio), "{a} {b}: {ratio}");
        }
    }
}

#[test]
fn nodes_of_a_shape_that_is_its_own_mirror_image_bend_it_alike_on_both_sides() {
    let stretched = DAffine3::from_scale(DVec3::new(1.0, 0.8, 4.0));
    let place = DAffine3::from_rotation_translation(
        glam::DQuat::from_rotation_y(0.6) * glam::DQuat::from_rotation_z(1.1),
        DVec3::new(40.0, -7.0, 3.0),
    );
    for motion in [DAffine3::IDENTITY, place] {
        let back = motion.inverse();
        let height = |p: DVec3| back.transform_point3(p).z;
        let mut scene = Scene::new(shapes::moved(&shapes::icosphere(4), motion * stretched))
            .with(Role::Fixed, |p| height(p) < -2.5)
            .with(Role::Handle(0), |p| height(p) > 2.5);
        scene.method = Method::from_name("embedded").unwrap();
        // Across the plane whose normal is the x axis, before the shape was placed.
        let bend = DAffine3::from_translation(DVec3::Y) * DAffine3::from_rotation_x(0.9);
        let target = motion * bend * back;
        let (displacements, _) = settle(&mut scene.bind(), &[target]);
        let local: Vec<DVec3> = scene.positions().iter().map(|p| back.transform_point3(*p)).collect();
        let mirror = DVec3::new(-1.0, 1.0, 1.0);
        for (place, displacement) in local.iter().zip(&displacements) {
            let image = local.iter().position(|p| p.distance(*place * mirror) < 1e-9).unwrap();
            let [own, other] = [*displacement, displacements[image]].map(|d| back.transform_vector3(d));
            assert!(
                own.distance(other * mirror) < 1e-4 * 8.0,
                "at {place}: {own} and {other}"
            );
        }
    }
}
