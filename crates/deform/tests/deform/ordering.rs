//! Laws of the elimination order.

use pliant_deform::{METHODS, Method, Ordering, Role};
use pliant_mesh::{Cancel, Progress, shapes};

use crate::rig::{Scene, apart, far, settle};

#[test]
fn a_restricted_order_is_the_solved_vertices_each_once() {
    for (name, drawn) in shapes::classes() {
        let scene = Scene::new(drawn);
        let topology = &scene.model.topology;
        for power in 1..=3 {
            let progress = Progress::new();
            let ordering = Ordering::of(topology, power, &progress, &Cancel::new()).unwrap();
            assert_eq!(
                (ordering.power(), ordering.vertex_count(), progress.get()),
                (power, scene.roles.len(), 1.0)
            );
            for stride in [1, 2, 5] {
                let solved: Vec<u32> = (0..scene.roles.len() as u32).step_by(stride).collect();
                let mut order = ordering.restricted(&solved);
                order.sort_unstable();
                assert_eq!(order, solved, "{name} {power} {stride}");
            }
        }
    }
}

#[test]
fn it_does_not_depend_on_the_number_of_threads() {
    // This is large enough for parts that are cut in parallel.
    let scene = Scene::new(shapes::icosphere(5));
    for power in 1..=3 {
        let order = |threads: usize| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| Ordering::of(&scene.model.topology, power, &Progress::new(), &Cancel::new()).unwrap())
        };
        let one = order(1);
        assert!([2, 5].into_iter().all(|threads| order(threads) == one), "{power}");
    }
}

#[test]
fn it_keeps_the_factor_sparse() {
    let scene = Scene::new(shapes::icosphere(5)).with_ends(true);
    let bound = scene.bind();
    // A band of two rings across the sphere would have a fill of about 500 numbers per row.
    let per_row = bound.factor_len() / bound.solved_count();
    assert!(per_row < 200, "{per_row}");
}

#[test]
fn an_ordering_of_the_surroundings_bends_as_one_of_the_whole_surface_does() {
    for (name, drawn) in shapes::classes() {
        for method in METHODS.iter().map(|declaration| (declaration.default)()) {
            let Some(power) = method.ordering_power() else { continue };
            let mut scene = Scene::new(drawn.clone()).with_ends(true);
            scene.method = method;
            let topology = &scene.model.topology;
            let (progress, cancel) = (Progress::new(), Cancel::new());
            let solved: Vec<bool> = scene.roles.iter().map(|role| *role == Role::Free).collect();
            let near = Ordering::around(topology, &solved, power, &progress, &cancel).unwrap();
            // Vertices that were not ordered only come last.
            let none = Ordering::around(topology, &vec![false; solved.len()], power, &progress, &cancel).unwrap();
            let problem = scene.problem(&scene.method);
            let (whole, _) = settle(&mut scene.bind(), &far(&scene));
            for ordering in [near, none] {
                assert_eq!((ordering.power(), ordering.vertex_count()), (power, solved.len()));
                let mut bound = problem.bind(&ordering, &progress, &cancel).unwrap();
                let (shape, _) = settle(&mut bound, &far(&scene));
                let error = apart(&shape, &whole) / scene.diagonal();
                assert!(error < 1e-5, "{name} {:?}: {error:e}", scene.method);
            }
        }
    }
}

#[test]
fn an_ordering_of_a_small_region_takes_a_small_part_of_the_surface_s_fill() {
    let scene = Scene::new(shapes::icosphere(6)).with(Role::Handle(0), |p| p.z > 0.97);
    let mut scene = scene.with(Role::Fixed, |p| p.z < 0.8);
    scene.method = Method::default();
    let (progress, cancel) = (Progress::new(), Cancel::new());
    let solved: Vec<bool> = scene.roles.iter().map(|role| *role == Role::Free).collect();
    let near = Ordering::around(&scene.model.topology, &solved, 2, &progress, &cancel).unwrap();
    let problem = scene.problem(&scene.method);
    let near = problem.bind(&near, &progress, &cancel).unwrap().factor_len();
    let whole = scene.bind().factor_len();
    assert!(near * 20 <= whole * 21, "{near} {whole}");
}
