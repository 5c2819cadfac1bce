//! Handles along a curve: a map for each vertex, and sections with turns of their own.

use std::f64::consts::TAU;

use glam::{DAffine3, DQuat, DVec3};
use pliant_deform::{Arap, ArapEnergy, Bound, HandleFit, METHODS, Method, Role, SolveError, Target};
use pliant_mesh::{Curve, CurveMotion, CurvePath, shapes};

use crate::rig::{Scene, apart};

const LENGTH: f64 = 32.0;

/// A bar along x with a straight curve in its middle; the vertices that are `held` are one handle with a section for each
/// place.
fn bar(method: &str, held: impl Fn(DVec3) -> bool) -> Scene {
    let mut scene = Scene::new(shapes::bar(LENGTH as usize, 2, 2)).with(Role::Handle(0), held);
    scene.sections = scene.positions().iter().map(|p| p.x as u16).collect();
    scene.method = Method::from_name(method).unwrap();
    scene
}

fn middle() -> Vec<DVec3> {
    (0..=32)
        .map(|i| DVec3::new(f64::from(i) * LENGTH / 32.0, 1.0, 1.0))
        .collect()
}

fn curve() -> Curve {
    Curve::new(middle(), false).unwrap()
}

/// The curve bent into a circular arc, its length kept.
fn arc(angle: f64) -> Vec<DVec3> {
    let radius = LENGTH / angle;
    let on = |p: DVec3| {
        let angle = p.x / radius;
        DVec3::new(radius * angle.sin(), 1.0 + radius * (1.0 - angle.cos()), 1.0)
    };
    middle().into_iter().map(on).collect()
}

/// The motion of the curve to these control points, with an even twist in degrees.
fn motion(moved: Vec<DVec3>, twist: f64) -> CurveMotion {
    let count = moved.len();
    let twists: Vec<f64> = (0..count).map(|i| twist * i as f64 / (count - 1) as f64).collect();
    CurveMotion::new(curve(), moved, &twists, &vec![1.0; count]).unwrap()
}

/// Bends along the curve in steps of at most 45 degrees.
fn bent(scene: &Scene, bound: &mut Bound, moved: &[DVec3], twist: f64) -> Vec<DVec3> {
    let path = CurvePath::of(&motion(moved.to_vec(), twist));
    let steps = (path.largest_turn_rad() / (TAU / 8.0)).ceil().max(1.0) as usize;
    let mut displacements = vec![DVec3::ZERO; bound.vertex_count()];
    for step in 1..=steps {
        let share = step as f64 / steps as f64;
        let motion = motion(path.points_at(share), share * twist);
        let own = bound.handle_vertices(0).iter();
        let maps = own
            .map(|vertex| motion.map(scene.positions()[*vertex as usize]))
            .collect();
        bound.set_places(&[Target::Maps(maps)]).unwrap();
        while !bound.step(&mut displacements).unwrap().finished {}
    }
    displacements
}

/// The places to which the curve takes all vertices.
fn wanted(scene: &Scene, moved: &[DVec3], twist: f64) -> Vec<DVec3> {
    let motion = motion(moved.to_vec(), twist);
    scene.positions().iter().map(|p| *p + motion.displacement(*p)).collect()
}

/// The middle of each cross-section of the bar.
fn middles(scene: &Scene, shape: &[DVec3]) -> Vec<DVec3> {
    let section = |x: usize| {
        let is_here = |p: &DVec3| p.x == x as f64;
        let here: Vec<DVec3> = scene
            .positions()
            .iter()
            .zip(shape)
            .filter(|(p, _)| is_here(p))
            .map(|(_, q)| *q)
            .collect();
        here.iter().sum::<DVec3>() / here.len() as f64
    };
    (0..=LENGTH as usize).map(section).collect()
}

/// Every fourth ring, to which the bar's ends belong.
fn ring(p: DVec3) -> bool {
    p.x % 4.0 == 0.0
}

#[test]
fn every_method_takes_a_map_for_each_vertex_and_holds_them_as_exactly_as_any_handle() {
    for declaration in METHODS {
        let scene = bar(declaration.name, ring);
        for (moved, twist) in [(arc(2.0), 0.0), (middle(), 90.0)] {
            let mut bound = scene.bind();
            let shape = bent(&scene, &mut bound, &moved, twist);
            let wanted = wanted(&scene, &moved, twist);
            let held = bound.handle_vertices(0);
            assert_eq!(held.len(), scene.positions().iter().filter(|p| ring(**p)).count());
            let limit = match scene.method.handle_fit() {
                HandleFit::Exact => 1e-12 * LENGTH,
                HandleFit::LeastSquares => 0.02 * LENGTH,
            };
            for vertex in held.iter().map(|vertex| *vertex as usize) {
                let missed = (scene.positions()[vertex] + shape[vertex]).distance(wanted[vertex]);
                assert!(missed <= limit, "{}: {missed:e}", declaration.name);
            }
        }
    }
}

#[test]
fn a_bar_stands_on_the_arc_of_its_curve_between_held_rings_too() {
    let mut smooth = Arap::default();
    smooth.energy = ArapEnergy::Smooth;
    for method in [
        smooth.into(),
        Method::from_name("primo").unwrap(),
        Method::from_name("shells").unwrap(),
    ] {
        let name = method.name();
        let mut scene = bar(name, ring);
        scene.method = method;
        for degrees in [45.0_f64, 180.0, 300.0] {
            let moved = arc(degrees.to_radians());
            let mut bound = scene.bind();
            let shape = bent(&scene, &mut bound, &moved, 0.0);
            let shape: Vec<DVec3> = scene.positions().iter().zip(&shape).map(|(p, d)| *p + *d).collect();
            let radius = LENGTH / degrees.to_radians();
            let mut worst = (0.0_f64, 0.0_f64);
            for (x, middle) in middles(&scene, &shape).into_iter().enumerate() {
                let from_centre = middle - DVec3::new(0.0, 1.0 + radius, 1.0);
                let angle = from_centre.x.atan2(-from_centre.y) - x as f64 / radius;
                let along = radius * (angle - TAU * (angle / TAU).round());
                worst.0 = worst.0.max(along.abs());
                worst.1 = worst.1.max((from_centre.length() - radius).abs());
            }
            println!(
                "{name} {degrees}: along {:.1e} off {:.1e} of the length",
                worst.0 / LENGTH,
                worst.1 / LENGTH
            );
        }
    }
}

#[test]
fn a_handle_that_moves_as_a_whole_needs_no_sections() {
    let map = DAffine3::from_rotation_translation(DQuat::from_rotation_z(0.7), DVec3::new(1.0, 2.0, 0.5));
    for declaration in METHODS {
        let held = |p: DVec3| p.x >= LENGTH - 4.0;
        let mut scene = bar(declaration.name, held).with(Role::Fixed, |p| p.x <= 2.0);
        let by_sections = scene.moved(&[map]);
        scene.sections.clear();
        let whole = scene.moved(&[map]);
        let apart = apart(&by_sections, &whole) / LENGTH;
        println!("{} {apart:.1e}", declaration.name);
    }
}

#[test]
fn only_a_method_without_turns_takes_maps_without_sections() {
    for declaration in METHODS {
        let mut scene = bar(declaration.name, ring);
        scene.sections.clear();
        let mut bound = scene.bind();
        let maps = vec![DAffine3::from_translation(DVec3::X); bound.handle_vertices(0).len()];
        let set = bound.set_places(&[Target::Maps(maps.clone())]);
        assert!(matches!(set, Ok(()) | Err(SolveError::NoPlaces { .. })));
        let short = bound.set_places(&[Target::Maps(maps[1..].to_vec())]);
        assert!(short.is_err());
    }
}

#[test]
fn places_of_sections_are_refused_by_the_handles_number() {
    let scene = bar("arap", ring);
    let mut bound = scene.bind();
    let count = bound.handle_vertices(0).len();
    let short = bound.set_places(&[Target::Maps(vec![DAffine3::IDENTITY; count - 1])]);
    assert!(matches!(short, Err(SolveError::PlaceCount { handle: 0, found, expected }) if found + 1 == expected));
    let mut maps = vec![DAffine3::IDENTITY; count];
    maps[7].translation.x = f64::NAN;
    let wrong = bound.set_places(&[Target::Maps(maps)]);
    let seventh = bound.handle_vertices(0)[7];
    assert!(matches!(wrong, Err(SolveError::PlaceNotFinite { handle: 0, vertex }) if vertex == seventh));
    assert!(bound.set_places(&[]).is_err());
}
