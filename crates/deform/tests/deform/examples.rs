//! The laws of shells with examples.

use std::sync::Arc;

use crate::rig::{Scene, apart, settle};
use crate::shared::same_on_any_number_of_threads;
use glam::{DAffine3, DQuat, DVec3};
use pliant_deform::{
    Attachment, AttachmentRefused, BindError, Bound, ExampleShape, Examples, Method, RigidMotion, Role, Shells,
    SolveError,
};
use pliant_mesh::shapes;

/// The start and the end of the bar's elbow, as shares of its length.
const ELBOW: [f64; 2] = [0.35, 0.65];

fn method(led_above: usize) -> Method {
    let mut shells = Shells::default();
    shells.led_above = led_above;
    shells.tolerance = 1e-10;
    shells.into()
}

/// A bar along x with its upper arm fixed.
fn bar() -> Scene {
    let mut scene = Scene::new(shapes::bar(24, 3, 3));
    scene.method = method(usize::MAX);
    scene.with(Role::Fixed, |p| p.x < 3.5)
}

/// A place along the bar with the elbow bent upwards by an angle along an arc.
fn bent(scene: &Scene, angle: f64, p: DVec3) -> DVec3 {
    let bounds = scene.model.bounds().unwrap();
    let [from, to] = ELBOW.map(|share| bounds.min.x + share * bounds.extent().x);
    let share = ((p.x - from) / (to - from)).clamp(0.0, 1.0);
    let (turned, radius) = (share * angle, (to - from) / angle);
    let (sine, cosine) = turned.sin_cos();
    let along = p.x - from - share * (to - from);
    let up = p.z - bounds.centre().z;
    DVec3::new(
        from + radius * sine + along * cosine - up * sine,
        p.y,
        bounds.centre().z + radius * (1.0 - cosine) + along * sine + up * cosine,
    )
}

fn example(scene: &Scene, to: impl Fn(DVec3) -> DVec3) -> ExampleShape {
    ExampleShape {
        name: "example".to_owned(),
        displacements: Arc::new(scene.positions().iter().map(|p| to(*p) - *p).collect()),
    }
}

fn with_examples(mut scene: Scene, shapes: Vec<ExampleShape>, weights: &[Option<f64>]) -> Scene {
    let examples = Examples {
        shapes: Arc::new(shapes),
        weights: weights.to_vec(),
    };
    scene.attachments = vec![("examples", Attachment::Shapes(examples))];
    scene
}

fn example_of(scene: &Scene, number: usize) -> &[DVec3] {
    let Attachment::Shapes(examples) = &scene.attachments[0].1 else {
        unreachable!("examples were brought")
    };
    &examples.shapes[number].displacements
}

/// The bar with an example whose elbow is bent by this angle.
fn armed(angle: f64) -> Scene {
    let scene = bar();
    let own = example(&scene, |p| bent(&scene, angle, p));
    with_examples(scene, vec![own], &[Some(0.0)])
}

fn at_weight(bound: &mut Bound, weight: f64) -> Vec<DVec3> {
    bound.set_weights(&[Some(weight)]).unwrap();
    settle(bound, &[]).0
}

#[test]
fn the_weight_0_is_rest_to_the_bit_and_1_the_example() {
    for angle in [1.0, 2.0] {
        let scene = armed(angle);
        let bound = &mut scene.bind();
        for weight in [1.0, 0.3, 1.0, 0.0] {
            let shape = at_weight(bound, weight);
            if weight == 1.0 {
                let error = apart(&shape, example_of(&scene, 0)) / scene.diagonal();
                assert!(error < 1e-4, "{angle}: {error:e}");
            }
        }
        let mut shape = vec![DVec3::ONE; scene.positions().len()];
        bound.step(&mut shape).unwrap();
        assert!(shape.iter().all(|displacement| *displacement == DVec3::ZERO));
    }
}

#[test]
fn between_and_beyond_an_arm_goes_along_its_arc() {
    let scene = armed(1.2);
    let bound = &mut scene.bind();
    let arm: Vec<usize> = (0..scene.roles.len())
        .filter(|&v| scene.positions()[v].x > 0.75 * 24.0)
        .collect();
    let rest: Vec<DVec3> = arm.iter().map(|&v| scene.positions()[v]).collect();
    let length = |shape: &[DVec3]| {
        let mean = |test: &dyn Fn(f64) -> bool| {
            let own: Vec<DVec3> = arm
                .iter()
                .filter(|&&v| test(scene.positions()[v].x))
                .map(|&v| scene.positions()[v] + shape[v])
                .collect();
            own.iter().sum::<DVec3>() / own.len() as f64
        };
        mean(&|x| x < 19.5).distance(mean(&|x| x > 23.5))
    };
    let at_rest = length(&vec![DVec3::ZERO; scene.roles.len()]);
    for weight in [0.25, 0.5, 0.75, 1.5] {
        let shape = at_weight(bound, weight);
        let moved: Vec<DVec3> = arm.iter().map(|&v| shape[v]).collect();
        let turn = RigidMotion::fit(&rest, &moved).unwrap().rotation();
        let angle = turn.angle_between(DQuat::IDENTITY);
        assert!((angle / (1.2 * weight) - 1.0).abs() < 0.02, "{weight}: {angle}");
        let ratio = length(&shape) / at_rest;
        assert!((ratio - 1.0).abs() < 0.01, "{weight}: {ratio}");
    }
}

/// The tip is held at its position in the example.
#[test]
fn an_examples_own_constraints_give_it_back_with_a_free_weight() {
    for led_above in [usize::MAX, 0] {
        for angle in [0.8, 1.6] {
            let mut scene = bar().with(Role::Handle(0), |p| p.x > 22.5);
            scene.method = method(led_above);
            let examples = vec![
                example(&scene, |p| bent(&scene, angle, p)),
                example(&scene, |p| p + DVec3::Y * (0.3 * p.x).sin()),
            ];
            let scene = with_examples(scene, examples, &[None, None]);
            let at = |p: DVec3| bent(&scene, angle, p);
            let (tip, axes) = (DVec3::new(24.0, 0.0, 0.0), DVec3::AXES);
            let linear = glam::DMat3::from_cols_array_2d(&axes.map(|axis| (at(tip + axis * 0.1) - at(tip)).to_array()));
            let target = DAffine3::from_translation(at(tip))
                * DAffine3::from_mat3(linear * 10.0)
                * DAffine3::from_translation(-tip);
            let bound = &mut scene.bind();
            let (shape, _) = settle(bound, &[target]);
            let error = apart(&shape, example_of(&scene, 0)) / scene.diagonal();
            assert!(error < 1e-4, "{led_above} {angle}: {error:e}, {:?}", bound.weights());
            assert!((bound.weights()[0] - 1.0).abs() < 1e-3 && bound.weights()[1].abs() < 1e-3);
        }
    }
}

#[test]
fn the_energy_never_rises_towards_weights_and_handles() {
    let scene = bar().with(Role::Handle(0), |p| p.x > 22.5);
    let examples = vec![
        example(&scene, |p| bent(&scene, 1.3, p)),
        example(&scene, |p| p * DVec3::new(1.0, 1.3, 1.0)),
    ];
    let scene = with_examples(scene, examples, &[None, Some(0.5)]);
    let bound = &mut scene.bind();
    for weights in [
        [None, Some(0.5)],
        [Some(1.4), None],
        [None, None],
        [Some(-1.0), Some(2.0)],
    ] {
        bound.set_weights(&weights).unwrap();
        for target in [
            DAffine3::from_translation(DVec3::Z * 6.0),
            DAffine3::from_rotation_x(1.5),
        ] {
            let (_, energies) = settle(bound, &[target]);
            assert!(energies.is_sorted_by(|a, b| a >= b), "{weights:?}: {energies:?}");
        }
    }
}

/// Nothing is fixed, and the parts turn and move apart.
#[test]
fn parts_that_nothing_holds_go_with_their_examples_along_arcs() {
    for led_above in [usize::MAX, 0] {
        let parts = [
            shapes::bar(12, 2, 2),
            shapes::moved(&shapes::icosphere(2), DAffine3::from_translation(DVec3::Z * 6.0)),
        ];
        let mut scene = Scene::new(shapes::together(&parts));
        scene.method = method(led_above);
        let posed = |p: DVec3| match p.z > 4.0 {
            true => DQuat::from_rotation_x(1.0) * (p - DVec3::Z * 6.0) * 1.2 + DVec3::new(2.0, 0.0, 6.0),
            false => DQuat::from_rotation_z(2.0) * p,
        };
        let scene = {
            let own = example(&scene, posed);
            with_examples(scene, vec![own], &[Some(0.0)])
        };
        let bound = &mut scene.bind();
        let full = at_weight(bound, 1.0);
        let error = apart(&full, example_of(&scene, 0)) / scene.diagonal();
        assert!(error < 1e-4, "{led_above}: {error:e}");
        let half = at_weight(bound, 0.5);
        let part = |is_in: &dyn Fn(DVec3) -> bool| {
            let own = scene.positions().iter().zip(&half).filter(|(p, _)| is_in(**p));
            own.map(|(p, d)| (*p, *d)).unzip::<_, _, Vec<DVec3>, Vec<DVec3>>()
        };
        let (rest, moved) = part(&|p| p.z < 4.0);
        let fit = RigidMotion::fit(&rest, &moved).unwrap();
        let error = rest
            .iter()
            .zip(&moved)
            .map(|(p, d)| fit.displace(*p).distance(*d))
            .fold(0.0, f64::max);
        assert!(error < 1e-4 * scene.diagonal(), "{led_above}: {error:e}");
        assert!(
            fit.rotation().angle_between(DQuat::from_rotation_z(1.0)) < 1e-3,
            "{led_above}"
        );
        let (rest, moved) = part(&|p| p.z > 4.0);
        let sphere: Vec<DVec3> = rest.iter().zip(&moved).map(|(p, d)| *p + *d).collect();
        let centre = sphere.iter().sum::<DVec3>() / sphere.len() as f64;
        assert!(
            centre.distance(DVec3::new(1.0, 0.0, 6.0)) < 0.1,
            "{led_above}: {centre}"
        );
        assert!(
            sphere.iter().all(|p| (p.distance(centre) - 1.1).abs() < 0.01),
            "{led_above}"
        );
    }
}

#[test]
fn weights_that_are_set_later_give_what_those_brought_give() {
    let mut scene = armed(1.0);
    let bound = &mut scene.bind();
    let later = at_weight(bound, 0.6);
    let Attachment::Shapes(examples) = &mut scene.attachments[0].1 else {
        unreachable!("examples were brought")
    };
    examples.weights = vec![Some(0.6)];
    let bound = &mut scene.bind();
    let brought = settle(bound, &[]).0;
    assert_eq!(bound.weights(), [0.6]);
    assert!(apart(&later, &brought) < 1e-6 * scene.diagonal());
}

/// This includes a fold within an edge's length: at the first step.
#[test]
fn a_fold_of_an_example_is_there_at_the_first_step_with_a_coarse_level_and_without() {
    for led_above in [usize::MAX, 0] {
        let mut scene = bar();
        scene.method = method(led_above);
        let folded = |p: DVec3| match p.x > 12.2 {
            true => DVec3::new(12.0, 0.0, 0.0) + DQuat::from_rotation_y(-1.4) * (p - DVec3::X * 12.0),
            false => p,
        };
        let own = example(&scene, folded);
        let scene = with_examples(scene, vec![own], &[Some(1.0)]);
        let bound = &mut scene.bind();
        bound.set_targets(&[]).unwrap();
        let mut shape = vec![DVec3::ZERO; scene.positions().len()];
        bound.step(&mut shape).unwrap();
        let error = apart(&shape, example_of(&scene, 0)) / scene.diagonal();
        assert!(error < 1e-3, "{led_above}: {error:e}");
    }
}

/// A coarse level changes the way to the shape, not the shape.
#[test]
fn a_coarse_level_leads_to_the_same_blend() {
    let [own, led] = [usize::MAX, 0].map(|led_above| {
        let mut scene = armed(1.2);
        scene.method = method(led_above);
        (at_weight(&mut scene.bind(), 0.5), scene.diagonal())
    });
    let error = apart(&own.0, &led.0) / own.1;
    assert!(error < 2e-3, "{error:e}");
}

#[test]
fn the_number_of_threads_does_not_show_with_examples() {
    let run = || {
        let scene = Scene::new(shapes::torus(60, 40)).with(Role::Handle(0), |p| p.x > 1.1);
        let examples = vec![
            example(&scene, |p| DQuat::from_rotation_z(p.x) * p),
            example(&scene, |p| p * (1.0 + 0.2 * p.y)),
        ];
        let mut scene = with_examples(scene, examples, &[None, Some(0.3)]);
        scene.method = Method::from_name("shells").unwrap();
        let bound = &mut scene.bind();
        let mut shape = vec![DVec3::ZERO; scene.positions().len()];
        bound.set_targets(&[DAffine3::from_rotation_y(0.5)]).unwrap();
        let energy = (0..6).map(|_| bound.step(&mut shape).unwrap().energy).last();
        let mut free = with_examples(Scene::new(shapes::icosphere(4)), Vec::new(), &[]);
        free.method = method(0);
        let own = example(&free, |p| DQuat::from_rotation_z(p.z) * p);
        let free = with_examples(free, vec![own], &[Some(0.5)]);
        let mut blend = vec![DVec3::ZERO; free.positions().len()];
        let bound = &mut free.bind();
        bound.set_targets(&[]).unwrap();
        (0..3).for_each(|_| {
            bound.step(&mut blend).unwrap();
        });
        (shape, energy, blend)
    };
    same_on_any_number_of_threads(run, "examples");
}

#[test]
fn what_does_not_fit_is_refused_by_name() {
    let scene = bar();
    let mut short = example(&scene, |p| p);
    short.displacements = Arc::new(vec![DVec3::ZERO; 5]);
    let scene = with_examples(scene, vec![short], &[Some(1.0)]);
    let refused = scene.try_bind().unwrap_err();
    let expected = scene.positions().len();
    let sentence = format!(
        "the examples can't be used: \"example\" has 5 vertices, but the surface has {expected}: give examples of the same mesh"
    );
    assert_eq!(refused.to_string(), sentence);
    for weight in [f64::NAN, 11.0] {
        let mut scene = armed(1.0);
        let own = vec![example(&scene, |p| p)];
        scene = with_examples(scene, own, &[Some(weight)]);
        let refused = scene.try_bind().unwrap_err();
        assert!(
            matches!(
                refused,
                BindError::Attachment {
                    refused: AttachmentRefused::Weight { place: 0, .. },
                    ..
                }
            ),
            "{refused}"
        );
    }
    let bound = &mut armed(1.0).bind();
    assert!(matches!(bound.set_weights(&[]), Err(SolveError::Controls { .. })));
    assert!(matches!(
        bound.set_weights(&[Some(f64::NAN)]),
        Err(SolveError::Controls { .. })
    ));
}

/// An example that is the rest shape, one that is another's double, and one that collapses a part to a point.
#[test]
fn useless_examples_leave_finite_shapes() {
    let scene = bar().with(Role::Handle(0), |p| p.x > 22.5);
    let examples = vec![
        example(&scene, |p| p),
        example(&scene, |p| bent(&scene, 1.0, p)),
        example(&scene, |p| bent(&scene, 1.0, p)),
        example(&scene, |p| if p.x > 12.0 { DVec3::X * 12.0 } else { p }),
    ];
    let scene = with_examples(scene, examples, &[None; 4]);
    let (shape, _) = settle(
        &mut scene.bind(),
        &[DAffine3::from_translation(DVec3::new(-4.0, 0.0, 5.0))],
    );
    assert!(
        shape
            .iter()
            .all(|displacement| displacement.length() < scene.diagonal())
    );
}
