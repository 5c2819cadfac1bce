//! The bar: an upright square rod with regular quads, for twisting.

use std::collections::HashMap;

use super::cylinder::banded;
use super::mesh::Mesh;
use super::vector::v;

/// Quads along x, y and z.
const QUADS: [u32; 3] = [16, 80, 16];
/// Edge length of a quad.
const SIZE: f64 = 0.0125;

/// The bar from y = 0 upwards.
pub fn bar() -> Mesh {
    let mut mesh = Mesh::default();
    let mut index: HashMap<[u32; 3], u32> = HashMap::new();
    for axis in 0..3 {
        let (u, w) = ((axis + 1) % 3, (axis + 2) % 3);
        for side in [0, QUADS[axis]] {
            for i in 0..QUADS[u] {
                for k in 0..QUADS[w] {
                    let mut vertex = |du: u32, dw: u32| {
                        let mut at = [0; 3];
                        (at[axis], at[u], at[w]) = (side, i + du, k + dw);
                        *index.entry(at).or_insert_with(|| {
                            let centred = |axis: usize| f64::from(at[axis]) - f64::from(QUADS[axis]) * 0.5;
                            mesh.positions.push(v(centred(0), f64::from(at[1]), centred(2)) * SIZE);
                            mesh.colours
                                .push(banded(f64::from(at[1]) / f64::from(QUADS[1]), 0xb56f5d, 0xf2dfb8));
                            mesh.positions.len() as u32 - 1
                        })
                    };
                    let [a, b, c, d] = [vertex(0, 0), vertex(1, 0), vertex(1, 1), vertex(0, 1)];
                    let quad = if side > 0 {
                        [[a, b, c], [a, c, d]]
                    } else {
                        [[a, c, b], [a, d, c]]
                    };
                    mesh.triangles.extend(quad);
                }
            }
        }
    }
    mesh
}
