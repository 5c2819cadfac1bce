//! The part of a graph around the vertices that a system solves for.
//!
//! A large scan is bent in a small region. Ordering the whole mesh would then take longer than everything else: only
//! the vertices within k edges of solved ones have entries in the rows of Lᵏ that are factored.

use pliant_mesh::SurfaceVertex;

use crate::numerical::graph::Graph;

/// The subgraph of some vertices, which are numbered anew in their order.
pub(crate) struct Surroundings {
    /// The vertices, ascending.
    pub vertices: Vec<u32>,
    /// The first of each vertex' neighbours, and the end of the last one's.
    offsets: Vec<usize>,
    /// Their neighbours among them, by their new numbers.
    neighbours: Vec<SurfaceVertex>,
}

impl Surroundings {
    /// The vertices of `graph` at most `reach` edges away from those that are marked in `wanted`.
    pub fn of<G: Graph>(graph: &G, wanted: &[bool], reach: u32) -> Self {
        let mut is_near = wanted.to_vec();
        let mut vertices: Vec<u32> = (0..wanted.len() as u32).filter(|&v| wanted[v as usize]).collect();
        let mut first = 0;
        for _ in 0..reach {
            let ring = first..vertices.len();
            first = ring.end;
            for place in ring {
                for n in graph.neighbours(SurfaceVertex(vertices[place])) {
                    if !std::mem::replace(&mut is_near[n.index()], true) {
                        vertices.push(n.0);
                    }
                }
            }
        }
        vertices.sort_unstable();
        let mut number = vec![0; wanted.len()];
        for (place, &vertex) in vertices.iter().enumerate() {
            number[vertex as usize] = place as u32;
        }
        let (mut offsets, mut neighbours) = (vec![0], Vec::new());
        for &vertex in &vertices {
            let ring = graph.neighbours(SurfaceVertex(vertex)).iter();
            let near = ring.filter(|n| is_near[n.index()]);
            neighbours.extend(near.map(|n| SurfaceVertex(number[n.index()])));
            offsets.push(neighbours.len());
        }
        Self {
            vertices,
            offsets,
            neighbours,
        }
    }
}

impl Graph for Surroundings {
    fn neighbours(&self, vertex: SurfaceVertex) -> &[SurfaceVertex] {
        &self.neighbours[self.offsets[vertex.index()]..self.offsets[vertex.index() + 1]]
    }
}

#[cfg(test)]
mod tests {
    use pliant_mesh::{SurfaceVertex, shapes};

    use super::Surroundings;
    use crate::numerical::graph::Graph;

    #[test]
    fn they_are_the_vertices_within_reach_with_the_edges_between_them() {
        let model = shapes::model(shapes::grid(9, 9));
        let topology = &model.topology;
        let wanted: Vec<bool> = (0..topology.vertex_count()).map(|v| v == 40).collect();
        let mut expected = vec![40];
        for reach in 0..4 {
            let near = Surroundings::of(topology, &wanted, reach);
            assert_eq!(near.vertices, expected, "{reach}");
            for (place, &vertex) in near.vertices.iter().enumerate() {
                let ring = topology.neighbours(SurfaceVertex(vertex)).iter().map(|n| n.0);
                let inside: Vec<u32> = ring.filter(|n| expected.contains(n)).collect();
                let own = near.neighbours(SurfaceVertex(place as u32)).iter();
                assert!(own.map(|n| near.vertices[n.index()]).eq(inside), "{vertex}");
            }
            let beyond = expected.iter().flat_map(|&v| topology.neighbours(SurfaceVertex(v)));
            let mut next: Vec<u32> = beyond.map(|n| n.0).chain(expected.iter().copied()).collect();
            next.sort_unstable();
            next.dedup();
            expected = next;
        }
    }
}
