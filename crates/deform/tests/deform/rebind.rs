//! Laws of binding again after a stroke.

use glam::DVec3;
use pliant_deform::{Bound, Ordering, Role};
use pliant_mesh::{Cancel, Progress, shapes};

use crate::rig::{Scene, back_substitute, turned};

/// All results of a bound bi-Laplacian, as bits.
fn bits(bound: &mut Bound) -> Vec<u64> {
    let bases = bound.handle_bases().unwrap().rows().to_vec();
    let turn = turned(DVec3::X, 0.4, DVec3::new(0.1, 0.2, -0.3));
    let targets = vec![turn; bound.handle_bases().unwrap().handle_count()];
    let solved = back_substitute(bound, &targets);
    let bases = bases.iter().flatten().map(|value| u64::from(value.to_bits()));
    let solved = solved.iter().flat_map(|d| d.to_array()).map(f64::to_bits);
    bases.chain(solved).collect()
}

/// A name, a change, and the least share of the factor that is reused.
type Stroke = (&'static str, fn(&mut Scene), f64);

fn scene() -> Scene {
    Scene::new(shapes::icosphere(5))
        .with(Role::Fixed, |p| p.z < -0.8)
        .with(Role::Handle(0), |p| p.z > 0.8)
}

#[test]
fn binding_again_gives_what_binding_gives_to_the_bit() {
    let strokes: [Stroke; 5] = [
        ("nothing", |_| {}, 1.0),
        ("more handle", |scene| stroke(scene, Role::Handle(0), 0.8), 0.2),
        ("less handle", |scene| stroke(scene, Role::Free, 0.8), 0.2),
        ("a hole", |scene| stroke(scene, Role::Fixed, 0.0), 0.2),
        ("all softer", |scene| scene.stiffness.fill(0.37), 0.0),
    ];
    let (progress, cancel) = (Progress::new(), Cancel::new());
    let ordering = Ordering::of(&scene().model.topology, 2, &progress, &cancel).unwrap();
    let first = scene();
    let bound = first
        .problem(&first.method)
        .rebind(&ordering, None, &progress, &cancel)
        .unwrap();
    let reusable_factor = bound.reusable_factor();
    for (name, change, least) in strokes {
        let mut scene = scene();
        change(&mut scene);
        let problem = scene.problem(&scene.method);
        let mut fresh = problem.bind(&ordering, &progress, &cancel).unwrap();
        let mut again = problem
            .rebind(&ordering, reusable_factor.as_ref(), &progress, &cancel)
            .unwrap();
        assert!(bits(&mut fresh) == bits(&mut again), "{name}");
        let kept = again
            .reusable_factor()
            .unwrap()
            .share_of(reusable_factor.as_ref().unwrap());
        assert!(kept >= least && (kept < 1.0 || least == 1.0), "{name}: {kept}");
        // This binds again from the factor of a partial reuse.
        let mut third = problem
            .rebind(&ordering, again.reusable_factor().as_ref(), &progress, &cancel)
            .unwrap();
        assert!(bits(&mut fresh) == bits(&mut third), "{name}");
    }
}

/// Gives `role` to a small patch around the height `z`.
fn stroke(scene: &mut Scene, role: Role, z: f64) {
    let centre = DVec3::new((1.0 - z * z).sqrt(), 0.0, z);
    for (own, position) in scene.roles.iter_mut().zip(&scene.model.surface.positions) {
        if position.distance(centre) < 0.12 {
            *own = role;
        }
    }
}

#[test]
fn remains_of_another_mesh_are_of_no_use_and_no_harm() {
    let (progress, cancel) = (Progress::new(), Cancel::new());
    let other = Scene::new(shapes::torus(40, 30)).with_ends(true);
    let reusable_factor = other.bind().reusable_factor();
    let scene = scene();
    let problem = scene.problem(&scene.method);
    let ordering = Ordering::of(&scene.model.topology, 2, &progress, &cancel).unwrap();
    let mut fresh = problem.bind(&ordering, &progress, &cancel).unwrap();
    let mut again = problem
        .rebind(&ordering, reusable_factor.as_ref(), &progress, &cancel)
        .unwrap();
    assert!(bits(&mut fresh) == bits(&mut again));
    assert_eq!(
        again
            .reusable_factor()
            .unwrap()
            .share_of(reusable_factor.as_ref().unwrap()),
        0.0
    );
}
