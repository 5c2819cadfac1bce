//! The laws of radial basis functions.

use crate::rig::{Scene, apart, eliminated, step, turned};
use glam::{DAffine3, DVec3};
use pliant_deform::{Method, OptionValue, Role};
use pliant_mesh::shapes;

fn rbf(tolerance: f64, centres: u32) -> Method {
    let values = [
        ("tolerance", OptionValue::Number(tolerance)),
        ("centres", OptionValue::Whole(centres)),
    ];
    Method::from_name("rbf").unwrap().with(values).unwrap()
}

fn bar(method: Method) -> Scene {
    let mut scene = Scene::new(shapes::bar(12, 2, 2));
    scene.method = method;
    let (low, high) = (scene.model.bounds().unwrap().min.x, scene.model.bounds().unwrap().max.x);
    scene
        .with(Role::Fixed, |p| p.x < low + 0.1 * (high - low))
        .with(Role::Handle(0), |p| p.x > high - 0.1 * (high - low))
}

#[test]
fn with_every_constraint_a_centre_it_is_the_dense_definition() {
    let scene = bar(rbf(1e-9, 5000));
    let target = turned(DVec3::X, 0.8, DVec3::new(0.1, 0.4, -0.2));
    let held: Vec<(DVec3, DVec3)> = scene
        .roles
        .iter()
        .zip(scene.positions())
        .filter_map(|(role, &p)| match role {
            Role::Free => None,
            Role::Fixed => Some((p, DVec3::ZERO)),
            Role::Handle(_) => Some((p, target.transform_point3(p) - p)),
        })
        .collect();
    let count = held.len();
    let mut a = vec![vec![0.0; count + 4]; count + 4];
    let mut b = vec![DVec3::ZERO; count + 4];
    for (i, (p, moved)) in held.iter().enumerate() {
        b[i] = *moved;
        for (j, (q, _)) in held.iter().enumerate() {
            a[i][j] = p.distance(*q).powi(3);
        }
        for (k, value) in [1.0, p.x, p.y, p.z].into_iter().enumerate() {
            a[i][count + k] = value;
            a[count + k][i] = value;
        }
    }
    let weights = eliminated(a, b);
    let displacements = scene.moved(&[target]);
    for ((role, p), d) in scene.roles.iter().zip(scene.positions()).zip(&displacements) {
        if *role == Role::Free {
            let kernels: DVec3 = held
                .iter()
                .zip(&weights)
                .map(|((q, _), w)| *w * p.distance(*q).powi(3))
                .sum();
            let linear =
                weights[count] + weights[count + 1] * p.x + weights[count + 2] * p.y + weights[count + 3] * p.z;
            let error = d.distance(kernels + linear);
            assert!(error < 1e-8, "{error:e}");
        }
    }
}

#[test]
fn linear_functions_are_reproduced() {
    let mut scene = Scene::new(shapes::icosphere(3));
    scene.method = rbf(1e-4, 1500);
    let scene = scene
        .with(Role::Handle(0), |p| p.z > 0.6)
        .with(Role::Handle(1), |p| p.z < -0.8);
    let map = DAffine3::from_cols(
        DVec3::new(1.2, 0.3, -0.1),
        DVec3::new(-0.4, 0.9, 0.2),
        DVec3::new(0.5, 0.1, 1.4),
        DVec3::new(0.3, -2.0, 1.0),
    );
    let displacements = scene.moved(&[map, map]);
    let expected: Vec<DVec3> = scene
        .positions()
        .iter()
        .map(|p| map.transform_point3(*p) - *p)
        .collect();
    let error = apart(&displacements, &expected);
    assert!(error < 1e-9, "{error:e}");
}

#[test]
fn fewer_centres_than_constraints_meet_the_tolerance() {
    let mut scene = Scene::new(shapes::icosphere(5));
    scene.method = rbf(1e-3, 1500);
    let scene = scene
        .with(Role::Fixed, |p| p.z < 0.0)
        .with(Role::Handle(0), |p| p.z > 0.8);
    let bound = &mut scene.bind();
    assert!(
        bound.warnings().iter().all(|said| !said.contains("misses")),
        "{:?}",
        bound.warnings()
    );
    // With so few centres it fails, and reports that.
    let mut few = scene;
    few.method = rbf(1e-9, 8);
    assert!(
        few.bind()
            .warnings()
            .iter()
            .any(|said| said.contains("misses its constraints"))
    );
    step(bound, &[turned(DVec3::Z, 0.5, DVec3::X)]);
}
