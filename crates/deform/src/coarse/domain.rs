//! The part of the surface that an energy of vertices and their rings sees, numbered for the solver.
//!
//! Local vertices are first the solved ones, in the order of elimination; then their constrained neighbours, whose
//! cells count too; then the rest of those cells' rings. So a field over the solved vertices is the head of a field
//! over all local vertices.

use pliant_mesh::{Surface, SurfaceVertex, Topology};

/// The vertices and faces in reach of the solved vertices.
#[derive(Debug)]
pub(crate) struct Domain {
    /// The surface vertex of each local one.
    pub vertices: Vec<u32>,
    /// The number of solved vertices.
    pub solved_count: usize,
    /// The number of vertices with a cell: the solved ones and their neighbours.
    pub cell_count: usize,
    /// The surface's triangles around the cells, nearest in the numbering first.
    pub faces: Vec<u32>,
    /// The local vertex of each surface vertex, [`ABSENT`] if it has none.
    pub local_of: Vec<u32>,
}

/// No local vertex.
pub(crate) const ABSENT: u32 = u32::MAX;

impl Domain {
    /// The domain around the solved surface vertices `order`.
    pub fn of(surface: &Surface, topology: &Topology, order: &[u32]) -> Self {
        let mut domain = Self {
            vertices: Vec::with_capacity(order.len()),
            solved_count: order.len(),
            cell_count: 0,
            faces: Vec::new(),
            local_of: vec![ABSENT; topology.vertex_count()],
        };
        for &vertex in order {
            domain.add(vertex);
        }
        for place in 0..domain.solved_count {
            domain.add_ring(topology, place);
        }
        domain.cell_count = domain.vertices.len();
        for place in domain.solved_count..domain.cell_count {
            domain.add_ring(topology, place);
        }
        let mut seen = vec![false; surface.triangles.len()];
        for &vertex in &domain.vertices[..domain.cell_count] {
            for face in topology.faces(SurfaceVertex(vertex), &surface.triangles) {
                if !std::mem::replace(&mut seen[face as usize], true) {
                    domain.faces.push(face);
                }
            }
        }
        domain
    }

    fn add(&mut self, vertex: u32) {
        let local = &mut self.local_of[vertex as usize];
        if *local == ABSENT {
            *local = self.vertices.len() as u32;
            self.vertices.push(vertex);
        }
    }

    fn add_ring(&mut self, topology: &Topology, place: usize) {
        for neighbour in topology.neighbours(SurfaceVertex(self.vertices[place])) {
            self.add(neighbour.0);
        }
    }
}
