//! The number of threads changes no bit.

#![allow(clippy::unwrap_used, reason = "a test that fails may panic")]

use glam::{DVec3, Vec3Swizzles};
use pliant_mesh::{Distortion, mixed_voronoi_areas, shapes, vertex_normals};

#[test]
fn results_are_the_same_bits_on_one_thread_and_on_five() {
    let shape = shapes::soup(&shapes::uv_sphere(160, 160));
    let run = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| {
            let model = shapes::model(shape.clone());
            let surface = &model.surface;
            let bent: Vec<DVec3> = surface.positions.iter().map(|p| *p + 0.1 * p.yzx() * p.x).collect();
            let mut normals = Vec::new();
            vertex_normals(&surface.triangles, &model.topology, &bent, &mut normals);
            let distortion = Distortion::of(surface, &model.topology, &bent);
            (
                surface.positions.clone(),
                surface.triangles.clone(),
                normals,
                distortion,
                mixed_voronoi_areas(surface),
            )
        })
    };
    let alone = run(1);
    let together = run(5);
    assert!(alone == together);
}
