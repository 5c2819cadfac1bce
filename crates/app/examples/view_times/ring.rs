//! The measured mesh, of any size, with relief at every scale.

use std::f64::consts::TAU;

use glam::DVec3;
use pliant_mesh::{Drawn, DrawnVertex};

/// A ring with knobs, of about this many triangles.
pub fn knobbly_ring(triangles: usize) -> Drawn {
    let across = ((triangles as f64 / 5.0).sqrt() as u32).max(3);
    let around = (triangles as u32 / (2 * across)).max(3);
    let mut positions = Vec::new();
    for i in 0..around {
        let turn = TAU * f64::from(i) / f64::from(around);
        let outward = DVec3::new(turn.cos(), turn.sin(), 0.0);
        for k in 0..across {
            let lap = TAU * f64::from(k) / f64::from(across);
            let normal = outward * lap.cos() + DVec3::Z * lap.sin();
            let knobs =
                0.03 * (9.0 * turn).sin() * (5.0 * lap).cos() + 0.004 * (70.0 * turn).cos() * (40.0 * lap).cos();
            positions.push(outward * 0.85 + normal * (0.35 + knobs));
        }
    }
    let v = |i: u32, k: u32| DrawnVertex((i % around) * across + k % across);
    let quads = (0..around).flat_map(|i| (0..across).map(move |k| (i, k)));
    let triangles = quads.flat_map(|(i, k)| {
        [
            [v(i, k), v(i + 1, k), v(i + 1, k + 1)],
            [v(i, k), v(i + 1, k + 1), v(i, k + 1)],
        ]
    });
    Drawn::once(positions, triangles.collect())
}
