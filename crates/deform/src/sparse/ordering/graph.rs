//! An order of elimination for any graph.

use pliant_mesh::{Cancel, Cancelled, SurfaceVertex};

use crate::numerical::graph::Graph;
use crate::sparse::Elimination;
use crate::sparse::ordering::dissection::dissect;

/// Compressed rows.
struct Rows<'a> {
    offsets: &'a [u32],
    neighbours: Vec<SurfaceVertex>,
}

impl Graph for Rows<'_> {
    fn neighbours(&self, node: SurfaceVertex) -> &[SurfaceVertex] {
        &self.neighbours[self.offsets[node.index()] as usize..self.offsets[node.index() + 1] as usize]
    }
}

/// The nodes of a symmetric graph, given as compressed rows of neighbours without themselves, in an order of
/// elimination.
///
/// # Errors
/// [`Cancelled`] soon after `cancel` is raised.
pub(crate) fn elimination(offsets: &[u32], neighbours: &[u32], cancel: &Cancel) -> Result<Elimination, Cancelled> {
    let rows = Rows {
        offsets,
        neighbours: neighbours.iter().map(|&node| SurfaceVertex(node)).collect(),
    };
    let piece = dissect(&rows, offsets.len() - 1, 1, cancel)?;
    Ok(Elimination {
        order: piece.order,
        ends: piece.ends,
    })
}
