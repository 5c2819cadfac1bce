//! The laws of infinite stiffness: a part moves as one body, by every method, and the rest moves as without it.

use crate::rig::{Scene, apart, turned};
use glam::{DAffine3, DVec3};
use pliant_deform::{BindError, METHODS, Method, RigidMotion, Role};
use pliant_mesh::{Drawn, SurfaceVertex, shapes};

const RIGID: f64 = f64::INFINITY;

/// A long shape with one end fixed and the other as the handle, rigid where its share of the length `is_rigid`.
fn scene(drawn: Drawn, method: &str, is_rigid: impl Fn(f64) -> bool) -> Scene {
    let mut scene = Scene::new(drawn);
    scene.method = Method::from_name(method).unwrap();
    let bounds = scene.model.bounds().unwrap();
    let share = move |p: DVec3| (p.x - bounds.min.x) / bounds.extent().x;
    for (stiffness, p) in scene.stiffness.iter_mut().zip(&scene.model.surface.positions) {
        if is_rigid(share(*p)) {
            *stiffness = RIGID;
        }
    }
    scene
        .with(Role::Fixed, move |p| share(p) < 0.12)
        .with(Role::Handle(0), move |p| share(p) > 0.88)
}

fn middle(share: f64) -> bool {
    (0.4..0.6).contains(&share)
}

/// All methods that bend.
fn names() -> impl Iterator<Item = &'static str> {
    let all = METHODS.iter().map(|declaration| declaration.name);
    all.filter(|name| *name != "identity")
}

/// Steps until finished; every method finishes.
fn settled(scene: &Scene, target: DAffine3) -> Vec<DVec3> {
    let mut bound = scene.bind();
    bound.set_targets(&[target]).unwrap();
    let mut displacements = vec![DVec3::NAN; bound.vertex_count()];
    let mut steps = 1;
    while !bound.step(&mut displacements).unwrap().finished {
        steps += 1;
        // This is the most that a method takes by default.
        assert!(steps <= 1000, "{:?}", scene.method.declaration().name);
    }
    displacements
}

/// The distance of the rigid vertices from the rigid motion that fits them, in diagonals.
fn bent(scene: &Scene, displacements: &[DVec3]) -> f64 {
    let own: Vec<usize> = (0..displacements.len())
        .filter(|&v| scene.stiffness[v] == RIGID)
        .collect();
    let rest: Vec<DVec3> = own.iter().map(|&v| scene.positions()[v]).collect();
    let moved: Vec<DVec3> = own.iter().map(|&v| displacements[v]).collect();
    let fit = RigidMotion::fit(&rest, &moved).unwrap();
    let expected: Vec<DVec3> = rest.iter().map(|&p| fit.displace(p)).collect();
    apart(&moved, &expected) / scene.diagonal()
}

fn target() -> DAffine3 {
    turned(DVec3::new(2.0, 0.5, 0.5), 0.7, DVec3::new(-0.3, 0.8, 0.4))
}

#[test]
fn a_rigid_part_moves_as_one_body_by_every_method() {
    for name in names() {
        let bar = scene(shapes::bar(24, 4, 4), name, middle);
        let displacements = settled(&bar, target());
        let off = bent(&bar, &displacements);
        assert!(off < 1e-12, "{name}: {off:e}");
        let furthest = |role: Role| {
            let own = displacements.iter().zip(&bar.roles).filter(|(_, own)| **own == role);
            own.map(|(d, _)| d.length()).fold(0.0, f64::max)
        };
        assert!(furthest(Role::Free) > 0.01 * bar.diagonal(), "{name}");
        assert_eq!(furthest(Role::Fixed), 0.0, "{name}");
        // Without the paint the same part bends, except inside one rigid cell of space.
        if name != "space-primo" {
            let mut plain = scene(shapes::bar(24, 4, 4), name, middle);
            plain.stiffness.fill(1.0);
            let bends = bent(&bar, &settled(&plain, target()));
            assert!(bends > 1e-4, "{name}: {bends:e}");
        }
    }
}

#[test]
fn what_is_around_joins_a_rigid_part_without_a_tear() {
    for name in names() {
        let bar = scene(shapes::bar(24, 4, 4), name, middle);
        let displacements = settled(&bar, target());
        let worst = |displacements: &[DVec3]| {
            let edge = |&[a, b, _]: &[SurfaceVertex; 3]| {
                let [rest, moved] = [DVec3::ZERO, displacements[b.index()] - displacements[a.index()]]
                    .map(|by| (bar.positions()[b.index()] + by - bar.positions()[a.index()]).length());
                moved / rest
            };
            bar.model.surface.triangles.iter().map(edge).fold(0.0, f64::max)
        };
        let mut plain = scene(shapes::bar(24, 4, 4), name, middle);
        plain.stiffness.fill(1.0);
        let (with, without) = (worst(&displacements), worst(&settled(&plain, target())));
        assert!(with < 2.5 * without, "{name}: {with} {without}");
    }
}

#[test]
fn at_rest_nothing_moves_and_a_rigid_motion_of_all_handles_is_followed() {
    for name in names() {
        let mut bar = scene(shapes::bar(24, 4, 4), name, middle);
        let displacements = settled(&bar, DAffine3::IDENTITY);
        assert!(displacements.iter().all(|d| *d == DVec3::ZERO), "{name}");
        // With nothing held, everything follows a move of the handle.
        for role in &mut bar.roles {
            if *role == Role::Fixed {
                *role = Role::Free;
            }
        }
        let shift = DVec3::new(0.4, -0.2, 0.1);
        let moved = settled(&bar, DAffine3::from_translation(shift));
        let off = apart(&moved, &vec![shift; moved.len()]) / bar.diagonal();
        assert!(off < 1e-5, "{name}: {off:e}");
    }
}

#[test]
fn a_part_goes_with_the_handle_or_the_end_that_it_hangs_together_with() {
    for name in ["bilaplacian", "arap", "rbf"] {
        let to_handle = scene(shapes::bar(24, 4, 4), name, |share| share > 0.7);
        let displacements = settled(&to_handle, target());
        for ((d, p), stiffness) in displacements
            .iter()
            .zip(to_handle.positions())
            .zip(&to_handle.stiffness)
        {
            if *stiffness == RIGID {
                assert!(d.distance(target().transform_point3(*p) - *p) < 1e-9, "{name}");
            }
        }
        let to_end = scene(shapes::bar(24, 4, 4), name, |share| share < 0.3);
        let displacements = settled(&to_end, target());
        let stays = displacements.iter().zip(&to_end.stiffness);
        assert!(
            stays.filter(|(_, s)| **s == RIGID).all(|(d, _)| *d == DVec3::ZERO),
            "{name}"
        );
        let warnings: Vec<String> = to_end.bind().warnings().iter().map(|w| w.to_string()).collect();
        assert!(
            warnings.iter().any(|warning| warning.contains("painted rigid")),
            "{warnings:?}"
        );
    }
}

#[test]
fn several_parts_are_several_bodies() {
    let bar = scene(shapes::bar(40, 4, 4), "arap", |share| {
        middle(share) || (0.7..0.8).contains(&share)
    });
    let displacements = settled(&bar, target());
    assert!(bent(&bar, &displacements) > 1e-3);
    let mut first = scene(shapes::bar(40, 4, 4), "arap", middle);
    first.roles.clone_from(&bar.roles);
    assert!(bent(&first, &displacements) < 1e-12);
}

#[test]
fn more_parts_than_can_be_bodies_are_refused_in_words() {
    let mut scattered = Scene::new(shapes::icosphere(5)).with_ends(true);
    for vertex in (0..scattered.stiffness.len()).map(|vertex| SurfaceVertex(vertex as u32)) {
        let mut around = scattered.model.topology.neighbours(vertex).iter();
        if around.all(|other| scattered.stiffness[other.index()] != RIGID) {
            scattered.stiffness[vertex.index()] = RIGID;
        }
    }
    let refused = scattered.try_bind().map(|_| ()).unwrap_err();
    assert!(matches!(refused, BindError::RigidParts { .. }) && refused.to_string().contains("paint fewer"));
}

#[test]
fn the_result_is_the_same_on_any_number_of_threads() {
    let bar = scene(shapes::bar(24, 4, 4), "arap", middle);
    let on = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| settled(&bar, target()))
    };
    let one = on(1);
    assert!([2, 3].into_iter().all(|threads| on(threads) == one));
}
