//! The laws of moving least squares.

use crate::rig::{Scene, apart, scaled, turned};
use glam::{DAffine3, DMat3, DQuat, DVec3};
use pliant_deform::{Method, MlsTransforms, OptionValue, Role};
use pliant_mesh::shapes;

fn mls(transforms: MlsTransforms, falloff: f64) -> Method {
    let values = [
        ("transforms", OptionValue::Name(transforms.name())),
        ("falloff", OptionValue::Number(falloff)),
    ];
    Method::from_name("mls").unwrap().with(values).unwrap()
}

fn ball(method: Method) -> Scene {
    let mut scene = Scene::new(shapes::icosphere(3));
    scene.method = method;
    scene
        .with(Role::Fixed, |p| p.z < -0.7)
        .with(Role::Handle(0), |p| p.z > 0.8)
        .with(Role::Handle(1), |p| p.x > 0.9)
}

/// A point, its weight, and its target.
type Point = (DVec3, f64, DVec3);

/// Every sample's six points: all vertices of the handles and all fixed ones, each as a cloud.
fn points(scene: &Scene, targets: &[DAffine3], falloff: f64, place: DVec3) -> Vec<Point> {
    let held = || (0..scene.roles.len()).filter(|&v| scene.roles[v] != Role::Free);
    let mean = held().map(|v| scene.positions()[v]).sum::<DVec3>() / held().count() as f64;
    let reach = held().map(|v| scene.positions()[v].distance(mean)).fold(0.0, f64::max);
    let cloud = 0.02 * reach;
    let mut points = Vec::new();
    for role in [Role::Handle(0), Role::Handle(1), Role::Fixed] {
        let own: Vec<DVec3> = held()
            .filter(|&v| scene.roles[v] == role)
            .map(|v| scene.positions()[v])
            .collect();
        let map = match role {
            Role::Handle(handle) => targets[usize::from(handle)],
            _ => DAffine3::IDENTITY,
        };
        let weight = |x: &DVec3| x.distance(place).powf(-falloff);
        let sum: f64 = own.iter().map(weight).sum();
        let nearest = own.iter().map(weight).fold(0.0, f64::max);
        for x in own {
            for axis in DVec3::AXES {
                for side in [-1.0, 1.0] {
                    let point = x + axis * (side * cloud * 3.0_f64.sqrt());
                    points.push((point, nearest * weight(&x) / sum / 6.0, map.transform_point3(point)));
                }
            }
        }
    }
    points
}

/// The largest eigenvector of Horn's matrix, by power iteration.
fn best_rotation(s: &DMat3) -> DMat3 {
    let s = |row: usize, column: usize| s.col(column)[row];
    let trace = s(0, 0) + s(1, 1) + s(2, 2);
    let axial = [s(2, 1) - s(1, 2), s(0, 2) - s(2, 0), s(1, 0) - s(0, 1)];
    let mut n = [[0.0; 4]; 4];
    n[0][0] = trace;
    for i in 0..3 {
        n[0][i + 1] = axial[i];
        n[i + 1][0] = axial[i];
        for j in 0..3 {
            n[i + 1][j + 1] = s(i, j) + s(j, i) - if i == j { trace } else { 0.0 };
        }
    }
    let size: f64 = n.iter().flatten().map(|v| v * v).sum::<f64>().sqrt();
    for (i, row) in n.iter_mut().enumerate() {
        row.iter_mut().for_each(|v| *v /= size);
        row[i] += 1.0;
    }
    for _ in 0..24 {
        let mut square = [[0.0; 4]; 4];
        for (i, row) in square.iter_mut().enumerate() {
            for (j, value) in row.iter_mut().enumerate() {
                *value = (0..4).map(|k| n[i][k] * n[k][j]).sum();
            }
        }
        let size: f64 = square.iter().flatten().map(|v: &f64| v * v).sum::<f64>().sqrt();
        n = square.map(|row| row.map(|v| v / size));
    }
    let column = (0..4).max_by(|&a, &b| n[a][a].total_cmp(&n[b][b])).unwrap();
    let q = DQuat::from_xyzw(n[1][column], n[2][column], n[3][column], n[0][column]);
    DMat3::from_quat(q.normalize())
}

/// The image of a point by the definition, with sums over all points.
fn defined(transforms: MlsTransforms, place: DVec3, points: &[Point]) -> DVec3 {
    let total: f64 = points.iter().map(|(_, w, _)| w).sum();
    let mean = |of: &dyn Fn(&Point) -> DVec3| points.iter().map(|p| of(p) * p.1).sum::<DVec3>() / total;
    let (from, to) = (mean(&|p| p.0), mean(&|p| p.2));
    let (mut rest, mut both) = (DMat3::ZERO, DMat3::ZERO);
    for (x, w, y) in points {
        let (x, y) = (*x - from, *y - to);
        rest += DMat3::from_cols(x * x.x, x * x.y, x * x.z) * *w;
        both += DMat3::from_cols(y * x.x, y * x.y, y * x.z) * *w;
    }
    let trace = |m: &DMat3| m.x_axis.x + m.y_axis.y + m.z_axis.z;
    let linear = match transforms {
        MlsTransforms::Affine => both * rest.inverse(),
        MlsTransforms::Rigid => best_rotation(&both),
        MlsTransforms::Similarity => {
            let r = best_rotation(&both);
            r * (trace(&(r.transpose() * both)) / trace(&rest))
        }
    };
    linear * (place - from) + to
}

#[test]
fn it_is_the_plain_sum_over_all_points() {
    for transforms in MlsTransforms::ALL {
        for falloff in [2.0, 4.0, 5.5] {
            let scene = ball(mls(transforms, falloff));
            let targets = [
                turned(DVec3::Z, 1.1, DVec3::new(0.3, 0.1, 0.4)) * scaled(DVec3::Z, DVec3::new(1.3, 0.8, 1.0)),
                turned(DVec3::X, -0.6, DVec3::Y * 0.2),
            ];
            let displacements = scene.moved(&targets);
            for (v, &place) in scene.positions().iter().enumerate().step_by(7) {
                if scene.roles[v] == Role::Free {
                    let expected = defined(transforms, place, &points(&scene, &targets, falloff, place));
                    let error = (place + displacements[v]).distance(expected);
                    assert!(error < 1e-8, "{transforms:?} {falloff} {v}: {error:e}");
                }
            }
        }
    }
}

#[test]
fn maps_of_the_kind_that_is_fitted_are_reproduced() {
    let affine = DAffine3::from_cols(
        DVec3::new(1.2, 0.3, -0.1),
        DVec3::new(-0.4, 0.9, 0.2),
        DVec3::new(0.5, 0.1, 1.4),
        DVec3::new(0.3, -2.0, 1.0),
    );
    let rigid = turned(DVec3::ONE, 2.5, DVec3::X);
    for (transforms, map) in [
        (MlsTransforms::Affine, affine),
        (MlsTransforms::Similarity, rigid * scaled(DVec3::Y, DVec3::splat(1.7))),
        (MlsTransforms::Rigid, rigid),
    ] {
        // The scenes are a ball, a plane, and one with a handle of one vertex.
        let shapes = [
            (shapes::icosphere(3), 0.8),
            (shapes::grid(9, 11), 0.8),
            (shapes::icosphere(2), 0.999),
        ];
        for (number, (drawn, high)) in shapes.into_iter().enumerate() {
            let mut scene = Scene::new(drawn);
            scene.method = mls(transforms, 4.0);
            let bounds = scene.model.bounds().unwrap();
            let share = |p: DVec3| (p.x - bounds.min.x) / bounds.extent().x;
            let scene = scene
                .with(Role::Handle(0), |p| share(p) > high)
                .with(Role::Handle(1), |p| share(p) < 0.1);
            let expected: Vec<DVec3> = scene
                .positions()
                .iter()
                .map(|p| map.transform_point3(*p) - *p)
                .collect();
            let error = apart(&scene.moved(&[map, map]), &expected);
            assert!(error < 1e-9, "{transforms:?} {number}: {error:e}");
        }
    }
}

/// Free vertices that nearly touch a handle's vertices, including handles with far more vertices than samples.
#[test]
fn the_surface_meets_every_vertex_of_a_hard_handle() {
    for (size, targets) in [
        (6, vec![turned(DVec3::ZERO, 0.8, DVec3::Z)]),
        (30, vec![turned(DVec3::ZERO, 0.8, DVec3::Z)]),
    ] {
        let gap = 1e-5;
        let mut drawn = shapes::grid(size, size);
        let twin = drawn.clone();
        let count = drawn.positions.len() as u32;
        drawn
            .positions
            .extend(twin.positions.iter().map(|p| *p + DVec3::Z * gap));
        drawn.triangles.extend(
            twin.triangles
                .iter()
                .map(|corners| corners.map(|corner| pliant_mesh::DrawnVertex(corner.0 + count))),
        );
        for transforms in MlsTransforms::ALL {
            let mut scene = Scene::new(drawn.clone());
            scene.method = mls(transforms, 4.0);
            let bounds = scene.model.bounds().unwrap();
            let share = |p: DVec3| (p.x - bounds.min.x) / bounds.extent().x;
            let scene = scene
                .with(Role::Handle(0), |p| share(p) > 0.4 && p.z < 0.5 * gap)
                .with(Role::Fixed, |p| share(p) < 0.2 && p.z < 0.5 * gap);
            let displacements = scene.moved(&targets);
            for (v, p) in scene.positions().iter().enumerate() {
                if scene.roles[v] == Role::Free && share(*p) > 0.4 {
                    let error = displacements[v].distance(targets[0].transform_point3(*p) - *p);
                    assert!(error < 1e-6, "{transforms:?} {size}: {error:e}");
                }
            }
        }
    }
}

#[test]
fn soft_handles_are_followed_the_closer_the_heavier_they_are() {
    let missed = |weight: Option<f64>| {
        let mut scene = ball(mls(MlsTransforms::Rigid, 4.0));
        scene.soft = vec![weight, None];
        let targets = [turned(DVec3::Z, 0.5, DVec3::Z * 0.5), DAffine3::IDENTITY];
        let displacements = scene.moved(&targets);
        let own = (0..scene.roles.len()).filter(|&v| scene.roles[v] == Role::Handle(0));
        own.map(|v| displacements[v].distance(targets[0].transform_point3(scene.positions()[v]) - scene.positions()[v]))
            .fold(0.0, f64::max)
    };
    let all = [Some(0.1), Some(1.0), Some(100.0), None].map(missed);
    assert!(
        all.is_sorted_by(|a, b| a > b) && all[3] < 1e-12 && all[1] > 0.02,
        "{all:?}"
    );
    assert!(all[2] < 1e-3, "{all:?}");
}
