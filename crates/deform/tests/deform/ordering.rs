//! Laws of the elimination order.

use pliant_deform::Ordering;
use pliant_mesh::{Cancel, Progress, shapes};

use crate::rig::Scene;

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
