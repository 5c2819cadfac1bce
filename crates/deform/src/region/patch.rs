//! The solved part of a surface, with the vertices around it.

use glam::DVec3;
use pliant_mesh::SurfaceVertex;
use rayon::prelude::*;

use crate::handles::FRAME_CHUNK;
use crate::numerical::rows::CHUNK;
use crate::region::boundary_problem::BoundaryProblem;

/// *Local* vertices: the solved ones and their neighbours on the surface, ascending; and a *row* for each solved one.
#[derive(Debug)]
pub(crate) struct Patch {
    /// The surface vertex of each local one.
    pub vertices: Vec<u32>,
    /// The local vertex of each row.
    pub rows: Vec<u32>,
    /// The rest positions of the local vertices.
    pub rest: Vec<DVec3>,
    /// The size of the bending part.
    pub size: f64,
}

impl Patch {
    /// The patch around the `solved` vertices, which are ascending; `rest` gives a surface vertex's rest position.
    pub fn of(problem: &BoundaryProblem, solved: &[u32], rest: impl Fn(usize) -> DVec3) -> Self {
        let mut is_local = vec![false; problem.surface.positions.len()];
        for &vertex in solved {
            is_local[vertex as usize] = true;
            for neighbour in problem.topology.neighbours(SurfaceVertex(vertex)) {
                is_local[neighbour.index()] = true;
            }
        }
        let vertices: Vec<u32> = (0..is_local.len() as u32)
            .filter(|&vertex| is_local[vertex as usize])
            .collect();
        let rows = solved
            .iter()
            .filter_map(|vertex| vertices.binary_search(vertex).ok())
            .map(|local| local as u32);
        Self {
            rows: rows.collect(),
            rest: vertices.iter().map(|&vertex| rest(vertex as usize)).collect(),
            vertices,
            size: problem.size(),
        }
    }

    /// Fills `posed` with the local vertices' positions under the surface's `displacements`.
    pub fn pose(&self, displacements: &[DVec3], posed: &mut Vec<DVec3>) {
        posed.resize(self.rest.len(), DVec3::ZERO);
        posed
            .par_chunks_mut(CHUNK)
            .zip(self.rest.par_chunks(CHUNK).zip(self.vertices.par_chunks(CHUNK)))
            .for_each(|(posed, (rest, vertices))| {
                for ((posed, rest), &vertex) in posed.iter_mut().zip(rest).zip(vertices) {
                    *posed = *rest + displacements[vertex as usize];
                }
            });
    }

    /// Replaces the solved vertices' displacements by `displacement` of a row and its local vertex.
    pub fn write(&self, displacements: &mut [DVec3], displacement: impl Fn(usize, usize) -> DVec3 + Sync) {
        let place = |vertex: usize| {
            self.rows
                .partition_point(|&local| (self.vertices[local as usize] as usize) < vertex)
        };
        displacements
            .par_chunks_mut(FRAME_CHUNK)
            .enumerate()
            .for_each(|(chunk, out)| {
                let first = chunk * FRAME_CHUNK;
                for row in place(first)..place(first + out.len()) {
                    let local = self.rows[row] as usize;
                    out[self.vertices[local] as usize - first] = displacement(row, local);
                }
            });
    }
}
