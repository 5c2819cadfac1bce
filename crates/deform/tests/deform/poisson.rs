//! Gradient editing: the motions that it reproduces, those that it ignores, and the spread of its weights.

use std::f64::consts::{FRAC_PI_2, PI};

use crate::differential::tube;
use crate::rig::{Scene, apart, settle, step, turned};
use glam::{DAffine3, DVec3};
use pliant_deform::{Bilaplacian, BilaplacianOrder, Method, OptionValue, Role};
use pliant_mesh::{SurfaceVertex, shapes};

fn poisson(propagation: &'static str) -> Method {
    let method = Method::from_name("poisson").unwrap();
    method.with([("propagation", OptionValue::Name(propagation))]).unwrap()
}

const PROPAGATIONS: [&str; 3] = ["harmonic", "geodesic", "material"];

/// A long sheet with bumps, fixed at one end, a handle at the other.
pub fn bumpy(method: &Method) -> Scene {
    let mut sheet = shapes::grid(60, 20);
    for p in &mut sheet.positions {
        *p = DVec3::new(3.0 * p.x, p.y, 0.02 * (25.0 * p.x).sin() * (9.0 * p.y).sin());
    }
    let mut scene = Scene::new(sheet)
        .with(Role::Fixed, |p| p.x < 0.101)
        .with(Role::Handle(0), |p| p.x > 2.899);
    scene.method = method.clone();
    scene
}

/// The target of the end of [`bumpy`] if the sheet becomes an arc of a circle by this angle.
pub fn along_an_arc(angle_rad: f64) -> DAffine3 {
    let (from, length) = (DVec3::X * 0.1, 2.8);
    let radius = length / angle_rad;
    let centre = from + DVec3::Z * radius;
    let turn = DAffine3::from_rotation_y(-angle_rad);
    DAffine3::from_translation(centre) * turn * DAffine3::from_translation(-centre - DVec3::X * length)
}

/// The largest relative change of length of an edge between free vertices.
pub fn worst_strain(scene: &Scene, displacements: &[DVec3]) -> f64 {
    let mut worst = 0.0_f64;
    for (vertex, &p) in scene.positions().iter().enumerate() {
        for &other in scene.model.topology.neighbours(SurfaceVertex(vertex as u32)) {
            let rest = scene.positions()[other.index()] - p;
            let bent = rest + displacements[other.index()] - displacements[vertex];
            worst = worst.max((bent.length() / rest.length() - 1.0).abs());
        }
    }
    worst
}

#[test]
fn a_turned_handle_bends_the_surface_and_does_not_shear_its_bumps() {
    let plate = bumpy(&Method::default());
    for angle in [0.5, FRAC_PI_2, 2.0, 3.0] {
        let of_a_plate = worst_strain(&plate, &plate.moved(&[along_an_arc(angle)]));
        for propagation in PROPAGATIONS {
            let scene = bumpy(&poisson(propagation));
            let strain = worst_strain(&scene, &scene.moved(&[along_an_arc(angle)]));
            // Bumps of a height of 0.02 on an arc of a radius of 2.8 / angle are strained by 0.007 angle.
            assert!(strain < 0.01 * angle, "{propagation} {angle}: {strain}");
            assert!(
                of_a_plate > 10.0 * strain,
                "{propagation} {angle}: {strain} {of_a_plate}"
            );
        }
    }
}

#[test]
fn it_is_blind_to_moves_and_says_so() {
    for propagation in PROPAGATIONS {
        let mut scene = bumpy(&poisson(propagation));
        let bound = &mut scene.bind();
        let target = [DAffine3::from_translation(DVec3::new(-0.2, 0.1, 1.0))];
        let moved = step(bound, &target);
        assert!(
            bound
                .warnings()
                .iter()
                .any(|said| said.contains("turns nothing for moves"))
        );
        // Each face keeps its direction: the shape is that of a membrane, which has no turns.
        let mut membrane = Bilaplacian::default();
        membrane.order = BilaplacianOrder::Membrane;
        scene.method = membrane.into();
        assert!(apart(&moved, &scene.moved(&target)) < 1e-6, "{propagation}");
        step(bound, &[turned(DVec3::X * 3.0, 0.3, DVec3::Z)]);
        assert!(bound.warnings().is_empty(), "{:?}", bound.warnings());
    }
}

#[test]
fn a_drag_beyond_half_a_turn_goes_on_and_one_step_takes_the_short_way() {
    let scene = tube(&poisson("harmonic"));
    let bound = &mut scene.bind();
    let twist = |angle: f64| [DAffine3::from_rotation_z(angle)];
    // The turn of the tube's middle about its axis.
    let middle = |displacements: &[DVec3]| {
        let at = |p: &DVec3| p.truncate().to_angle();
        let (vertex, p) = (0..)
            .zip(scene.positions())
            .find(|(_, p)| (p.z - 4.0).abs() < 0.2)
            .unwrap();
        let there = *p + displacements[vertex as usize];
        (there.truncate().to_angle() - at(p)).rem_euclid(2.0 * PI)
    };
    let mut last = Vec::new();
    for degree in (0..=270).step_by(10) {
        last = step(bound, &twist(f64::from(degree).to_radians()));
    }
    let share = |p: f64| p / (2.0 * PI) * 360.0;
    let dragged = share(middle(&last));
    assert!((dragged - 135.0).abs() < 10.0, "{dragged}");
    let at_once = share(middle(&scene.moved(&twist(1.5 * PI))));
    assert!((at_once - 315.0).abs() < 10.0, "{at_once}");
    // At rest the turn is forgotten.
    step(bound, &twist(0.0));
    let again = share(middle(&step(bound, &twist(1.5 * PI))));
    assert!((again - 315.0).abs() < 10.0, "{again}");
}

#[test]
fn weights_are_one_on_their_handle_none_on_others_and_sum_to_one_where_nothing_is_fixed() {
    for propagation in PROPAGATIONS {
        for (name, drawn) in shapes::classes() {
            for fixed in [true, false] {
                let mut scene = Scene::new(drawn.clone()).with_ends(fixed);
                scene.method = poisson(propagation);
                let bound = scene.bind();
                let weights: Vec<Vec<f64>> = (0..scene.handle_count)
                    .map(|handle| bound.handle_weights(handle).unwrap())
                    .collect();
                for (vertex, role) in scene.roles.iter().enumerate() {
                    let sum: f64 = weights.iter().map(|own| own[vertex]).sum();
                    match role {
                        Role::Fixed => assert_eq!(sum, 0.0, "{name} {propagation}"),
                        Role::Handle(handle) => {
                            let own = weights[usize::from(*handle)][vertex];
                            assert!(
                                (own - 1.0).abs() < 1e-9 && (sum - 1.0).abs() < 1e-9,
                                "{name} {propagation}"
                            );
                        }
                        Role::Free if fixed => assert!(sum < 1.0 + 1e-6, "{name} {propagation}: {sum}"),
                        Role::Free => assert!((sum - 1.0).abs() < 1e-9, "{name} {propagation}: {sum}"),
                    }
                }
                assert!(bound.handle_weights(scene.handle_count).is_none());
            }
        }
    }
}

#[test]
fn on_a_flat_strip_all_weights_are_the_share_of_the_way_and_stiff_parts_turn_as_a_whole() {
    let strip = |propagation| {
        let mut scene = Scene::new(shapes::grid(40, 40))
            .with(Role::Fixed, |p| p.x < 0.101)
            .with(Role::Handle(0), |p| p.x > 0.899);
        scene.method = poisson(propagation);
        scene
    };
    for propagation in PROPAGATIONS {
        let mut scene = strip(propagation);
        let even = scene.bind().handle_weights(0).unwrap();
        for (p, weight) in scene.positions().iter().zip(&even) {
            let expected = ((p.x - 0.1) / 0.8).clamp(0.0, 1.0);
            let tolerance = if propagation == "geodesic" { 0.01 } else { 1e-6 };
            assert!((weight - expected).abs() < tolerance, "{propagation} {p}: {weight}");
        }
        for (own, &p) in scene.stiffness.iter_mut().zip(&scene.model.surface.positions) {
            *own = if (0.3..0.7).contains(&p.x) { 1000.0 } else { 1.0 };
        }
        let painted = scene.bind().handle_weights(0).unwrap();
        let at = |x: f64| scene.positions().iter().position(|p| (p.x - x).abs() < 1e-9).unwrap();
        let rise = painted[at(0.675)] - painted[at(0.325)];
        if propagation == "material" {
            assert!(rise < 0.01, "{rise}");
        } else {
            assert!(apart_by(&painted, &even) < 1e-9, "{propagation}");
        }
    }
}

fn apart_by(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

#[test]
fn stretches_spread_linearly() {
    let scene = bumpy(&poisson("harmonic"));
    let from = DAffine3::from_translation(DVec3::X * 2.9);
    let wide = from * DAffine3::from_scale(DVec3::new(1.0, 2.0, 1.0)) * from.inverse();
    let (shape, _) = settle(&mut scene.bind(), &[wide]);
    let middle = (0..shape.len()).filter(|&v| (scene.positions()[v].x - 1.5).abs() < 0.03);
    let ys = middle.map(|v| scene.positions()[v].y + shape[v].y);
    let (least, most) = ys.fold((f64::MAX, f64::MIN), |(a, b), y| (a.min(y), b.max(y)));
    // Half way the sheet is half again as wide.
    assert!((most - least - 1.5).abs() < 0.1, "{}", most - least);
}
