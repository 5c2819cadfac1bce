//! Handles that are free along a direction: they slide to where the energy is least.

use glam::{DAffine3, DVec3};
use pliant_deform::{Bound, Method, Role, SolveError};
use pliant_mesh::shapes;
use rayon::ThreadPoolBuilder;

use crate::rig::{Scene, settle};

/// The pull at the end of the bar, across it.
const PULL: DVec3 = DVec3::new(0.0, 4.0, 1.0);

/// A bar along x, which is held at one end; the other one is handle 0.
fn bar(method: &str) -> Scene {
    let mut scene = Scene::new(shapes::bar(8, 2, 2))
        .with(Role::Fixed, |p| p.x < 0.5)
        .with(Role::Handle(0), |p| p.x > 7.5);
    scene.method = Method::from_name(method).unwrap();
    scene
}

/// The same with its middle as handle 1.
fn bar_with_middle(method: &str) -> Scene {
    bar(method).with(Role::Handle(1), |p| (p.x - 4.0).abs() < 0.5)
}

fn moved(by: DVec3) -> DAffine3 {
    DAffine3::from_translation(by)
}

/// The least energy for these targets, with all handles held.
fn held_energy(bound: &mut Bound, targets: &[DAffine3]) -> f64 {
    bound.set_free_along(&[]).unwrap();
    *settle(bound, targets).1.last().unwrap()
}

#[test]
fn the_reaction_of_a_linear_method_vanishes_along_the_free_direction() {
    for method in ["bilaplacian", "laplacian", "poisson"] {
        let scene = bar_with_middle(method);
        let mut bound = scene.bind();
        let direction = DVec3::new(0.3, -0.5, 0.8).normalize();
        let middle = crate::rig::turned(DVec3::new(4.0, 1.0, 1.0), 0.6, DVec3::new(0.5, 1.0, -2.0));
        let targets = [moved(PULL), middle];
        bound.set_free_along(&[Some(direction * 7.0)]).unwrap();
        settle(&mut bound, &targets);
        let slide = bound.slide(0);
        assert!(slide.abs() > 0.1, "{method}: {slide}");
        let mut reaction = |at: f64| {
            let by = |t: f64| [moved(PULL + direction * t), middle];
            let h = 1e-3;
            (held_energy(&mut bound, &by(at + h)) - held_energy(&mut bound, &by(at - h))) / (2.0 * h)
        };
        let (first, last) = (reaction(0.0), reaction(slide));
        assert!(last.abs() <= 1e-6 * first.abs(), "{method}: {last:e} of {first:e}");
    }
}

#[test]
fn the_places_of_several_free_handles_depend_on_each_other() {
    let scene = bar_with_middle("bilaplacian");
    let mut bound = scene.bind();
    let directions = [DVec3::Z, DVec3::new(0.0, 0.6, 0.8)];
    let targets = [moved(PULL), moved(DVec3::new(0.0, -1.0, 0.3))];
    bound.set_free_along(&directions.map(Some)).unwrap();
    settle(&mut bound, &targets);
    let slides = [0, 1].map(|handle| bound.slide(handle));
    let mut energy = |by: [f64; 2]| {
        let handle = |h: usize| moved(directions[h] * (slides[h] + by[h])) * targets[h];
        held_energy(&mut bound, &[handle(0), handle(1)])
    };
    let least = energy([0.0; 2]);
    for by in [
        [0.01, 0.0],
        [-0.01, 0.0],
        [0.0, 0.01],
        [0.0, -0.01],
        [0.01, 0.01],
        [-0.01, 0.01],
    ] {
        assert!(energy(by) > least, "{by:?}");
    }
}

#[test]
fn an_iterative_method_has_less_energy_than_beside_and_where_it_was_put() {
    for method in ["arap", "primo", "shells", "embedded"] {
        let scene = bar(method);
        let mut bound = scene.bind();
        // As seen along the bar.
        bound.set_free_along(&[Some(DVec3::X)]).unwrap();
        let (shape, energies) = settle(&mut bound, &[moved(PULL)]);
        let (slide, least) = (bound.slide(0), *energies.last().unwrap());
        // An arm that is pulled aside swings: its end comes nearer to its root.
        assert!(slide < -0.3, "{method}: {slide}");
        for (at, held) in scene
            .roles
            .iter()
            .enumerate()
            .filter(|(_, role)| **role == Role::Handle(0))
        {
            let way = shape[at] - DVec3::X * slide;
            assert!(
                way.distance(PULL) < 1e-12 || method == "embedded",
                "{method}: {held:?} {way}"
            );
        }
        for beside in [0.1, -0.1] {
            let held = held_energy(&mut scene.bind(), &[moved(PULL + DVec3::X * (slide + beside))]);
            assert!(least <= held, "{method}: {least:e} and beside {held:e}");
        }
        let put = held_energy(&mut scene.bind(), &[moved(PULL)]);
        assert!(least < 0.9 * put, "{method}: {least:e} of {put:e}");
    }
}

#[test]
fn the_same_targets_given_anew_at_every_step_lead_to_the_same_shape() {
    let scene = bar("arap");
    let (mut once, mut again) = (scene.bind(), scene.bind());
    let targets = [moved(PULL)];
    once.set_free_along(&[Some(DVec3::X)]).unwrap();
    let (meant, energies) = settle(&mut once, &targets);
    let mut shape = vec![DVec3::ZERO; again.vertex_count()];
    for step in 1.. {
        again.set_free_along(&[Some(DVec3::X)]).unwrap();
        again.set_targets(&targets).unwrap();
        if again.step(&mut shape).unwrap().finished {
            assert_eq!(step, energies.len());
            break;
        }
    }
    assert!(shape == meant);
}

#[test]
fn at_rest_nothing_slides_to_the_bit() {
    for method in ["bilaplacian", "arap"] {
        let mut bound = bar(method).bind();
        bound.set_free_along(&[Some(DVec3::X)]).unwrap();
        let rest = [DAffine3::IDENTITY];
        assert!(settle(&mut bound, &rest).0.iter().all(|d| *d == DVec3::ZERO));
        settle(&mut bound, &[moved(PULL)]);
        assert!(
            settle(&mut bound, &rest).0.iter().all(|d| *d == DVec3::ZERO),
            "{method}"
        );
        assert_eq!(bound.slide(0), 0.0);
    }
}

#[test]
fn the_place_does_not_depend_on_the_number_of_threads() {
    for method in ["bilaplacian", "arap"] {
        let shapes = [1, 2, 3].map(|threads| {
            let pool = ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| {
                let mut bound = bar_with_middle(method).bind();
                bound.set_free_along(&[Some(DVec3::X)]).unwrap();
                settle(&mut bound, &[moved(PULL), moved(DVec3::Z)]).0
            })
        });
        assert!(shapes[0] == shapes[1] && shapes[0] == shapes[2], "{method}");
    }
}

#[test]
fn without_an_energy_a_handle_stays_and_a_sentence_says_so() {
    let mut bound = bar("mls").bind();
    bound.set_free_along(&[Some(DVec3::X)]).unwrap();
    settle(&mut bound, &[moved(PULL)]);
    assert_eq!(bound.slide(0), 0.0);
    let said: Vec<String> = bound.warnings().iter().map(ToString::to_string).collect();
    assert!(
        said.iter()
            .any(|said| said.contains("no energy chooses the place of handle 0")),
        "{said:?}"
    );
}

#[test]
fn a_direction_without_length_is_refused() {
    let mut bound = bar("bilaplacian").bind();
    for direction in [DVec3::ZERO, DVec3::NAN, DVec3::INFINITY] {
        let refused = bound.set_free_along(&[Some(direction)]);
        assert_eq!(refused, Err(SolveError::NoDirection { handle: 0 }));
    }
}
