//! Points that no triangle uses: methods of space bend them like vertices, and in surface methods they follow.

use glam::{DAffine3, DVec3};
use pliant_deform::{Loose, METHODS, Method, Needs, Role};
use pliant_mesh::{Drawn, DrawnVertex, shapes};

use crate::rig::{Scene, apart, settle, turned};
use crate::space;

fn surface_methods() -> impl Iterator<Item = Method> {
    let methods = METHODS.iter().map(|declaration| (declaration.default)());
    methods.filter(|method| method.needs() != Needs::Points)
}

/// A sphere without symmetries.
fn uneven() -> Drawn {
    let mut shape = shapes::icosphere(2);
    for (number, p) in (0..).zip(&mut shape.positions) {
        let noise = |k: f64| (f64::from(number) * k).sin();
        *p += 0.05 * DVec3::new(noise(1.3), noise(2.9), noise(4.7));
    }
    shape
}

/// Tiny loose triangles at the vertices of a shape.
fn crumbs(shape: &Drawn) -> Drawn {
    let corners = [DVec3::ZERO, DVec3::X * 1e-6, DVec3::Y * 1e-6];
    let positions = shape.positions.iter();
    let positions: Vec<DVec3> = positions.flat_map(|&p| corners.map(|corner| p + corner)).collect();
    let triangles = (0..shape.positions.len() as u32).map(|t| [3 * t, 3 * t + 1, 3 * t + 2].map(DrawnVertex));
    Drawn::once(positions, triangles.collect())
}

fn scene(drawn: Drawn, method: &Method) -> Scene {
    let mut scene = Scene::new(drawn)
        .with(Role::Fixed, |p| p.z < -0.5)
        .with(Role::Handle(0), |p| p.z > 0.7)
        .with(Role::Handle(1), |p| p.x > 0.9);
    scene.method = method.clone();
    scene
}

const TARGETS: [(DVec3, f64, DVec3); 2] = [(DVec3::Z, 0.7, DVec3::X), (DVec3::X, -0.4, DVec3::Y)];

fn targets() -> Vec<DAffine3> {
    TARGETS
        .iter()
        .map(|&(centre, angle, shift)| turned(centre, angle, 0.3 * shift))
        .collect()
}

#[test]
fn bare_points_bend_as_the_vertices_of_tiny_triangles_do() {
    // The nodes of embedded deformation are joined by areas and edges, which points don't have.
    for method in space::methods()
        .into_iter()
        .filter(|method| method.name() != "embedded")
    {
        let small = crumbs(&uneven());
        let bare = scene(Drawn::once(small.positions.clone(), Vec::new()), &method);
        let small = scene(small, &method);
        assert_eq!(bare.model.topology.bare_points().len(), bare.positions().len());
        assert_eq!(bare.positions(), small.positions());
        let [of_bare, of_small] = [&bare, &small].map(|scene| settle(&mut scene.bind(), &targets()).0);
        assert!(of_bare.iter().any(|d| d.length() > 0.3), "{method:?}");
        assert_eq!(of_bare, of_small, "{method:?}");
        assert!(
            bare.bind()
                .warnings()
                .iter()
                .all(|warning| !warning.to_string().contains("point"))
        );
    }
}

#[test]
fn points_on_a_vertex_go_with_it_whatever_the_method() {
    let shape = shapes::bar(12, 2, 2);
    for method in METHODS.iter().map(|declaration| (declaration.default)()) {
        let on_it = shapes::together(&[shape.clone(), Drawn::once(shape.positions.clone(), Vec::new())]);
        let [alone, with_points] = [shape.clone(), on_it].map(|drawn| {
            let mut scene = Scene::new(drawn)
                .with(Role::Fixed, |p| p.x < 2.5)
                .with(Role::Handle(0), |p| p.x > 9.5);
            scene.method = method.clone();
            settle(&mut scene.bind(), &[turned(DVec3::X * 12.0, 0.5, DVec3::Y)]).0
        });
        assert_eq!(alone, with_points, "{method:?}: no vertex more");
    }
}

/// A bar along x with a row of points above it, one of them separate.
fn bar_with_points() -> Drawn {
    let row = (0..12).map(|x| DVec3::new(f64::from(x) + 0.4, 1.1, 2.25)).collect();
    shapes::together(&[shapes::bar(12, 2, 2), Drawn::once(row, Vec::new())])
}

fn bent(drawn: Drawn, method: &Method, soft: Option<f64>, role: impl Fn(DVec3) -> bool) -> (Scene, Vec<DVec3>) {
    let mut scene = Scene::new(drawn)
        .with(Role::Fixed, |p| p.x < 2.1 && p.z < 2.1)
        .with(Role::Handle(0), |p| p.x > 9.9 && p.z < 2.1)
        .with(Role::Handle(0), role);
    scene.method = method.clone();
    scene.soft = vec![soft];
    let displacements = settle(&mut scene.bind(), &[turned(DVec3::X * 12.0, 0.4, DVec3::Y)]).0;
    (scene, displacements)
}

#[test]
fn surface_methods_bend_the_surface_as_if_there_were_no_points_and_carry_them_along() {
    let target = turned(DVec3::X * 12.0, 0.4, DVec3::Y);
    for method in surface_methods() {
        for soft in [None, Some(10.0)] {
            let (alone, of_bar) = bent(shapes::bar(12, 2, 2), &method, soft, |_| false);
            for in_handle in [false, true] {
                let is_in_handle = |p: DVec3| in_handle && p.x > 9.9 && p.z > 2.1;
                let (scene, all) = bent(bar_with_points(), &method, soft, is_in_handle);
                let first_bare = scene.model.topology.bare_points().start;
                assert_eq!(first_bare, alone.positions().len());
                // Points in a handle change its centre, and so the rounding of bases in single precision.
                let off = apart(&all[..first_bare], &of_bar);
                let most = if in_handle { 1e-6 } else { 0.0 };
                assert!(off <= most, "{method:?} {soft:?} {in_handle} {off:e}");
                for (&place, &d) in scene.positions()[first_bare..].iter().zip(&all[first_bare..]) {
                    let of_handle = target.transform_point3(place) - place;
                    assert!(d.is_finite(), "{method:?} {soft:?}");
                    if place.x < 1.0 {
                        assert!(d.length() < 1e-9, "beside what is fixed: {method:?} {d}");
                    } else if place.x > 10.9 && soft.is_none() {
                        assert!(
                            d.distance(of_handle) < 1e-9,
                            "beside the handle: {method:?} {d} {of_handle}"
                        );
                    } else if place.x > 5.0 {
                        assert!(d.length() > 1e-3, "between: {method:?} {soft:?} {d}");
                    }
                }
                let warnings = scene.bind();
                let warnings = warnings.warnings().iter().map(ToString::to_string);
                let told: Vec<String> = warnings.filter(|told| told.contains("no triangle uses")).collect();
                assert_eq!(told.len(), 1, "{method:?}");
                assert!(told[0].contains("rbf"), "{told:?}");
            }
        }
    }
}

#[test]
fn a_handle_of_points_alone_moves_them_and_no_surface() {
    for method in surface_methods() {
        for soft in [None, Some(10.0)] {
            let mut scene = Scene::new(bar_with_points())
                .with(Role::Fixed, |p| p.x < 2.1 && p.z < 2.1)
                .with(Role::Handle(0), |p| p.z > 2.1 && p.x > 5.0);
            scene.method = method.clone();
            scene.soft = vec![soft];
            let target = turned(DVec3::X * 12.0, 0.4, DVec3::Y);
            let displacements = settle(&mut scene.bind(), &[target]).0;
            for (v, (&p, &d)) in scene.positions().iter().zip(&displacements).enumerate() {
                let wanted = match scene.roles[v] {
                    Role::Handle(_) => target.transform_point3(p) - p,
                    _ => DVec3::ZERO,
                };
                assert!(d.distance(wanted) < 1e-9, "{method:?} {soft:?} {p} {d}");
            }
        }
    }
}

#[test]
fn points_rest_where_loose_parts_rest() {
    for method in surface_methods() {
        let mut scene = Scene::new(bar_with_points())
            .with(Role::Fixed, |p| p.x < 2.1 && p.z < 2.1)
            .with(Role::Handle(0), |p| p.x > 9.9 && p.z < 2.1);
        scene.method = method.clone();
        scene.loose = Loose::Rest;
        let displacements = settle(&mut scene.bind(), &[DAffine3::from_translation(DVec3::Y)]).0;
        let first_bare = scene.model.topology.bare_points().start;
        assert!(
            displacements[first_bare..].iter().all(|&d| d == DVec3::ZERO),
            "{method:?}"
        );
    }
}

#[test]
fn points_bend_where_no_triangle_moves() {
    for method in space::methods() {
        let far = shapes::moved(&shapes::icosphere(1), DAffine3::from_translation(DVec3::Y * 50.0));
        let cloud = Drawn::once(uneven().positions, Vec::new());
        let mut scene = scene(shapes::together(&[far, cloud]), &method).with(Role::Fixed, |p| p.y > 40.0);
        scene.handle_count = 2;
        let (displacements, _) = settle(&mut scene.bind(), &targets());
        let moved = |d: &DVec3| d.is_finite() && d.length() > 0.3;
        assert!(displacements.iter().any(moved), "{method:?}");
        assert!(displacements.iter().all(|d| d.is_finite()), "{method:?}");
    }
}
