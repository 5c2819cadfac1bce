//! A place for each vertex of a handle, instead of a map.

use std::f64::consts::FRAC_PI_2;

use glam::{DAffine3, DVec3};
use pliant_deform::{Bound, METHODS, Role, SolveError, Target};
use pliant_mesh::shapes;

use crate::rig::{Scene, apart};

/// A bar with a handle at one end; the other end is fixed on request.
fn bar(method: &str, is_fixed: bool) -> Scene {
    let mut scene = Scene::new(shapes::tube(16, 40, 8.0));
    let bounds = scene.model.bounds().unwrap();
    let share = |p: DVec3| (p - bounds.min).dot(DVec3::Z) / bounds.extent().z;
    if is_fixed {
        scene = scene.with(Role::Fixed, |p| share(p) < 0.1);
    }
    scene = scene.with(Role::Handle(0), |p| share(p) > 0.9);
    scene.method = pliant_deform::Method::from_name(method).unwrap();
    scene
}

fn places(scene: &Scene, bound: &Bound, goes: impl Fn(DVec3) -> DVec3) -> Vec<DVec3> {
    let vertices = bound.handle_vertices(0).iter();
    vertices
        .map(|&vertex| goes(scene.positions()[vertex as usize]))
        .collect()
}

fn bent(bound: &mut Bound, target: Target) -> Result<Vec<DVec3>, SolveError> {
    bound.set_places(&[target])?;
    let mut displacements = vec![DVec3::ZERO; bound.vertex_count()];
    while !bound.step(&mut displacements)?.finished {}
    Ok(displacements)
}

#[test]
fn every_vertex_of_a_handle_goes_to_its_place_and_rigid_places_are_a_map() {
    let map = DAffine3::from_translation(DVec3::new(0.5, 0.2, -0.3)) * DAffine3::from_rotation_x(FRAC_PI_2);
    let mut takers = Vec::new();
    for declaration in METHODS {
        let scene = bar(declaration.name, true);
        let mut bound = scene.bind();
        let rigid = places(&scene, &bound, |p| map.transform_point3(p));
        let by_places = match bent(&mut bound, Target::Places(rigid)) {
            Err(SolveError::NoPlaces { method }) => {
                assert_eq!(method, declaration.name);
                continue;
            }
            shape => shape.unwrap(),
        };
        takers.push(declaration.name);
        let by_map = bent(&mut scene.bind(), Target::Map(map)).unwrap();
        assert!(
            apart(&by_places, &by_map) < 1e-3,
            "{}: {:e}",
            declaration.name,
            apart(&by_places, &by_map)
        );
        // Each vertex goes its own way.
        let wild = places(&scene, &bound, |p| {
            map.transform_point3(p) + 0.05 * DVec3::new((9.0 * p.x).sin(), 0.0, p.y)
        });
        let shape = bent(&mut bound, Target::Places(wild.clone())).unwrap();
        for (&vertex, place) in bound.handle_vertices(0).iter().zip(&wild) {
            let found = scene.positions()[vertex as usize] + shape[vertex as usize];
            assert!(found.distance(*place) < 1e-12, "{}", declaration.name);
        }
        // The places of rest give the rest shape again.
        let rest = places(&scene, &bound, |p| p);
        assert!(
            bent(&mut bound, Target::Places(rest))
                .unwrap()
                .iter()
                .all(|d| *d == DVec3::ZERO)
        );
    }
    for known in ["bilaplacian", "arap", "shells", "wrinkles", "poisson", "frames"] {
        assert!(takers.contains(&known), "{known}");
    }
}

#[test]
fn places_hold_a_component_and_a_map_does_not() {
    let scene = bar("arap", false);
    let mut bound = scene.bind();
    let has_warned = |bound: &Bound| {
        bound
            .warnings()
            .iter()
            .any(|warning| warning.contains("can move as a whole"))
    };
    assert!(has_warned(&bound));
    let lifted = places(&scene, &bound, |p| p + DVec3::X);
    bound.set_places(&[Target::Places(lifted)]).unwrap();
    assert!(!has_warned(&bound));
    bound.set_targets(&[DAffine3::from_translation(DVec3::X)]).unwrap();
    assert!(has_warned(&bound));
}

#[test]
fn a_wrong_count_and_a_place_that_is_not_finite_are_refused() {
    let scene = bar("arap", true);
    let mut bound = scene.bind();
    let mut lifted = places(&scene, &bound, |p| p + DVec3::X);
    let short = Target::Places(lifted[1..].to_vec());
    assert!(matches!(bound.set_places(&[short]), Err(SolveError::PlaceCount { .. })));
    lifted[3].y = f64::NAN;
    assert!(matches!(
        bound.set_places(&[Target::Places(lifted)]),
        Err(SolveError::PlaceNotFinite { .. })
    ));
}
