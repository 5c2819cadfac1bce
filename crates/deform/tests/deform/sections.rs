//! Handles along a curve: a map for each vertex, and sections with turns of their own.

use std::f64::consts::TAU;

use glam::{DAffine3, DVec2, DVec3};
use pliant_deform::{Bound, HandleFit, METHODS, Method, Role, SolveError, Target, TurnedMap};
use pliant_mesh::{Curve, CurveMotion, CurvePath, shapes};

use crate::rig::Scene;

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

/// The map of a point along the curve.
fn turned(path: &CurvePath, motion: &CurveMotion, point: DVec3) -> TurnedMap {
    let place = motion.rest().nearest(point);
    TurnedMap {
        map: motion.map_at(place),
        turn_rad: path.turn_rad(motion, place),
    }
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
        let path = CurvePath::of(&motion);
        let maps = own
            .map(|vertex| turned(&path, &motion, scene.positions()[*vertex as usize]))
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
fn between_held_rings_the_bar_bends_and_winds_along_its_curve() {
    // Shares of the length. A cross-section is 2 / 32 of it wide, and the inner side of the arc is a fifth shorter.
    for (name, limit) in [("arap", 0.004), ("primo", 0.012), ("shells", 0.025)] {
        for (moved, twist) in [(arc(300.0_f64.to_radians()), 0.0), (middle(), 360.0)] {
            let scene = bar(name, ring);
            let shape = bent(&scene, &mut scene.bind(), &moved, twist);
            let wanted = wanted(&scene, &moved, twist);
            let places = scene.positions().iter().zip(&shape).map(|(p, way)| *p + *way);
            let missed = places.zip(&wanted).map(|(found, wanted)| found.distance(*wanted));
            let worst = missed.fold(0.0, f64::max) / LENGTH;
            assert!(worst < limit, "{name} with a twist of {twist}: {worst:e}");
        }
    }
}

/// The vertices at the bar's ends, where alone some curves have vertices.
fn end(p: DVec3) -> bool {
    p.x < 4.0 || p.x > LENGTH - 4.0
}

/// One solve for these control points and an even twist in degrees, without steps in between. Returns the angle about the
/// bar of each cross-section against rest, in degrees: from one to the next they turn by less than half a turn.
fn wound(scene: &Scene, bound: &mut Bound, moved: Vec<DVec3>, twist: f64) -> Vec<f64> {
    let motion = motion(moved, twist);
    let path = CurvePath::of(&motion);
    let own = bound.handle_vertices(0).iter();
    let maps = own.map(|vertex| turned(&path, &motion, scene.positions()[*vertex as usize]));
    bound.set_places(&[Target::Maps(maps.collect())]).unwrap();
    let mut displacements = vec![DVec3::ZERO; bound.vertex_count()];
    while !bound.step(&mut displacements).unwrap().finished {}
    let mut angles = vec![0.0];
    for x in 0..LENGTH as usize {
        let turn = |x: usize| {
            let on = |p: &DVec3| p.x == x as f64;
            let section = scene.positions().iter().zip(&displacements).filter(|(p, _)| on(p));
            let middle = section.clone().map(|(p, way)| *p + *way).sum::<DVec3>() / section.clone().count() as f64;
            let arms = section.map(|(p, way)| (DVec2::new(p.y - 1.0, p.z - 1.0), *p + *way - middle));
            arms.fold(DVec2::ZERO, |sum, (rest, arm)| {
                sum + DVec2::new(rest.x, -rest.y).rotate(DVec2::new(arm.y, arm.z))
            })
        };
        let further = DVec2::angle_to(turn(x), turn(x + 1)).to_degrees();
        angles.push(angles[x] + further);
    }
    angles
}

#[test]
fn a_twist_of_any_angle_is_one_where_only_the_ends_have_vertices() {
    for declaration in METHODS.iter().filter(|declaration| declaration.name != "identity") {
        let scene = bar(declaration.name, end);
        let mut bound = scene.bind();
        // From rest, and by a full turn, which changes no map.
        for twist in [360.0, 90.0, 450.0, -30.0] {
            let angles = wound(&scene, &mut bound, middle(), twist);
            let says_so = bound
                .warnings()
                .iter()
                .any(|warning| warning.to_string().contains("turns by"));
            let apart = |x: usize| (angles[x] - twist * x as f64 / LENGTH).abs();
            let winds = [16, 32].iter().all(|x| apart(*x) < 3.0);
            assert!(
                winds || says_so || twist.abs() < 180.0,
                "{} by {twist}: {angles:?}",
                declaration.name
            );
            let follows = ["arap", "primo", "shells", "embedded", "poisson"].contains(&declaration.name);
            let is_even = winds && (0..=32).all(|x| apart(x) < 30.0);
            assert!(is_even || !follows, "{} by {twist}: {angles:?}", declaration.name);
        }
    }
}

#[test]
fn a_bent_bar_winds_as_a_straight_one_does() {
    for name in ["arap", "primo", "shells", "embedded"] {
        let scene = bar(name, end);
        let angles = wound(&scene, &mut scene.bind(), arc(0.5), 360.0);
        let is_even = (0..=32).all(|x| (angles[x] - 360.0 * x as f64 / LENGTH).abs() < 40.0);
        assert!(is_even, "{name}: {angles:?}");
    }
}

fn map(map: DAffine3) -> TurnedMap {
    TurnedMap {
        map,
        turn_rad: DVec3::ZERO,
    }
}

#[test]
fn without_sections_only_a_method_that_takes_places_takes_maps() {
    for declaration in METHODS {
        let mut scene = bar(declaration.name, ring);
        scene.sections.clear();
        let mut bound = scene.bind();
        let count = bound.handle_vertices(0).len();
        let mut is_taken = |target: Target| match bound.set_places(&[target]) {
            Ok(()) => true,
            Err(SolveError::NoPlaces { .. }) => false,
            Err(error) => panic!("{}: {error}", declaration.name),
        };
        let takes_maps = is_taken(Target::Maps(vec![map(DAffine3::from_translation(DVec3::X)); count]));
        let takes_places = is_taken(Target::Places(vec![DVec3::X; count]));
        assert_eq!(takes_maps, takes_places, "{}", declaration.name);
    }
}

#[test]
fn places_of_sections_are_refused_by_the_handles_number() {
    let scene = bar("arap", ring);
    let mut bound = scene.bind();
    let count = bound.handle_vertices(0).len();
    let short = bound.set_places(&[Target::Maps(vec![map(DAffine3::IDENTITY); count - 1])]);
    assert!(matches!(short, Err(SolveError::PlaceCount { handle: 0, found, expected }) if found + 1 == expected));
    let mut maps = vec![map(DAffine3::IDENTITY); count];
    maps[7].map.translation.x = f64::NAN;
    let wrong = bound.set_places(&[Target::Maps(maps)]);
    let seventh = bound.handle_vertices(0)[7];
    assert!(matches!(wrong, Err(SolveError::PlaceNotFinite { handle: 0, vertex }) if vertex == seventh));
    assert!(bound.set_places(&[]).is_err());
}
