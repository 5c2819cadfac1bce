//! The laws of cages: their making, and the handles' effect on them.

use std::collections::BTreeMap;
use std::f64::consts::PI;

use crate::rig::{Scene, apart, settle, turned};
use glam::{DAffine3, DVec3};
use pliant_deform::stages::cage::{Mesh, made};
use pliant_deform::{BindError, Bound, Budget, CageCoordinates, Method, OptionValue, Role};
use pliant_mesh::{Cancel, Drawn, Progress, shapes};

pub fn cage(coordinates: CageCoordinates) -> Method {
    let name = OptionValue::Name(coordinates.name());
    Method::from_name("cage")
        .unwrap()
        .with([("coordinates", name)])
        .unwrap()
}

/// The cage made for a shape, in units of its diagonal about its centre, and the shape's points there.
pub fn made_for(drawn: &Drawn, detail: u32) -> (Mesh, Vec<DVec3>) {
    let model = shapes::model(drawn.clone());
    let bounds = model.bounds().unwrap();
    let local = |p: DVec3| (p - bounds.centre()) / bounds.diagonal();
    let points: Vec<DVec3> = model.surface.positions.iter().map(|p| local(*p)).collect();
    let triangles = model.surface.triangles.iter();
    let triangles: Vec<[DVec3; 3]> = triangles.map(|t| t.map(|v| points[v.index()])).collect();
    (made(&points, &triangles, detail), points)
}

/// The winding number of a mesh around a point, by its solid angles.
fn winding((vertices, faces): &Mesh, point: DVec3) -> f64 {
    let angle = |face: &[u32; 3]| {
        let [a, b, c] = face.map(|v| (vertices[v as usize] - point).normalize());
        2.0 * a.dot(b.cross(c)).atan2(1.0 + a.dot(b) + b.dot(c) + c.dot(a))
    };
    faces.iter().map(angle).sum::<f64>() / (4.0 * PI)
}

#[test]
fn a_made_cage_is_a_closed_manifold_around_all_points_and_as_fine_as_asked() {
    for (name, drawn) in shapes::classes() {
        let mut counts = Vec::new();
        for detail in [2, 4, 8, 12] {
            let (mesh, points) = made_for(&drawn, detail);
            let (vertices, faces) = &mesh;
            counts.push(faces.len());
            // Each edge has two faces, which use it in both directions.
            let mut edges: BTreeMap<(u32, u32), u32> = BTreeMap::new();
            for face in faces {
                for k in 0..3 {
                    *edges.entry((face[k], face[(k + 1) % 3])).or_default() += 1;
                }
            }
            for (&(a, b), &count) in &edges {
                assert!(
                    count == 1 && edges.get(&(b, a)) == Some(&1),
                    "{name} {detail}: edge {a} {b}"
                );
            }
            // The faces around a vertex are one fan.
            let mut next: Vec<BTreeMap<u32, u32>> = vec![BTreeMap::new(); vertices.len()];
            for face in faces {
                for k in 0..3 {
                    next[face[k] as usize].insert(face[(k + 1) % 3], face[(k + 2) % 3]);
                }
            }
            for (vertex, next) in next.iter().enumerate() {
                let first = *next.keys().next().unwrap();
                let (mut at, mut length) = (next[&first], 1);
                while at != first {
                    at = next[&at];
                    length += 1;
                }
                assert!(length == next.len(), "{name} {detail}: vertex {vertex}");
            }
            for point in points {
                let winding = winding(&mesh, point);
                assert!((winding - 1.0).abs() < 1e-6, "{name} {detail}: {winding}");
            }
        }
        assert!(counts.is_sorted() && counts[0] < counts[3], "{name}: {counts:?}");
    }
}

#[test]
fn points_without_triangles_have_a_cage_too() {
    for points in [vec![DVec3::ONE], vec![DVec3::ZERO, DVec3::X], vec![DVec3::ZERO; 5]] {
        let mesh = made(&points, &[], 4);
        for point in points {
            assert!((winding(&mesh, point) - 1.0).abs() < 1e-6);
        }
    }
}

#[test]
fn affine_motions_of_all_handles_are_reproduced() {
    let map = DAffine3::from_cols(
        DVec3::new(1.2, 0.3, -0.1),
        DVec3::new(-0.4, 0.9, 0.2),
        DVec3::new(0.5, 0.1, 1.4),
        DVec3::new(0.3, -2.0, 1.0),
    );
    for coordinates in CageCoordinates::ALL {
        let mut scene = Scene::new(shapes::icosphere(3));
        scene.method = cage(coordinates);
        let scene = scene
            .with(Role::Handle(0), |p| p.z > 0.6)
            .with(Role::Handle(1), |p| p.z < -0.8);
        // Green coordinates follow only similarities.
        let map = match coordinates {
            CageCoordinates::Green => turned(DVec3::X, 1.1, DVec3::Y) * DAffine3::from_scale(DVec3::splat(1.7)),
            _ => map,
        };
        let displacements = scene.moved(&[map, map]);
        let positions = scene.positions().iter();
        let expected: Vec<DVec3> = positions.map(|p| map.transform_point3(*p) - *p).collect();
        let error = apart(&displacements, &expected);
        let most = if coordinates == CageCoordinates::Green {
            1e-6
        } else {
            1e-9
        };
        assert!(error < most, "{coordinates:?}: {error:e}");
    }
}

fn bar(method: Method) -> Scene {
    let mut scene = Scene::new(shapes::bar(24, 4, 4));
    scene.method = method;
    let (low, high) = (scene.model.bounds().unwrap().min.x, scene.model.bounds().unwrap().max.x);
    scene
        .with(Role::Fixed, |p| p.x < low + 0.1 * (high - low))
        .with(Role::Handle(0), |p| p.x > high - 0.1 * (high - low))
}

/// By how much the handle is missed in the end, in world units.
fn missed(bound: &mut Bound, target: DAffine3) -> f64 {
    let (mut displacements, _) = settle(bound, &[target]);
    bound.step(&mut displacements).unwrap().handle_residual
}

#[test]
fn handles_are_nearly_met() {
    for coordinates in CageCoordinates::ALL {
        let scene = bar(cage(coordinates));
        let mut bound = scene.bind();
        let end = DVec3::X * scene.model.bounds().unwrap().max.x;
        for target in [
            DAffine3::from_translation(DVec3::Y * 0.3 * scene.diagonal()),
            turned(end, 0.7, DVec3::Y * 0.2 * scene.diagonal()),
        ] {
            let missed = missed(&mut bound, target) / scene.diagonal();
            assert!(missed < 0.01, "{coordinates:?}: {missed}");
        }
    }
}

#[test]
fn green_coordinates_meet_handles_as_mean_values_do_and_never_raise_the_energy() {
    for (name, drawn) in [
        ("sphere", shapes::icosphere(2)),
        ("torus", shapes::torus(24, 12)),
        ("bar", shapes::bar(16, 3, 3)),
        ("sheet", shapes::grid(11, 11)),
        ("tube", shapes::tube(12, 9, 5.0)),
    ] {
        let ends = |coordinates: CageCoordinates| {
            let mut scene = Scene::new(drawn.clone());
            scene.method = cage(coordinates).with([("detail", OptionValue::Whole(4))]).unwrap();
            let bounds = scene.model.bounds().unwrap();
            let axis = (0..3)
                .max_by(|&a, &b| bounds.extent()[a].total_cmp(&bounds.extent()[b]))
                .unwrap();
            let share = move |p: DVec3| (p[axis] - bounds.min[axis]) / bounds.extent()[axis];
            let scene = scene.with(Role::Fixed, move |p| share(p) < 0.3);
            (scene.with(Role::Handle(0), move |p| share(p) > 0.85), axis)
        };
        let (of_mean_values, axis) = ends(CageCoordinates::MeanValue);
        let (of_green, _) = ends(CageCoordinates::Green);
        let bounds = of_green.model.bounds().unwrap();
        let size = bounds.diagonal();
        let across = DVec3::AXES[(axis + 1) % 3];
        let mut bound = of_green.bind();
        for target in [
            DAffine3::from_translation(across * 0.2 * size),
            turned(bounds.max, 1.0, across * 0.1 * size),
        ] {
            let by_mean_values = missed(&mut of_mean_values.bind(), target);
            let by_green = missed(&mut bound, target);
            // Handles that are missed by less than a thousandth look as if they were met.
            assert!(
                by_green < 2.0 * by_mean_values.max(1e-3 * size),
                "{name}: {by_green} {by_mean_values}"
            );
            let (_, energies) = settle(&mut of_green.bind(), &[target]);
            assert!(energies.is_sorted_by(|a, b| a >= b), "{name}: {energies:?}");
        }
    }
}

#[test]
fn soft_handles_yield_and_follow_their_weight() {
    for coordinates in CageCoordinates::ALL {
        let reached = |weight: f64| {
            let mut scene = bar(cage(coordinates));
            for role in &mut scene.roles {
                if matches!(role, Role::Handle(_)) {
                    *role = Role::Fixed;
                }
            }
            let bounds = scene.model.bounds().unwrap();
            let mut scene = scene.with(Role::Handle(0), |p| {
                (p.x - bounds.centre().x).abs() < 0.05 * bounds.extent().x
            });
            scene.soft = vec![Some(weight)];
            let (displacements, _) = settle(&mut scene.bind(), &[DAffine3::from_translation(DVec3::Y)]);
            let own = scene.roles.iter().zip(&displacements);
            let own: Vec<f64> = own
                .filter(|(role, _)| **role != Role::Fixed && **role != Role::Free)
                .map(|(_, d)| d.y)
                .collect();
            own.iter().sum::<f64>() / own.len() as f64
        };
        let ways = [1e-3, 1.0, 1e2, 1e6].map(reached);
        assert!(
            ways.is_sorted() && ways[0] < 0.3 && ways[3] > 0.9,
            "{coordinates:?}: {ways:?}"
        );
    }
}

#[test]
fn a_raised_flag_and_a_small_budget_end_the_binding() {
    for coordinates in CageCoordinates::ALL {
        let scene = bar(cage(coordinates));
        let problem = scene.problem(&scene.method);
        for looks in 0..3 {
            let cancelled = problem.bind(None, &Progress::new(), &Cancel::after_looks(looks));
            assert!(
                matches!(cancelled, Err(BindError::Cancelled(_))),
                "{coordinates:?} {looks}"
            );
        }
        let budget = Budget {
            bytes: 1 << 19,
            ..Default::default()
        };
        let refused = problem.bind_within(None, budget, &Progress::new(), &Cancel::new());
        assert!(
            matches!(refused, Err(BindError::Budget { .. })),
            "{coordinates:?}: {refused:?}"
        );
    }
}

#[test]
fn harmonic_coordinates_keep_limbs_apart_that_mean_values_join() {
    // Two adjacent long bars, joined at one end: one tip moves.
    let long = |y: f64| shapes::moved(&shapes::bar(24, 2, 2), DAffine3::from_translation(DVec3::Y * y));
    let one = shapes::model(long(0.0));
    let extent = one.bounds().unwrap().extent();
    let low = one.bounds().unwrap().min;
    let joint = shapes::moved(&shapes::bar(4, 12, 2), DAffine3::IDENTITY);
    let bounds = shapes::model(joint.clone()).bounds().unwrap();
    let scale = DVec3::new(0.1 * extent.x, 6.0 * extent.y, extent.z) / bounds.extent();
    let joint = shapes::moved(
        &joint,
        DAffine3::from_translation(low) * DAffine3::from_scale(scale) * DAffine3::from_translation(-bounds.min),
    );
    let pair = shapes::together(&[long(0.0), long(5.0 * extent.y), joint]);
    let follows = |coordinates: CageCoordinates| {
        let mut scene = Scene::new(pair.clone());
        let detail = [("detail", OptionValue::Whole(12))];
        scene.method = cage(coordinates).with(detail).unwrap();
        let tip = low.x + 0.95 * extent.x;
        let middle = low.y + 3.0 * extent.y;
        let scene = scene
            .with(Role::Fixed, |p| p.x < low.x + 0.12 * extent.x)
            .with(Role::Handle(0), |p| p.x > tip && p.y < middle);
        let (displacements, _) = settle(&mut scene.bind(), &[DAffine3::from_translation(DVec3::Z)]);
        let others = scene
            .positions()
            .iter()
            .zip(&displacements)
            .filter(|(p, _)| p.y > middle);
        others.map(|(_, d)| d.length()).fold(0.0, f64::max)
    };
    let [mean_value, harmonic] = [CageCoordinates::MeanValue, CageCoordinates::Harmonic].map(follows);
    assert!(harmonic < 0.5 * mean_value, "{harmonic} {mean_value}");
}

#[test]
fn where_all_is_held_a_cage_is_made_around_all_and_nothing_moves() {
    for coordinates in [
        CageCoordinates::MeanValue,
        CageCoordinates::Harmonic,
        CageCoordinates::Green,
    ] {
        let mut scene = Scene::new(shapes::icosphere(2)).with(Role::Fixed, |_| true);
        scene.method = cage(coordinates);
        let (displacements, _) = settle(&mut scene.bind(), &[]);
        assert!(displacements.iter().all(|d| *d == DVec3::ZERO), "{coordinates:?}");
    }
}
