//! Extracts a solid's surface as a mesh: surface nets [Gib98] in the blocks that the surface crosses, with one vertex
//! for each sheet through a cell [Nie04], so that two close sheets don't share a vertex.
//!
//! Marching cubes would make sliver triangles that must be removed; these triangles are about equal from the start. The
//! remaining ambiguity (both sheets of two cells meeting in their common face) is detected by [`Mesh::check_closed`]
//! and resolved by shifting the grid.

use std::collections::HashMap;

use super::mesh::{Mesh, in_parallel};
use super::solid::Solid;
use super::vector::{Vec3, v};

/// Cells per block side. Blocks that the surface can't cross are skipped after one evaluation.
const BLOCK: i32 = 8;
/// The largest slope of a solid's distance for which no block is skipped wrongly.
const SLOPE: f64 = 1.6;

/// A cell's twelve edges as pairs of corners (bits 0, 1, 2 are x, y, z), four along each axis.
const EDGES: [(u8, u8); 12] = [
    (0, 1),
    (2, 3),
    (4, 5),
    (6, 7),
    (0, 2),
    (1, 3),
    (4, 6),
    (5, 7),
    (0, 4),
    (1, 5),
    (2, 6),
    (3, 7),
];

/// One sheet of the surface through one cell: one vertex.
struct Crossing {
    cell: [i32; 3],
    /// Bit `i` is set if corner `i` is inside.
    inside: u8,
    /// Bit `e` is set if this sheet crosses edge `e`.
    edges: u16,
    position: Vec3,
}

/// The surface of `solid` on a grid with cells of width `size`, offset by `shift` cells.
pub fn extract(solid: &dyn Solid, size: f64, shift: f64) -> Mesh {
    let (low, high) = solid.bounds();
    let margin = size * 2.0;
    let origin = low - v(margin, margin, margin) + v(shift, shift * 0.7, shift * 0.4) * size;
    let extent = high - origin;
    let blocks = extent
        .array()
        .map(|e| ((e + margin) / (size * f64::from(BLOCK))).ceil() as i32);
    let count = blocks[0] as usize * blocks[1] as usize * blocks[2] as usize;
    let parts = in_parallel(count, |i| {
        let (i, columns) = (i as i64, i64::from(blocks[0]));
        let rows = i64::from(blocks[1]);
        let block = [i % columns, i / columns % rows, i / columns / rows].map(|b| b as i32 * BLOCK);
        crossings(solid, origin, size, block)
    });
    let crossings: Vec<Crossing> = parts.into_iter().flatten().collect();
    connect(&crossings)
}

/// The crossed cells of one block, in order.
fn crossings(solid: &dyn Solid, origin: Vec3, size: f64, block: [i32; 3]) -> Vec<Crossing> {
    let point = |x: f64, y: f64, z: f64| origin + v(x, y, z) * size;
    let half = f64::from(BLOCK) * 0.5;
    let [bx, by, bz] = block.map(f64::from);
    if solid.distance(point(bx + half, by + half, bz + half)).abs() > half * size * 1.7321 * SLOPE {
        return Vec::new();
    }
    let side = BLOCK + 1;
    let mut distances = Vec::with_capacity((side * side * side) as usize);
    for z in 0..side {
        for y in 0..side {
            for x in 0..side {
                distances.push(solid.distance(point(bx + f64::from(x), by + f64::from(y), bz + f64::from(z))));
            }
        }
    }
    let mut out = Vec::new();
    for z in 0..BLOCK {
        for y in 0..BLOCK {
            for x in 0..BLOCK {
                let corner = |i: i32| {
                    let (cx, cy, cz) = (x + (i & 1), y + (i >> 1 & 1), z + (i >> 2));
                    distances[((cz * side + cy) * side + cx) as usize]
                };
                let inside = (0..8).fold(0_u8, |mask, i| mask | (u8::from(corner(i) < 0.0) << i));
                if inside == 0 || inside == 255 {
                    continue;
                }
                let cell = [block[0] + x, block[1] + y, block[2] + z];
                let [cx, cy, cz] = cell.map(f64::from);
                for edges in sheets(inside) {
                    let place = mean_crossing(edges, corner);
                    let position = point(cx + place.x, cy + place.y, cz + place.z);
                    out.push(Crossing {
                        cell,
                        inside,
                        edges,
                        position,
                    });
                }
            }
        }
    }
    out
}

/// The crossed edges of each sheet. On a face with four crossed edges, the two edges at an inside corner belong
/// together; both cells of the face decide this alike.
fn sheets(inside: u8) -> Vec<u16> {
    let is_inside = |corner: u8| inside >> corner & 1 == 1;
    let mut sheets: Vec<u16> = (0..12)
        .filter(|&e| is_inside(EDGES[e].0) != is_inside(EDGES[e].1))
        .map(|e| 1 << e)
        .collect();
    let mut join = |pair: u16| {
        let (with, mut without): (Vec<u16>, Vec<u16>) = sheets.iter().partition(|&&sheet| sheet & pair != 0);
        without.push(with.iter().fold(0, |all, sheet| all | sheet));
        sheets = without;
    };
    for axis in 0..3_u8 {
        for side in 0..2_u8 {
            let on_face = |corner: u8| corner >> axis & 1 == side;
            let crossed: Vec<usize> = (0..12)
                .filter(|&e| on_face(EDGES[e].0) && on_face(EDGES[e].1))
                .filter(|&e| is_inside(EDGES[e].0) != is_inside(EDGES[e].1))
                .collect();
            match *crossed {
                [e, f] => join(1 << e | 1 << f),
                [..] => {
                    for corner in (0..8).filter(|&c| !crossed.is_empty() && on_face(c) && is_inside(c)) {
                        let at = |e: &&usize| EDGES[**e].0 == corner || EDGES[**e].1 == corner;
                        join(crossed.iter().filter(at).fold(0, |pair, e| pair | 1 << e));
                    }
                }
            }
        }
    }
    sheets.sort_unstable();
    sheets
}

/// The mean of the points where the sheet's edges cross the surface, in the cell's own [0, 1]³.
fn mean_crossing(edges: u16, corner: impl Fn(i32) -> f64) -> Vec3 {
    let at = |c: u8| v(f64::from(c & 1), f64::from(c >> 1 & 1), f64::from(c >> 2));
    let (mut sum, mut count) = (Vec3::default(), 0.0);
    for (_, &(i, k)) in EDGES.iter().enumerate().filter(|(e, _)| edges >> e & 1 == 1) {
        let (a, b) = (corner(i32::from(i)), corner(i32::from(k)));
        sum += at(i).lerp(at(k), a / (a - b));
        count += 1.0;
    }
    sum * (1.0 / count)
}

/// One quad, as two triangles along its shorter diagonal, for every grid edge that the surface crosses.
fn connect(crossings: &[Crossing]) -> Mesh {
    let mut first: HashMap<[i32; 3], u32> = HashMap::with_capacity(crossings.len());
    for (i, crossing) in crossings.iter().enumerate() {
        first.entry(crossing.cell).or_insert(i as u32);
    }
    let sheet = |cell: [i32; 3], edge: usize| {
        let start = *first.get(&cell)?;
        (start..)
            .take_while(|&i| crossings.get(i as usize).is_some_and(|c| c.cell == cell))
            .find(|&i| crossings[i as usize].edges >> edge & 1 == 1)
    };
    let positions: Vec<Vec3> = crossings.iter().map(|c| c.position).collect();
    let mut triangles = Vec::with_capacity(crossings.len() * 2);
    for crossing in crossings {
        for axis in 0..3 {
            // The cell's edge from corner 0 along the axis; three other cells share it as another of their edges.
            if crossing.edges >> (4 * axis) & 1 == 0 {
                continue;
            }
            let (u, w) = ((axis + 1) % 3, (axis + 2) % 3);
            let seen_from = |back_u: usize, back_w: usize| {
                let mut cell = crossing.cell;
                cell[u] -= back_u as i32;
                cell[w] -= back_w as i32;
                let corner = (back_u << u | back_w << w) as u8;
                let edge = EDGES.iter().position(|&e| e == (corner, corner | 1 << axis))?;
                sheet(cell, edge)
            };
            let [Some(a), Some(b), Some(c), Some(d)] =
                [seen_from(0, 0), seen_from(1, 0), seen_from(1, 1), seen_from(0, 1)]
            else {
                continue;
            };
            let [a, b, c, d] = if crossing.inside & 1 == 1 {
                [a, b, c, d]
            } else {
                [d, c, b, a]
            };
            let length = |i: u32, k: u32| (positions[i as usize] - positions[k as usize]).length();
            if length(a, c) <= length(b, d) {
                triangles.extend([[a, b, c], [a, c, d]]);
            } else {
                triangles.extend([[a, b, d], [b, c, d]]);
            }
        }
    }
    Mesh {
        positions,
        triangles,
        ..Mesh::default()
    }
}
