//! Handles along a curve: a map for each vertex, and sections with turns of their own.

use std::f64::consts::TAU;

use glam::{DAffine3, DQuat, DVec3};
use pliant_deform::{Bound, METHODS, Method, Role, Target};
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

/// Bends along the curve in steps of at most 45 degrees.
fn bent(scene: &Scene, bound: &mut Bound, moved: &[DVec3], twist: f64) -> Vec<DVec3> {
    let at = |moved: Vec<DVec3>, twist: f64| {
        let count = moved.len();
        let twists: Vec<f64> = (0..count).map(|i| twist * i as f64 / (count - 1) as f64).collect();
        CurveMotion::new(curve(), moved, &twists, &vec![1.0; count]).unwrap()
    };
    let path = CurvePath::of(&at(moved.to_vec(), twist));
    let steps = (path.largest_turn_rad() / (TAU / 8.0)).ceil().max(1.0) as usize;
    let mut displacements = vec![DVec3::ZERO; bound.vertex_count()];
    for step in 1..=steps {
        let share = step as f64 / steps as f64;
        let motion = at(path.points_at(share), share * twist);
        let own = bound.handle_vertices(0).iter();
        let maps = own
            .map(|vertex| motion.map(scene.positions()[*vertex as usize]))
            .collect();
        bound.set_places(&[Target::Maps(maps)]).unwrap();
        while !bound.step(&mut displacements).unwrap().finished {}
    }
    displacements
}

#[test]
fn explore() {
    for degrees in [90.0_f64, 300.0] {
        for name in METHODS.iter().map(|m| m.name) {
            for (what, held) in [
                ("rings", (|p: DVec3| p.x % 4.0 == 0.0) as fn(DVec3) -> bool),
                ("edges", |p: DVec3| p.y % 2.0 == 0.0 && p.z % 2.0 == 0.0),
                ("ends", |p: DVec3| p.x < 4.0 || p.x > 28.0),
            ] {
                let scene = bar(name, held);
                let Ok(mut bound) = scene.try_bind() else {
                    println!("{name} refuses");
                    continue;
                };
                for (moved, twist) in [(arc(degrees.to_radians()), 0.0), (middle(), 360.0)] {
                    let shape = bent(&scene, &mut bound, &moved, twist);
                    let twists: Vec<f64> = (0..33).map(|i| twist * i as f64 / 32.0).collect();
                    let wanted = CurveMotion::new(curve(), moved, &twists, &[1.0; 33]).unwrap();
                    let wanted: Vec<DVec3> = scene.positions().iter().map(|p| wanted.displacement(*p)).collect();
                    println!(
                        "{degrees} {name} {what} twist {twist}: {:.2e} of the length",
                        apart(&shape, &wanted) / LENGTH
                    );
                }
            }
        }
    }
    let _ = (DAffine3::IDENTITY, DQuat::IDENTITY);
}
