//! How each triangle continues across its edges.

use std::hint::black_box;
use std::ops::Range;

use glam::DVec2;
use rayon::prelude::*;

use crate::chart::Chart;
use crate::hinges::{Hinges, WALL};
use crate::sums::CHUNK;

/// The triangles beside each triangle, unfolded into its plane.
#[derive(Debug)]
pub(crate) struct Crossings {
    cells: Vec<Cell>,
}

/// What a way reads of a triangle that it leaves: one line of the processor's memory.
#[derive(Clone, Copy, Debug)]
#[repr(align(64))]
struct Cell {
    /// The edge beside each edge, or [`WALL`].
    beside: [u32; 3],
    /// The barycentric coordinates of each corner in the triangle beside the edge opposite to it, unfolded into the same
    /// plane: those of the next and of the last corner here. The third completes their sum to 1.
    unfolded: [DVec2; 3],
}

impl Crossings {
    pub fn of(hinges: &Hinges, charts: &[Chart]) -> Self {
        let cell = |triangle: u32| {
            let edges = [0, 1, 2].map(|k| 3 * triangle + k);
            let beside = edges.map(|edge| hinges.beside(edge));
            let unfolded = edges.map(|edge| match hinges.beside(edge) {
                WALL => DVec2::ZERO,
                other => unfolded(edge, other, charts),
            });
            Cell { beside, unfolded }
        };
        let triangles = (0..charts.len() as u32).into_par_iter().with_min_len(CHUNK);
        Self {
            cells: triangles.map(cell).collect(),
        }
    }

    /// Brings what is known of some triangles near to the processor, in the order in which it is stored.
    pub fn read_ahead(&self, triangles: Range<usize>) {
        black_box(self.cells[triangles].iter().map(|cell| cell.beside[0]).max());
    }

    /// The edge of the triangle beside the edge opposite `corner`, or [`WALL`].
    #[inline(always)]
    pub fn beside(&self, corner: u32) -> u32 {
        self.cells[corner as usize / 3].beside[corner as usize % 3]
    }

    /// The edge beside edge `k` of a triangle, or [`WALL`], and the barycentric coordinates of corner `k` in the triangle
    /// there: those of the next and the last corner of the triangle here, and that of the corner across the edge.
    #[inline(always)]
    pub fn across(&self, triangle: u32, k: usize) -> (u32, [f64; 3]) {
        let cell = &self.cells[triangle as usize];
        let DVec2 { x: next, y: last } = cell.unfolded[k];
        (cell.beside[k], [next, last, 1.0 - next - last])
    }
}

/// The coordinates of the corner opposite `edge` in the triangle of `other`, the same edge beside.
fn unfolded(edge: u32, other: u32, charts: &[Chart]) -> DVec2 {
    // The corner's foot on the edge, as a share of its length from the next corner, and its height in the same unit.
    let foot = |edge: u32| {
        let (chart, k) = (&charts[edge as usize / 3], edge as usize % 3);
        let (along, to_corner) = (chart.edge(k), -chart.edge((k + 2) % 3));
        DVec2::new(along.dot(to_corner), along.perp_dot(to_corner)) / along.length_squared()
    };
    let (here, there) = (foot(edge), foot(other));
    let across = -here.y / there.y;
    // There the edge runs the other way.
    let last = here.x - across * (1.0 - there.x);
    DVec2::new(1.0 - across - last, last)
}

#[cfg(test)]
mod tests {
    use pliant_mesh::shapes;

    use super::*;

    #[test]
    fn a_corner_is_where_its_coordinates_beside_say() {
        let model = shapes::model(shapes::icosphere(2));
        let charts: Vec<Chart> = (0..model.surface.triangles.len())
            .map(|t| Chart::of(model.surface.corners(t)))
            .collect();
        let hinges = Hinges::of(&model.surface, &model.topology);
        let crossings = Crossings::of(&hinges, &charts);
        for edge in 0..3 * charts.len() as u32 {
            let (other, [to_next, to_last, across]) = crossings.across(edge / 3, edge as usize % 3);
            assert_eq!(other, hinges.beside(edge));
            // Distances from the edge's ends in the plane of the triangle beside, where its next corner is the last here.
            let (chart, m) = (&charts[other as usize / 3], other as usize % 3);
            let next_here = DVec2::ZERO;
            let last_here = -chart.edge(m);
            let across_edge = chart.edge((m + 1) % 3);
            let corner = next_here * to_next + last_here * to_last + across_edge * across;
            let (own, k) = (&charts[edge as usize / 3], edge as usize % 3);
            assert!((corner.distance(next_here) - own.edge((k + 2) % 3).length()).abs() < 1e-12);
            assert!((corner.distance(last_here) - own.edge((k + 1) % 3).length()).abs() < 1e-12);
            assert!(across < 0.0);
        }
    }
}
