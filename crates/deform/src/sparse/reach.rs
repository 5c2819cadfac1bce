//! The vertices within a number of edges: the graph of a power of the Laplacian, row by row.

use pliant_mesh::SurfaceVertex;

use crate::operators::net::Graph;

/// Scratch room for walks over one surface.
pub(crate) struct Reach {
    power: u32,
    stamp: u32,
    stamps: Vec<u32>,
    found: Vec<u32>,
}

impl Reach {
    /// For walks of at most `power` edges over `vertex_count` vertices.
    pub fn new(vertex_count: usize, power: u32) -> Self {
        Self {
            power,
            stamp: 0,
            stamps: vec![0; vertex_count],
            found: Vec::new(),
        }
    }

    /// The vertices within `power` edges of `vertex`, each once, without it; nearer ones first.
    pub fn around(&mut self, graph: &impl Graph, vertex: u32) -> &[u32] {
        if self.stamp == u32::MAX {
            self.stamps.fill(0);
            self.stamp = 0;
        }
        self.stamp += 1;
        self.stamps[vertex as usize] = self.stamp;
        self.found.clear();
        self.found.push(vertex);
        let mut ring = 0..1;
        for _ in 0..self.power {
            for place in ring.clone() {
                for &next in graph.neighbours(SurfaceVertex(self.found[place])) {
                    if std::mem::replace(&mut self.stamps[next.index()], self.stamp) != self.stamp {
                        self.found.push(next.0);
                    }
                }
            }
            ring = ring.end..self.found.len();
        }
        &self.found[1..]
    }
}
