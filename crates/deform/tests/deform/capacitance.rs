//! The thin plate by the Laplacian's factor: the same shape as by its own, on every class of mesh and constraint.

use glam::{DAffine3, DVec3};
use pliant_deform::{Bilaplacian, BindError, Bound, Budget, Detail, Method, Ordering, Role};
use pliant_mesh::{Cancel, Progress, shapes};

use crate::rig::{Scene, apart, back_substitute, far, step};
use crate::shared::same_on_any_number_of_threads;

/// The largest distance between both shapes, in diagonals.
const SAME: f64 = 1e-6;

/// A binding with an ordering of power 1, so that the plate's own factor is not even tried.
fn by_laplacian(scene: &Scene) -> Result<Bound, BindError> {
    let (progress, cancel) = (Progress::new(), Cancel::new());
    let ordering = Ordering::of(&scene.model.topology, 1, &progress, &cancel).unwrap();
    scene.problem(&scene.method).bind(&ordering, &progress, &cancel)
}

/// A binding with the method's ordering and this much memory.
fn within(scene: &Scene, bytes: u64) -> Result<Bound, BindError> {
    let (progress, cancel) = (Progress::new(), Cancel::new());
    let ordering = scene
        .method
        .ordering(&scene.model.topology, &progress, &cancel)
        .unwrap();
    let budget = Budget {
        bytes,
        ..Budget::default()
    };
    let problem = scene.problem(&scene.method);
    problem.bind_within(ordering.as_ref(), budget, &progress, &cancel)
}

/// Returns true if the binding reports a solution by the Laplacian's factor.
fn says_so(bound: &Bound) -> bool {
    bound
        .warnings()
        .iter()
        .any(|warning| warning.to_string().contains("Laplacian's factor"))
}

/// Both bindings of a scene give the same shape and energy, from the bases and from a new solve.
fn agrees(scene: &Scene, what: &str) {
    let targets: Vec<DAffine3> = far(scene);
    let (mut factor, mut laplacian) = (scene.bind(), by_laplacian(scene).unwrap());
    assert!(says_so(&laplacian) && !says_so(&factor), "{what}");
    let expected = step(&mut factor, &targets);
    for found in [
        step(&mut laplacian, &targets),
        back_substitute(&mut laplacian, &targets),
    ] {
        let error = apart(&found, &expected) / scene.diagonal();
        assert!(error < SAME, "{what}: {error:e}");
    }
    let energies = [&factor, &laplacian].map(|bound| bound.energy_of(&expected).unwrap());
    assert!(
        (energies[0] - energies[1]).abs() <= 1e-9 * energies[0].abs(),
        "{what}: {energies:?}"
    );
}

#[test]
fn by_the_laplacian_s_factor_paint_counts_and_it_is_said_that_stiff_parts_may_shear() {
    let mut scene = Scene::new(shapes::torus(40, 20)).with_ends(true);
    for (own, p) in scene.stiffness.iter_mut().zip(&scene.model.surface.positions) {
        *own = if p.x.abs() < 0.4 { 30.0 } else { 1.0 };
    }
    let said = |bound: &Bound| {
        bound
            .warnings()
            .iter()
            .any(|said| said.to_string().contains("may shear"))
    };
    let (own, plain) = (scene.bind(), by_laplacian(&scene).unwrap());
    assert!(said(&plain) && says_so(&plain) && !said(&own));
    scene.stiffness.fill(1.0);
    assert!(!said(&by_laplacian(&scene).unwrap()));
}

#[test]
fn both_factors_give_the_same_shape_on_every_class_of_mesh() {
    for (name, drawn) in shapes::classes() {
        for fixed in [true, false] {
            agrees(&Scene::new(drawn.clone()).with_ends(fixed), name);
        }
    }
}

#[test]
fn both_factors_give_the_same_shape_under_soft_handles_and_hinges() {
    for (name, drawn) in [
        ("torus", shapes::torus(30, 16)),
        ("sheet", shapes::grid(16, 12)),
        ("tube", shapes::tube(14, 20, 4.0)),
    ] {
        for weight in [0.01, 1.0, 100.0] {
            let mut scene = Scene::new(drawn.clone()).with_ends(true);
            scene.soft = vec![Some(weight); scene.handle_count];
            agrees(&scene, name);
        }
        for continuity in [0.0, 0.4, 1.0] {
            let mut scene = Scene::new(drawn.clone()).with_ends(true);
            scene.continuity = vec![continuity; scene.roles.len()];
            agrees(&scene, name);
        }
    }
}

#[test]
fn both_factors_give_the_same_shape_of_a_larger_mesh_with_several_handles() {
    let drawn = shapes::torus(120, 60);
    let mut scene = Scene::new(drawn).with(Role::Fixed, |p| p.x < -1.0);
    for handle in 0..5 {
        let angle = 0.9 * (f64::from(handle) - 2.0);
        let centre = DVec3::new(angle.cos(), angle.sin(), 0.0) * scene.diagonal() * 0.3;
        scene = scene.with(Role::Handle(handle as u16), |p| p.distance(centre) < 0.35);
    }
    assert_eq!(scene.handle_count, 5);
    agrees(&scene, "five handles");
}

#[test]
fn the_laplacian_s_factor_gives_the_same_bits_on_any_number_of_threads() {
    let mut scene = Scene::new(shapes::icosphere(4)).with_ends(true);
    scene.soft = vec![Some(2.0)];
    let bits = || {
        let shape = step(&mut by_laplacian(&scene).unwrap(), &far(&scene));
        shape.iter().map(|d| d.to_array().map(f64::to_bits)).collect::<Vec<_>>()
    };
    same_on_any_number_of_threads(bits, "by the Laplacian's factor");
}

#[test]
fn where_the_own_factor_does_not_fit_the_laplacian_s_is_taken_and_said_and_below_that_refused() {
    let scene = Scene::new(shapes::icosphere(5)).with_ends(true);
    let plenty = within(&scene, 1 << 30).unwrap();
    let free = plenty.solved_count() as u64;
    let expected = step(&mut within(&scene, 1 << 30).unwrap(), &far(&scene));
    let (mut taken, mut refused) = (0, 0);
    let mut was_direct = true;
    for share in (1..40).rev() {
        match within(&scene, free * 100 * share) {
            Ok(mut bound) => {
                assert_eq!(refused, 0, "less memory is enough where more was not: {share}");
                assert!(was_direct || says_so(&bound));
                was_direct = !says_so(&bound);
                taken += usize::from(says_so(&bound));
                let error = apart(&step(&mut bound, &far(&scene)), &expected) / scene.diagonal();
                assert!(error < SAME, "{share}: {error:e}");
            }
            Err(BindError::Budget { .. }) => refused += 1,
            Err(other) => panic!("{other}"),
        }
    }
    assert!(taken > 0 && refused > 0, "{taken} {refused}");
}

/// The plate near the rim covers waves along it, so that few directions remain to be found.
#[test]
fn the_directions_are_few_beside_the_rim_s_vertices() {
    let scene = Scene::new(shapes::tube(128, 400, 3.0)).with_ends(true);
    let bound = by_laplacian(&scene).unwrap();
    let sentence = bound
        .warnings()
        .iter()
        .map(ToString::to_string)
        .find(|said| said.contains("rim"));
    let sentence = sentence.unwrap();
    let before = |words: &str| -> usize {
        let (left, _) = sentence.split_once(words).unwrap();
        left.rsplit(' ').next().unwrap().parse().unwrap()
    };
    let (directions, rim) = (before(" conjugate directions"), before(" vertices at the rim"));
    assert!(rim > 100 && 10 * directions < rim, "{sentence}");
}

#[test]
fn options_that_the_laplacian_s_factor_can_not_solve_are_refused_as_before() {
    let mut scene = Scene::new(shapes::icosphere(5)).with_ends(true);
    let mut stretched = Bilaplacian::default();
    stretched.stretching = 3.0;
    let mut detailed = Bilaplacian::default();
    detailed.detail = Detail::NormalDisplacements;
    for options in [stretched, detailed] {
        scene.method = Method::from(options);
        assert!(matches!(by_laplacian(&scene), Err(BindError::Ordering { .. })));
    }
}

#[test]
fn a_small_budget_asks_for_the_ordering_of_the_laplacian() {
    let scene = Scene::new(shapes::icosphere(4)).with_ends(true);
    let power = |bytes: u64| {
        let budget = Budget {
            bytes,
            ..Budget::default()
        };
        scene.problem(&scene.method).ordering_power_within(budget)
    };
    assert_eq!((power(1 << 30), power(1 << 10)), (Some(2), Some(1)));
}

#[test]
fn a_raised_flag_ends_binding_by_the_laplacian_s_factor() {
    let scene = Scene::new(shapes::icosphere(4)).with_ends(true);
    let (progress, cancel) = (Progress::new(), Cancel::new());
    let ordering = Ordering::of(&scene.model.topology, 1, &progress, &cancel).unwrap();
    cancel.cancel();
    let bound = scene.problem(&scene.method).bind(&ordering, &progress, &cancel);
    assert!(matches!(bound, Err(BindError::Cancelled(_))));
}
