//! Normals that turn by the derivative of a map of space.
#![allow(clippy::unwrap_used, reason = "a test may panic")]

use std::collections::HashMap;

use glam::{DAffine3, DVec3, Mat3, Vec3};
use pliant_deform::{Method, Problem, Role};
use pliant_io::Appearance;
use pliant_mesh::{Cancel, Drawn, Model, Progress, shapes};
use pliant_picture::drawing::Drawing;

/// A shape, its upper cap turned and moved by radial basis functions, its lower half fixed: the model, the displacements
/// and their Jacobians.
fn bent(drawn: Drawn) -> (Model, Vec<DVec3>, Vec<Mat3>) {
    let model = shapes::model(drawn);
    let role = |p: &DVec3| match p.z {
        z if z > 0.8 => Role::Handle(0),
        z if z < -0.2 => Role::Fixed,
        _ => Role::Free,
    };
    let roles: Vec<Role> = model.surface.positions.iter().map(role).collect();
    let method = Method::from_name("rbf").unwrap();
    let stiffness = vec![1.0; roles.len()];
    let problem = Problem::new((&model.surface, &model.topology), &roles, &stiffness, &method);
    let mut bound = problem.bind(None, &Progress::new(), &Cancel::new()).unwrap();
    let turn = DAffine3::from_axis_angle(DVec3::new(0.8, 0.6, 0.0), 0.6);
    bound
        .set_targets(&[DAffine3::from_translation(DVec3::new(0.3, 0.0, 0.4)) * turn])
        .unwrap();
    let mut displacements = vec![DVec3::ZERO; roles.len()];
    bound.step(&mut displacements).unwrap();
    let jacobians = bound.jacobians().unwrap();
    (model, displacements, jacobians)
}

fn angle(a: [f32; 3], b: [f32; 3]) -> f32 {
    Vec3::from(a).angle_between(Vec3::from(b))
}

#[test]
fn on_a_fine_surface_they_are_those_of_the_triangles() {
    let (model, displacements, jacobians) = bent(shapes::icosphere(5));
    let drawing = Drawing::new(&model, Appearance::default(), Default::default());
    let by_triangles = drawing.pose(&model, &displacements).normals;
    let turned = drawing.pose_turned(&model, &displacements, &jacobians).normals;
    let worst = by_triangles
        .iter()
        .zip(&turned)
        .map(|(a, b)| angle(*a, *b))
        .fold(0.0, f32::max);
    assert!(worst < 0.06, "{worst} rad");
    // They have turned.
    let rest = vec![DVec3::ZERO; displacements.len()];
    let at_rest = drawing.pose(&model, &rest).normals;
    let way = at_rest
        .iter()
        .zip(&turned)
        .map(|(a, b)| angle(*a, *b))
        .fold(0.0, f32::max);
    assert!(way > 0.4, "{way} rad");
    let still = vec![Mat3::ZERO; rest.len()];
    assert_eq!(drawing.pose_turned(&model, &rest, &still).normals, at_rest);
}

#[test]
fn loose_triangles_that_look_smooth_at_rest_look_smooth_when_bent() {
    // Each triangle a little smaller than its place, so that none is welded to another.
    let mut soup = shapes::soup(&shapes::icosphere(3));
    let smooth: Vec<[f32; 3]> = soup.positions.iter().map(|p| p.as_vec3().to_array()).collect();
    let corner_of: Vec<[u64; 3]> = soup.positions.iter().map(|p| p.to_array().map(f64::to_bits)).collect();
    for triangle in soup.positions.chunks_mut(3) {
        let middle = (triangle[0] + triangle[1] + triangle[2]) / 3.0;
        triangle.iter_mut().for_each(|p| *p = middle + (*p - middle) * 0.999);
    }
    let (model, displacements, jacobians) = bent(soup);
    let appearance = Appearance {
        normals: Some(smooth),
        ..Appearance::default()
    };
    let drawing = Drawing::new(&model, appearance, Default::default());
    let apart = |normals: &[[f32; 3]]| {
        let mut first = HashMap::new();
        let others = corner_of.iter().zip(normals).map(|(corner, normal)| {
            let first = first.entry(corner).or_insert(*normal);
            angle(*first, *normal)
        });
        others.fold(0.0, f32::max)
    };
    let turned = apart(&drawing.pose_turned(&model, &displacements, &jacobians).normals);
    let by_triangles = apart(&drawing.pose(&model, &displacements).normals);
    assert!(turned < 0.01 && by_triangles > 3.0 * turned, "{turned} {by_triangles}");
}
