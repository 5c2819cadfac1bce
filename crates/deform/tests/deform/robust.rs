//! Systems that factor badly: vast contrasts of stiffness, flattened shapes, almost no hold.

use glam::{DAffine3, DVec3};
use pliant_deform::{Bilaplacian, BilaplacianOrder, Method, Role};
use pliant_mesh::{Drawn, shapes};

use crate::rig::{Scene, apart, back_substitute, step, turned};

/// Bases and solve agree, and a translation of everything is exact if nothing is fixed.
fn holds(name: &str, scene: &Scene) {
    let bound = &mut scene.try_bind().map_err(|error| format!("{name}: {error}")).unwrap();
    let targets = vec![turned(scene.positions()[0], 0.8, DVec3::X); scene.handle_count];
    let (by_bases, by_solving) = (step(bound, &targets), back_substitute(bound, &targets));
    let size = by_solving.iter().map(|d| d.length()).fold(0.0, f64::max);
    assert!(
        apart(&by_bases, &by_solving) < 1e-6 * size,
        "{name}: {:e}",
        apart(&by_bases, &by_solving) / size
    );
    if !scene.roles.contains(&Role::Fixed) {
        let targets = vec![DAffine3::from_translation(DVec3::Z); scene.handle_count];
        let worst = back_substitute(bound, &targets)
            .iter()
            .map(|d| d.distance(DVec3::Z))
            .fold(0.0, f64::max);
        assert!(worst < 1e-6, "{name}: {worst:e}");
    }
}

/// A long tube, one vertex of its end the handle, the other end fixed or not.
fn tube(fixed: bool) -> Scene {
    let mut scene = Scene::new(shapes::tube(24, 60, 20.0));
    let end = (0..scene.roles.len()).find(|&v| scene.positions()[v].z > 19.9).unwrap();
    scene.roles[end] = Role::Handle(0);
    scene.handle_count = 1;
    if fixed {
        scene.with(Role::Fixed, |p| p.z < 0.5)
    } else {
        scene
    }
}

#[test]
fn a_stiff_part_held_by_soft_ones_is_solved() {
    for fixed in [true, false] {
        for (hard, soft) in [(1000.0, 1.0), (1.0, 0.001), (1000.0, 0.001)] {
            let mut scene = tube(fixed);
            for (own, p) in scene.stiffness.iter_mut().zip(&scene.model.surface.positions) {
                *own = if p.z > 8.0 && p.z < 14.0 { hard } else { soft };
            }
            holds(&format!("{fixed} {hard} {soft}"), &scene);
        }
    }
}

fn flattened(drawn: &Drawn, thickness: f64) -> Drawn {
    let positions = drawn
        .positions
        .iter()
        .map(|p| DVec3::new(p.x, p.y, p.z * thickness))
        .collect();
    Drawn {
        positions,
        ..drawn.clone()
    }
}

#[test]
fn flattened_shapes_are_solved() {
    for (name, drawn) in shapes::classes() {
        for fixed in [true, false] {
            holds(
                &format!("{name} {fixed}"),
                &Scene::new(flattened(&drawn, 1e-3)).with_ends(fixed),
            );
        }
    }
}

#[test]
fn shapes_pressed_to_nothing_are_solved_or_refused_with_the_place() {
    for (name, drawn) in shapes::classes() {
        for thickness in [1e-7, 1e-12, 0.0] {
            for fixed in [true, false] {
                let scene = Scene::new(flattened(&drawn, thickness)).with_ends(fixed);
                if scene.model.surface.triangles.is_empty() {
                    continue; // welded away
                }
                match scene.try_bind() {
                    Ok(_) => holds(&format!("{name} {thickness} {fixed}"), &scene),
                    Err(error) => assert!(
                        error
                            .vertex()
                            .is_some_and(|vertex| (vertex as usize) < scene.roles.len()),
                        "{name} {thickness} {fixed}: {error}"
                    ),
                }
            }
        }
    }
}

#[test]
fn slivers_and_needles_are_solved() {
    // Columns of a sheet drawn together until they almost touch.
    for gap in [1e-3, 1e-6] {
        let sheet = shapes::grid(24, 24);
        let squeezed = |x: f64| (x * 12.0).floor() / 12.0 + gap * (x * 12.0).fract();
        let positions = sheet
            .positions
            .iter()
            .map(|p| DVec3::new(squeezed(p.x), p.y, 0.1 * (7.0 * p.x).sin()))
            .collect();
        let drawn = Drawn { positions, ..sheet };
        for fixed in [true, false] {
            holds(&format!("{gap} {fixed}"), &Scene::new(drawn.clone()).with_ends(fixed));
        }
    }
}

/// A shape that only one soft handle holds, by extremely weak springs: beside the bi-Laplacian they are lost in
/// rounding, and without them every translation is free.
fn adrift(drawn: &Drawn, order: BilaplacianOrder, weight: f64) -> Scene {
    let mut scene = Scene::new(drawn.clone()).with_ends(false);
    for role in &mut scene.roles {
        if *role == Role::Handle(1) {
            *role = Role::Free;
        }
    }
    scene.handle_count = 1;
    scene.soft = vec![Some(weight)];
    let mut options = Bilaplacian::default();
    options.order = order;
    scene.method = Method::from(options);
    scene
}

#[test]
fn what_does_not_factor_is_stiffened_and_said_or_refused_with_the_place() {
    let (mut stiffened, mut refused) = (0, 0);
    for (name, drawn) in shapes::classes() {
        for order in BilaplacianOrder::ALL {
            for exponent in [6, 10, 13, 15, 17, 20, 30] {
                let scene = adrift(&drawn, order, 0.1_f64.powi(exponent));
                let label = format!("{name} {order:?} 1e-{exponent}");
                match scene.try_bind() {
                    Ok(mut bound) => {
                        stiffened += usize::from(bound.warnings().iter().any(|said| said.contains("stiffened")));
                        let targets = vec![DAffine3::from_translation(DVec3::Z); scene.handle_count];
                        let worst = step(&mut bound, &targets)
                            .iter()
                            .map(|d| d.distance(DVec3::Z))
                            .fold(0.0, f64::max);
                        assert!(worst < 1e-6, "{label}: {worst:e}, {:?}", bound.warnings());
                    }
                    Err(error) => {
                        let vertex = error.vertex().unwrap_or_else(|| panic!("{label}: {error}"));
                        assert!((vertex as usize) < scene.roles.len(), "{label}: {error}");
                        assert!(error.to_string().contains(&vertex.to_string()), "{label}: {error}");
                        refused += 1;
                    }
                }
            }
        }
    }
    assert!(stiffened > 0 && refused > 0, "{stiffened} stiffened, {refused} refused");
}
