//! Refuses surfaces that are too long for a method before any computation.
//!
//! The least eigenvalue of the n-th power of the Laplacian falls with the 2n-th power of the number of edges between a
//! vertex and the nearest constrained one. On strips of a million triangles no digit is left, and refinement would need
//! a minute to find that.

use pliant_mesh::SurfaceVertex;

use crate::BindError;
use crate::numerical::graph::Graph;
use crate::operators::triangulation::Triangulation;

/// The largest allowed distance of a vertex from all constrained ones at this order of the bi-Laplacian, in edges.
///
/// If the number of edges, to the 2n-th power, exceeds 10²⁰ (10²⁴ at order 3), no digit is left. Strips at order 2 were
/// solved to three digits at 1.5·10¹⁸ and to none at 2.4·10¹⁹; at order 3 to seven digits at 4·10¹⁸, to three at
/// 2·10²⁰, and to none at 6·10²².
pub(crate) fn most_edges(order: u32) -> f64 {
    let hopeless: f64 = if order < 3 { 1e20 } else { 1e24 };
    hopeless.powf(0.5 / f64::from(order))
}

/// The same for coupled prisms, which bend like order 2 but are not refined: strips two quads wide converged in 23 to
/// 27 steps at 3·10¹⁵ and 2.4·10¹⁶ (7,500 and 12,500 edges) and not in a minute at 9.4·10¹⁶.
pub(crate) const MOST_EDGES_OF_PRISMS: f64 = 15_000.0;

/// Refuses a surface with a vertex that is `most` edges or more from every vertex outside `solved` (ascending). `order`
/// is for the message.
///
/// # Errors
/// [`BindError::Slender`] with the farthest vertex.
pub(crate) fn check(
    triangulation: &Triangulation,
    solved: &[u32],
    most: f64,
    order: Option<u32>,
) -> Result<(), BindError> {
    if (solved.len() as f64) < most {
        return Ok(());
    }
    let mut is_solved = vec![false; triangulation.vertex_count()];
    solved.iter().for_each(|&vertex| is_solved[vertex as usize] = true);
    // Breadth-first from the constrained vertices.
    let mut ring: Vec<u32> = (0..is_solved.len())
        .filter(|&v| !is_solved[v])
        .map(|v| v as u32)
        .collect();
    let (mut edges, mut farthest) = (0, 0);
    while let Some(&first) = ring.first() {
        farthest = first;
        let mut next = Vec::new();
        for vertex in ring {
            for beside in triangulation.neighbours(SurfaceVertex(vertex)) {
                if std::mem::replace(&mut is_solved[beside.index()], false) {
                    next.push(beside.0);
                }
            }
        }
        edges += usize::from(!next.is_empty());
        ring = next;
    }
    if (edges as f64) < most {
        return Ok(());
    }
    Err(BindError::Slender {
        vertex: farthest,
        edges,
        order,
    })
}
