//! Laws of several families of methods. Each family calls them with its own scenes, and with `run`, which moves the
//! handles and returns the displacements.

use std::f64::consts::PI;

use crate::rig::{Scene, apart, far, scaled, turned};
use glam::{DAffine3, DMat3, DVec3};
use pliant_deform::Bound;
use pliant_mesh::Drawn;

/// Extreme targets, unlikely in use.
pub fn extreme(scene: &Scene) -> [DAffine3; 8] {
    let (centre, size) = (scene.model.bounds().unwrap().centre(), scene.diagonal());
    [
        DAffine3::from_translation(DVec3::new(-3.0, 0.1, 0.0) * size),
        turned(centre, PI, DVec3::ZERO),
        scaled(centre, DVec3::ZERO),
        scaled(centre, DVec3::splat(-1.0)),
        scaled(centre, DVec3::new(1.0, 1.0, -2.0)),
        scaled(centre, DVec3::splat(1e4)),
        DAffine3::from_mat3(DMat3::ZERO),
        DAffine3::from_translation(DVec3::X * 1e6 * size),
    ]
}

/// A target beyond the range of numbers is refused, or met; the step's output is finite, and zero if it refuses.
pub fn finite_beyond_all_bounds(bound: &mut Bound, target: DAffine3, handle_count: usize) {
    bound.set_targets(&vec![target; handle_count]).unwrap();
    let mut out = vec![DVec3::NAN; bound.vertex_count()];
    let refused = bound.step(&mut out).is_err();
    assert!(out.iter().all(|d| d.is_finite()) && (!refused || out.iter().all(|d| *d == DVec3::ZERO)));
}

/// Extreme targets give finite shapes. After them and a step at rest, a drag gives the same bits as before.
pub fn extremes_leave_no_trace(scene: &Scene, run: impl Fn(&mut Bound, &[DAffine3]) -> Vec<DVec3>, what: &str) {
    let expected = run(&mut scene.bind(), &far(scene));
    let bound = &mut scene.bind();
    for target in extreme(scene) {
        let shape = run(bound, &vec![target; scene.handle_count]);
        assert!(shape.iter().all(|d| d.is_finite()), "{what}");
    }
    finite_beyond_all_bounds(bound, DAffine3::from_scale(DVec3::splat(1e200)), scene.handle_count);
    run(bound, &vec![DAffine3::IDENTITY; scene.handle_count]);
    assert!(run(bound, &far(scene)) == expected, "{what}");
}

/// `result` is the same to the bit on one, two and three threads.
pub fn same_on_any_number_of_threads<T: PartialEq + Send>(result: impl Fn() -> T + Sync, what: &str) {
    let on = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(&result)
    };
    let one = on(1);
    assert!(one == on(2) && one == on(3), "{what}");
}

/// The shape, its constraints and its targets turned together give the turned result. `scene` makes a scene with its
/// constraints.
pub fn turned_problem_turns_the_result(
    drawn: Drawn,
    scene: impl Fn(Drawn) -> Scene,
    run: impl Fn(&mut Bound, &[DAffine3]) -> Vec<DVec3>,
    what: &str,
) {
    let here = scene(drawn.clone());
    let world = turned(DVec3::ONE, 2.2, DVec3::new(3.0, -2.0, 1.0));
    let mut there = scene(drawn);
    for p in &mut there.model.surface.positions {
        *p = world.transform_point3(*p);
    }
    there.roles.clone_from(&here.roles);
    let targets = far(&here);
    let carried: Vec<DAffine3> = targets.iter().map(|t| world * *t * world.inverse()).collect();
    let shape = run(&mut here.bind(), &targets);
    let expected: Vec<DVec3> = shape.iter().map(|d| world.transform_vector3(*d)).collect();
    let error = apart(&run(&mut there.bind(), &carried), &expected) / here.diagonal();
    assert!(error < 1e-6, "{what}: {error:e}");
}
