//! The laws of wrinkles learnt from examples.

use std::sync::Arc;

use crate::rig::{Scene, apart, back_substitute, scaled, step, turned};
use crate::shared::{extremes_leave_no_trace, same_on_any_number_of_threads};
use glam::{DAffine3, DVec3};
use pliant_deform::{Attachment, ExampleShape, Examples, Method, Role};
use pliant_mesh::{Cancel, Drawn, Progress, shapes};

/// A shape whose low end in x is fixed and whose high end is the handle.
fn held(drawn: Drawn) -> Scene {
    let scene = Scene::new(drawn);
    let bounds = scene.model.bounds().unwrap();
    let share = |p: DVec3| (p.x - bounds.min.x) / bounds.extent().x;
    let mut scene = scene
        .with(Role::Fixed, |p| share(p) < 0.12)
        .with(Role::Handle(0), |p| share(p) > 0.88);
    scene.method = Method::from_name("wrinkles").unwrap();
    scene
}

/// A sheet, a bar and a ball.
fn scenes() -> Vec<Scene> {
    [shapes::grid(40, 24), shapes::bar(24, 5, 5), shapes::icosphere(4)]
        .map(held)
        .into()
}

fn handle_centre(scene: &Scene) -> DVec3 {
    let vertices = scene.roles.iter().zip(scene.positions());
    let own: Vec<DVec3> = vertices
        .filter_map(|(role, p)| (*role == Role::Handle(0)).then_some(*p))
        .collect();
    own.iter().sum::<DVec3>() / own.len() as f64
}

/// Pushes the handle towards the fixed end, or lifts and turns it.
fn poses(scene: &Scene) -> [DAffine3; 2] {
    let size = scene.diagonal();
    [
        DAffine3::from_translation(DVec3::NEG_X * (0.12 * size)),
        turned(handle_centre(scene), 0.5, DVec3::new(0.02, 0.03, 0.12) * size),
    ]
}

/// The handle is where `pose` takes it, fixed vertices rest, and the part between is sculpted: no bi-Laplacian, with
/// folds.
fn sculpted(scene: &Scene, pose: DAffine3, folds: f64) -> ExampleShape {
    let bounds = scene.model.bounds().unwrap();
    let displacement = |(role, p): (&Role, &DVec3)| {
        let share = ((p.x - bounds.min.x) / bounds.extent().x - 0.12) / 0.76;
        let moved = pose.transform_point3(*p) - *p;
        match role {
            Role::Fixed => DVec3::ZERO,
            Role::Handle(_) => moved,
            Role::Free => {
                let (share, size) = (share.clamp(0.0, 1.0), scene.diagonal());
                let height = 0.02 * size * (folds * share).sin() * (share * (1.0 - share) * 4.0);
                moved * share + DVec3::new(0.3, 0.2, 1.0) * height
            }
        }
    };
    let displacements = scene.roles.iter().zip(scene.positions()).map(displacement).collect();
    ExampleShape {
        name: "sculpted".to_owned(),
        displacements: Arc::new(displacements),
    }
}

fn with_examples(mut scene: Scene, shapes: Vec<ExampleShape>) -> Scene {
    let examples = Examples {
        weights: vec![None; shapes.len()],
        shapes: Arc::new(shapes),
    };
    scene.attachments = vec![("examples", Attachment::Shapes(examples))];
    scene
}

/// The scene with both poses sculpted.
fn taught(scene: Scene) -> Scene {
    let shapes = poses(&scene).map(|pose| sculpted(&scene, pose, 25.0));
    with_examples(scene, shapes.into())
}

fn examples(scene: &Scene) -> &[ExampleShape] {
    let Attachment::Shapes(examples) = &scene.attachments[0].1 else {
        unreachable!("examples were brought")
    };
    &examples.shapes
}

/// The displacements by the bi-Laplacian alone.
fn coarse(scene: &Scene, pose: DAffine3) -> Vec<DVec3> {
    let plain = Method::from_name("bilaplacian").unwrap();
    let (topology, progress, cancel) = (&scene.model.topology, Progress::new(), Cancel::new());
    let ordering = plain.ordering(topology, &progress, &cancel).unwrap();
    let bound = scene.problem(&plain).bind(ordering.as_ref(), &progress, &cancel);
    step(&mut bound.unwrap(), &[pose])
}

/// The distance of each vertex from the coarse shape.
fn details(scene: &Scene, shape: &[DVec3], pose: DAffine3) -> Vec<f64> {
    let coarse = coarse(scene, pose);
    shape.iter().zip(&coarse).map(|(a, b)| a.distance(*b)).collect()
}

fn largest(values: &[f64]) -> f64 {
    values.iter().copied().fold(0.0, f64::max)
}

#[test]
fn an_examples_own_handle_transforms_give_it_back() {
    for scene in scenes().into_iter().map(taught) {
        let bound = &mut scene.bind();
        for (pose, example) in poses(&scene).into_iter().zip(examples(&scene)) {
            for shape in [step(bound, &[pose]), back_substitute(bound, &[pose])] {
                let error = apart(&shape, &example.displacements) / scene.diagonal();
                assert!(error < 1e-6, "{error:e}");
            }
            // The bi-Laplacian alone would not make it.
            assert!(largest(&details(&scene, &example.displacements, pose)) > 0.02 * scene.diagonal());
        }
    }
}

#[test]
fn rest_is_rest_to_the_bit_whatever_the_weights() {
    for scene in scenes().into_iter().map(taught) {
        let bound = &mut scene.bind();
        for weights in [[None, None], [Some(1.0), Some(-2.0)]] {
            bound.set_weights(&weights).unwrap();
            step(bound, &[poses(&scene)[0]]);
            let shape = step(bound, &[DAffine3::IDENTITY]);
            assert!(shape.iter().all(|displacement| *displacement == DVec3::ZERO));
            // Next to rest there is almost none: no wrinkle appears suddenly.
            let shape = step(bound, &[DAffine3::from_translation(DVec3::X * 1e-9)]);
            assert!(shape.iter().all(|displacement| displacement.length() < 1e-6));
        }
    }
}

#[test]
fn without_examples_it_is_the_bilaplacian_to_the_bit() {
    for mut scene in scenes() {
        let bounds = scene.model.bounds().unwrap();
        for (stiffness, p) in scene.stiffness.iter_mut().zip(&scene.model.surface.positions) {
            *stiffness = if p.x > bounds.centre().x { 5.0 } else { 1.0 };
        }
        scene.soft = vec![Some(3.0)];
        scene.continuity = vec![1.0; scene.roles.len()];
        for pose in poses(&scene) {
            let shapes = ["bilaplacian", "wrinkles"].map(|name| {
                scene.method = Method::from_name(name).unwrap();
                scene.moved(&[pose])
            });
            assert!(shapes[0] == shapes[1]);
        }
    }
}

/// Its details are also zero at a weight of 0, and in proportion to the weight.
#[test]
fn a_weight_multiplies_what_an_example_adds() {
    for scene in scenes() {
        let pose = poses(&scene)[0];
        let example = sculpted(&scene, pose, 25.0);
        let scene = with_examples(scene, vec![example]);
        let bound = &mut scene.bind();
        let at = coarse(&scene, pose);
        let example = &examples(&scene)[0].displacements;
        for weight in [0.0, 0.5, -1.0, 2.0] {
            bound.set_weights(&[Some(weight)]).unwrap();
            let shape = step(bound, &[pose]);
            let expected: Vec<DVec3> = at
                .iter()
                .zip(&**example)
                .map(|(c, e)| *c + (*e - *c) * weight)
                .collect();
            let error = apart(&shape, &expected) / scene.diagonal();
            assert!(error < 2e-6, "{weight}: {error:e}");
            assert_eq!(bound.weights(), [weight]);
        }
    }
}

/// At half the displacement there are about half the wrinkles, beyond the full one they stay, and a pull instead of a
/// push makes none.
#[test]
fn wrinkles_grow_with_the_strain_and_only_in_its_direction() {
    let scene = held(shapes::grid(40, 24));
    let push = poses(&scene)[0];
    let pushed = |share: f64| DAffine3::from_translation(push.translation * share);
    let example = sculpted(&scene, push, 25.0);
    let full = largest(&details(&scene, &example.displacements, push));
    let scene = with_examples(scene, vec![example]);
    let bound = &mut scene.bind();
    let mut share = |way: f64| largest(&details(&scene, &step(bound, &[pushed(way)]), pushed(way))) / full;
    let (half, beyond, pulled) = (share(0.5), share(1.5), share(-1.0));
    assert!((0.4..0.6).contains(&half), "{half}");
    assert!((0.9..1.1).contains(&beyond), "{beyond}");
    assert!(pulled < 0.1, "{pulled}");
}

/// The example pushes from both sides; a push from one side wrinkles only that side.
#[test]
fn one_side_does_not_wrinkle_the_other() {
    let scene = Scene::new(shapes::grid(60, 20))
        .with(Role::Fixed, |p| (p.x - 0.5).abs() < 0.06)
        .with(Role::Handle(0), |p| p.x < 0.08)
        .with(Role::Handle(1), |p| p.x > 0.92);
    let way = 0.08;
    let pushed = |p: DVec3| {
        let share = ((p.x - 0.5).abs() - 0.06).max(0.0) / 0.36;
        let share = share.min(1.0);
        let fold = 0.02 * (40.0 * share).sin() * share * (1.0 - share) * 4.0;
        DVec3::new(-(p.x - 0.5).signum() * way * share, 0.0, fold)
    };
    let example = ExampleShape {
        name: "pushed".to_owned(),
        displacements: Arc::new(scene.positions().iter().map(|p| pushed(*p)).collect()),
    };
    let mut scene = with_examples(scene, vec![example]);
    scene.method = Method::from_name("wrinkles").unwrap();
    let bound = &mut scene.bind();
    let shape = step(
        bound,
        &[DAffine3::IDENTITY, DAffine3::from_translation(DVec3::NEG_X * way)],
    );
    let mut seen = [0; 2];
    for (p, (own, example)) in scene
        .positions()
        .iter()
        .zip(shape.iter().zip(&*examples(&scene)[0].displacements))
    {
        if p.x < 0.4 {
            assert_eq!(*own, DVec3::ZERO, "{p}");
            seen[0] += 1;
        } else if p.x > 0.6 {
            assert!(own.distance(*example) < 1e-6, "{p}");
            seen[1] += 1;
        }
    }
    assert!(seen.iter().all(|count| *count > 300), "{seen:?}");
}

#[test]
fn the_problem_turned_turns_the_result() {
    let world = turned(DVec3::ONE, 2.2, DVec3::new(3.0, -2.0, 1.0));
    for here in scenes().into_iter().map(taught) {
        let turned_example = |example: &ExampleShape| ExampleShape {
            name: example.name.clone(),
            displacements: Arc::new(
                example
                    .displacements
                    .iter()
                    .map(|d| world.transform_vector3(*d))
                    .collect(),
            ),
        };
        let mut there = held(shapes::grid(2, 2));
        there.model = here.model.clone();
        for p in &mut there.model.surface.positions {
            *p = world.transform_point3(*p);
        }
        (there.roles, there.stiffness) = (here.roles.clone(), here.stiffness.clone());
        let there = with_examples(there, examples(&here).iter().map(turned_example).collect());
        let [push, lift] = poses(&here);
        for pose in [push, lift, lift * push] {
            let expected: Vec<DVec3> = here
                .moved(&[pose])
                .iter()
                .map(|d| world.transform_vector3(*d))
                .collect();
            let error = apart(&there.moved(&[world * pose * world.inverse()]), &expected) / here.diagonal();
            assert!(error < 1e-6, "{pose:?}: {error:e}");
        }
    }
}

#[test]
fn the_number_of_threads_does_not_show_in_wrinkles() {
    let run = || {
        let scene = taught(held(shapes::torus(60, 40)));
        let bound = &mut scene.bind();
        poses(&scene).map(|pose| step(bound, &[pose * scaled(DVec3::ZERO, DVec3::splat(0.9))]))
    };
    same_on_any_number_of_threads(run, "wrinkles");
}

#[test]
fn extreme_targets_leave_no_trace_in_wrinkles() {
    for scene in scenes().into_iter().map(taught) {
        extremes_leave_no_trace(&scene, step, "wrinkles");
    }
}

/// A bump at a place that the handle does not move: no pose of the handle explains it.
#[test]
fn what_no_strain_brings_back_is_told_by_name() {
    let scene = held(shapes::grid(40, 24));
    let bump = |p: &DVec3| DVec3::Z * 0.05 * (1.0 - 8.0 * p.distance(DVec3::new(0.5, 0.5, 0.0))).max(0.0);
    let example = ExampleShape {
        name: "bump".to_owned(),
        displacements: Arc::new(scene.positions().iter().map(bump).collect()),
    };
    let sound = sculpted(&scene, poses(&scene)[0], 25.0);
    let scene = with_examples(scene, vec![sound, example]);
    let bound = scene.bind();
    let sentences: Vec<String> = bound.warnings().iter().map(ToString::to_string).collect();
    let told: Vec<&String> = sentences
        .iter()
        .filter(|sentence| sentence.contains("strain"))
        .collect();
    assert!(told.len() == 1 && told[0].contains("\"bump\""), "{sentences:?}");
}
