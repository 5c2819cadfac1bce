//! The energy over spokes and rims [CPSS10]: a vertex's cell is all edges of its triangles.
//!
//! E = ½ Σ_i Σ_f∋i ⅓ Σ_e∈f w_fe |e' − R_i e|², with w_fe half the cotangent opposite e in f, plain, negative ones
//! included: each triangle's inner sum is a squared norm whatever its shape, so nothing is ever negative. With the ⅓
//! the majorising quadratic's matrix is the Laplacian itself.
//!
//! A triangle's part of S is Σ_c p'_c g_cᵀ over its corners, with g_b = w_ab (b − a) + w_bc (b − c) and so on round.
//! Stiffness is in w_fe: a face's by the mean of its corners.

use glam::DVec3;
use pliant_mesh::{Surface, SurfaceVertex, Topology, edge_lengths};
use rayon::prelude::*;

use super::cells::{Cells, Entry, Solved, add_square};
use crate::coarse::domain::{ABSENT, Domain};
use crate::numerical::rows::{CHUNK, place_in};
use crate::operators::face_terms::Metric;

struct Face {
    corners: [u32; 3],
    /// w_fe of the edge opposite each corner.
    weights: [f64; 3],
    edges: [DVec3; 3],
    /// The mean over its corners of 1 and the cell's tie; 0 for a corner without a cell.
    factor: f64,
}

impl Face {
    /// g of a corner.
    fn towards(&self, corner: usize) -> DVec3 {
        let [next, last] = [(corner + 1) % 3, (corner + 2) % 3];
        // Edge k runs from corner k + 1 to corner k + 2.
        self.edges[next] * self.weights[next] - self.edges[last] * self.weights[last]
    }

    fn square(&self) -> f64 {
        let weighted = |k: usize| self.weights[k] * self.edges[k].length_squared();
        weighted(0) + weighted(1) + weighted(2)
    }
}

/// The stencils of `domain`'s cells, whose weights in the squares of differences are 1 and their `ties`; none are zero.
pub(crate) fn cells(surface: &Surface, topology: &Topology, stiffness: &[f64], domain: &Domain, ties: &[f64]) -> Cells {
    let metric = Metric::cotangent_area();
    let faces: Vec<Face> = domain
        .faces
        .par_iter()
        .with_min_len(CHUNK)
        .map(|&face| {
            let corners = surface.triangles[face as usize];
            let [a, b, c] = corners.map(|corner| surface.positions[corner.index()]);
            let locals = corners.map(|corner| domain.local_of[corner.index()]);
            let factor = |local: u32| match local as usize {
                cell if cell < domain.cell_count => firmness(ties, cell),
                _ => 0.0,
            };
            Face {
                corners: locals,
                factor: locals.map(factor).iter().sum::<f64>() / 3.0,
                weights: metric.face(stiffness, corners, edge_lengths([a, b, c])).half_cotangents,
                edges: [c - b, a - c, b - a],
            }
        })
        .collect();
    let mut slots = vec![ABSENT; surface.triangles.len()];
    for (slot, &face) in domain.faces.iter().enumerate() {
        slots[face as usize] = slot as u32;
    }
    let parts: Vec<Cells> = (0..domain.cell_count.div_ceil(CHUNK))
        .into_par_iter()
        .map(|chunk| {
            let mut part = Cells::default();
            let mut entries = Vec::new();
            for cell in chunk * CHUNK..((chunk + 1) * CHUNK).min(domain.cell_count) {
                let vertex = SurfaceVertex(domain.vertices[cell]);
                let local = |other: &SurfaceVertex| domain.local_of[other.index()];
                entries.clear();
                entries.extend(topology.neighbours(vertex).iter().map(|other| Entry {
                    end: local(other),
                    ..Entry::default()
                }));
                let around = topology
                    .faces(vertex, &surface.triangles)
                    .map(|face| &faces[slots[face as usize] as usize]);
                let mut rest = [0.0; 6];
                let ring = topology.neighbours(vertex);
                let place = |end: u32| place_in(ring, &SurfaceVertex(domain.vertices[end as usize]));
                for face in around {
                    add(face, cell as u32, &mut entries, &mut rest, place);
                }
                let solved = if cell < domain.solved_count {
                    Solved::Yes
                } else {
                    Solved::No
                };
                for entry in &mut entries {
                    entry.back *= firmness(ties, entry.end as usize);
                }
                part.push(&entries, rest, solved, firmness(ties, cell));
            }
            part
        })
        .collect();
    let mut cells = Cells::default();
    for part in parts {
        cells.append(part);
    }
    cells.constant = constant(&faces, domain);
    cells.scale = 0.5 * faces.iter().map(Face::square).sum::<f64>();
    cells
}

/// 1 + β of a cell.
fn firmness(ties: &[f64], cell: usize) -> f64 {
    1.0 + ties.get(cell).copied().unwrap_or(0.0)
}

/// Adds a triangle's part to a cell's entries (that of a local vertex is at `place`) and to its rest matrix.
fn add(face: &Face, cell: u32, entries: &mut [Entry], rest: &mut [f64; 6], place: impl Fn(u32) -> Option<usize>) {
    for own in (0..3).filter(|&own| face.corners[own] == cell) {
        for other in (0..3).filter(|&other| face.corners[other] != cell) {
            let end = face.corners[other];
            if let Some(entry) = place(end).map(|place| &mut entries[place]) {
                entry.towards += face.towards(other) / 3.0;
                entry.back += face.towards(own) / 3.0;
                entry.weight += face.weights[3 - own - other] * face.factor;
            }
        }
        for edge in 0..3 {
            add_square(rest, face.weights[edge] / 3.0, face.edges[edge]);
        }
    }
}

/// The correction of the cells' quarter sums, which leave out or count twice some edges: each triangle's edges should
/// count half, a third of it for each corner that has a cell.
fn constant(faces: &[Face], domain: &Domain) -> Vec<(u32, u32, f64)> {
    let mut pairs = Vec::new();
    let has_cell = |corner: u32| f64::from(u8::from((corner as usize) < domain.cell_count));
    for face in faces {
        for k in 0..3 {
            let (a, b) = (face.corners[(k + 1) % 3], face.corners[(k + 2) % 3]);
            let is_constrained = a.min(b) as usize >= domain.solved_count;
            let share = 0.5 - 0.25 * (has_cell(a) + has_cell(b));
            if is_constrained && a != b && share > 0.0 {
                pairs.push((a, b, face.weights[k] * face.factor * share));
            }
        }
    }
    pairs
}
