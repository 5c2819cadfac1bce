//! Hubs: vertices with very many neighbours, such as the tip of a fan of thousands of triangles.
//!
//! A quasi-dense row gives an ordering no information and costs it the square of its length at every visit ([Dav06],
//! section 7.1). So hubs are removed from the graph first and eliminated last.

use pliant_mesh::SurfaceVertex;

use crate::numerical::graph::Graph;

/// The fewest neighbours of a hub, for any number of vertices. Below that all neighbours of a vertex are eliminated as
/// one dense block at little cost.
const LEAST: usize = 512;

/// The fewest neighbours of a hub among `vertex_count` vertices. It grows with the square root of the count: a low-rank
/// correction stores numbers in proportion to the count, a dense block in proportion to the square of the neighbours.
pub(crate) fn hub_degree(vertex_count: usize) -> usize {
    LEAST.max((2.0 * vertex_count as f64).sqrt() as usize)
}

/// The hubs of a graph of `count` vertices, ascending.
pub(crate) fn hubs<G: Graph>(graph: &G, count: usize) -> Vec<u32> {
    let least = hub_degree(count);
    (0..count as u32)
        .filter(|&v| graph.neighbours(SurfaceVertex(v)).len() > least)
        .collect()
}

/// A graph without its hubs' edges.
pub(crate) struct WithoutHubs {
    offsets: Vec<usize>,
    neighbours: Vec<SurfaceVertex>,
}

impl WithoutHubs {
    /// The `count` vertices of `graph`, of which `hubs` (ascending) have no neighbours here.
    pub fn of<G: Graph>(graph: &G, count: usize, hubs: &[u32]) -> Self {
        let mut is_hub = vec![false; count];
        hubs.iter().for_each(|&hub| is_hub[hub as usize] = true);
        let mut rows = Self {
            offsets: Vec::with_capacity(count + 1),
            neighbours: Vec::new(),
        };
        rows.offsets.push(0);
        for v in 0..count as u32 {
            if !is_hub[v as usize] {
                let ring = graph.neighbours(SurfaceVertex(v)).iter();
                rows.neighbours.extend(ring.filter(|n| !is_hub[n.index()]));
            }
            rows.offsets.push(rows.neighbours.len());
        }
        rows
    }
}

impl Graph for WithoutHubs {
    fn neighbours(&self, vertex: SurfaceVertex) -> &[SurfaceVertex] {
        &self.neighbours[self.offsets[vertex.index()]..self.offsets[vertex.index() + 1]]
    }
}
