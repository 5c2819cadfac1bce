//! Refuses surfaces that are too long for the order before anything is computed on them.
//!
//! The least eigenvalue of the n-th power of the Laplacian falls with the 2n-th power of the number of edges between a
//! vertex and the nearest constrained one. On strips of a million triangles no digit is left, and refinement would take
//! a minute to find that out.

use pliant_mesh::SurfaceVertex;

use crate::BindError;
use crate::operators::triangulation::{Graph, Triangulation};

/// If the number of edges to the nearest constrained vertex, to the 2n-th power, exceeds this, no digit is left. Strips
/// at order 2 were solved to three digits at 1.5·10¹⁸ and to none at 2.4·10¹⁹; at order 3 to seven digits at 4·10¹⁸, to
/// three at 2·10²⁰, and to none at 6·10²².
fn hopeless(order: u32) -> f64 {
    if order < 3 { 1e20 } else { 1e24 }
}

/// Refuses a surface with a vertex that is farther than `order` allows from every vertex that is not in `solved`
/// (ascending).
///
/// # Errors
/// [`BindError::Slender`] with the vertex that is farthest.
pub(crate) fn check(triangulation: &Triangulation, solved: &[u32], order: u32) -> Result<(), BindError> {
    let most = hopeless(order).powf(0.5 / f64::from(order));
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
