//! The cage: a closed triangle mesh with its edges.

use std::collections::BTreeMap;

use glam::DVec3;

/// A closed triangle mesh with its faces counterclockwise seen from outside.
#[derive(Clone, Debug)]
pub(crate) struct CageMesh {
    pub vertices: Vec<DVec3>,
    pub faces: Vec<[u32; 3]>,
    pub edges: Vec<[u32; 2]>,
    /// For each face the edges opposite to its corners.
    pub sides: Vec<[Side; 3]>,
}

/// An edge in the direction of a face.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Side {
    pub edge: u32,
    /// 1 if the face passes the edge in its stored direction, else −1.
    pub sign: f64,
}

impl CageMesh {
    /// Makes a mesh and finds the edges of its faces.
    pub fn new(vertices: Vec<DVec3>, faces: Vec<[u32; 3]>) -> Self {
        let mut numbers: BTreeMap<[u32; 2], u32> = BTreeMap::new();
        let mut edges = Vec::new();
        let sides = faces.iter().map(|face| {
            [0, 1, 2].map(|corner| {
                let (from, to) = (face[(corner + 1) % 3], face[(corner + 2) % 3]);
                let key = [from.min(to), from.max(to)];
                let edge = *numbers.entry(key).or_insert_with(|| {
                    edges.push(key);
                    edges.len() as u32 - 1
                });
                Side {
                    edge,
                    sign: if from < to { 1.0 } else { -1.0 },
                }
            })
        });
        let sides = sides.collect();
        Self {
            vertices,
            faces,
            edges,
            sides,
        }
    }

    /// A face's corners.
    pub fn corners(&self, face: usize) -> [DVec3; 3] {
        self.faces[face].map(|vertex| self.vertices[vertex as usize])
    }

    /// For each vertex its neighbours along edges, ascending.
    pub fn neighbours(&self) -> Vec<Vec<u32>> {
        let mut neighbours = vec![Vec::new(); self.vertices.len()];
        for &[a, b] in &self.edges {
            neighbours[a as usize].push(b);
            neighbours[b as usize].push(a);
        }
        for own in &mut neighbours {
            own.sort_unstable();
        }
        neighbours
    }
}
