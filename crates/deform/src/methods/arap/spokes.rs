//! The energy over spokes [SA07]: a vertex's cell is the edges to its neighbours.
//!
//! E = ½ Σ_i ½ Σ_j w_ij |e'_ij − R_i e_ij|² with w_ij = ½ Σ cot, bounded below: between obtuse angles it is negative,
//! and then the rest shape need not be a minimum, and there may be none. The bound is a little above zero, so that the
//! system stays solvable if all of a vertex's weights are negative. With the ½ the majorising quadratic's matrix is the
//! Laplacian of these weights.

use pliant_mesh::Surface;

use super::cells::{Cells, Entry, Solved, add_square};
use crate::Laplacian;
use crate::coarse::domain::Domain;

/// The least weight of an edge, in units of the mean of its two ends' largest.
const FLOOR: f64 = 1e-6;

/// The floored weight of the edge from `local` to its `place`-th neighbour.
pub(crate) fn floored(laplacian: &Laplacian, largest: &[f64], local: usize, place: usize) -> f64 {
    let neighbour = laplacian.neighbours(local)[place] as usize;
    let floor = FLOOR * 0.5 * (largest[local] + largest[neighbour]);
    laplacian.weights(local)[place].max(floor).max(f64::MIN_POSITIVE)
}

/// The largest weight of each local vertex of the operator.
pub(crate) fn largest_weights(laplacian: &Laplacian) -> Vec<f64> {
    (0..laplacian.vertices().len())
        .map(|local| laplacian.weights(local).iter().fold(0.0, |a: f64, &b| a.max(b)))
        .collect()
}

/// The stencils of `domain`'s cells; `laplacian` has full rows for them and for their neighbours.
pub(crate) fn cells(surface: &Surface, laplacian: &Laplacian, domain: &Domain) -> Cells {
    let largest = largest_weights(laplacian);
    let mut cells = Cells::default();
    let mut entries = Vec::new();
    for (cell, &vertex) in domain.vertices[..domain.cell_count].iter().enumerate() {
        let own = surface.positions[vertex as usize];
        entries.clear();
        let mut rest = [0.0; 6];
        if let Some(local) = laplacian.local(vertex) {
            for (place, &neighbour) in laplacian.neighbours(local).iter().enumerate() {
                let other = laplacian.vertices()[neighbour as usize];
                let weight = floored(laplacian, &largest, local, place);
                let edge = surface.positions[other as usize] - own;
                entries.push(Entry {
                    end: domain.local_of[other as usize],
                    towards: edge * (0.5 * weight),
                    back: edge * (-0.5 * weight),
                    weight,
                });
                add_square(&mut rest, 0.5 * weight, edge);
                cells.scale += 0.5 * weight * edge.length_squared();
            }
        }
        let solved = if cell < domain.solved_count {
            Solved::Yes
        } else {
            Solved::No
        };
        cells.push(&entries, rest, solved, 1.0);
    }
    cells
}
