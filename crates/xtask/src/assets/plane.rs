//! The bumpy plane: a square sheet with rows of round bumps, open at its border.

use super::mesh::Mesh;
use super::solid::{mix, srgb};
use super::vector::v;

/// Quads along each side.
const QUADS: u32 = 96;
/// Bumps along each side.
const BUMPS: f64 = 8.0;
/// Height of a bump; the sheet's sides are 1.
const HEIGHT: f64 = 0.035;

/// The sheet in the xz plane, with bumps towards +y.
pub fn plane() -> Mesh {
    let mut mesh = Mesh::default();
    for row in 0..=QUADS {
        for column in 0..=QUADS {
            let [x, z] = [column, row].map(|i| f64::from(i) / f64::from(QUADS));
            let from_middle = |s: f64| 2.0 * (s * BUMPS - (s * BUMPS).floor()) - 1.0;
            let inside = (1.0 - (from_middle(x).powi(2) + from_middle(z).powi(2)) / 0.64).max(0.0);
            let bump = inside * inside * (3.0 - 2.0 * inside);
            mesh.positions.push(v(x - 0.5, bump * HEIGHT, z - 0.5));
            mesh.colours.push(mix(srgb(0x8fa9c4), srgb(0xf0c47a), bump));
        }
    }
    for row in 0..QUADS {
        for column in 0..QUADS {
            let a = row * (QUADS + 1) + column;
            let (b, c, d) = (a + 1, a + QUADS + 1, a + QUADS + 2);
            mesh.triangles.extend([[a, c, d], [a, d, b]]);
        }
    }
    mesh
}
