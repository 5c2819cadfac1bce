//! The energy over spokes (Sorkine & Alexa 2007): a vertex's cell is the edges to its neighbours.
//!
//! E = ½ Σ_i ½ Σ_j w_ij |e'_ij − R_i e_ij|² with w_ij = ½ Σ cot, floored: across obtuse triangles it is negative, and
//! then the rest shape is no minimum, nor need there be one. The floor is a hair above zero, so that the system stays
//! solvable where all of a vertex's weights are. With the ½ the majorising quadratic's matrix is the Laplacian of these
//! weights.

use glam::{DMat3, DVec3};
use pliant_mesh::Surface;
use rayon::prelude::*;

use super::domain::Domain;
use super::shape::{Scratch, Shape, fit_cells};
use crate::Laplacian;
use crate::operators::CHUNK;

/// The least weight of an edge, in units of the mean of its two ends' largest.
const FLOOR: f64 = 1e-6;

/// The energy's terms on a domain.
#[derive(Debug)]
pub(crate) struct Spokes {
    /// Of each cell: where its entries of `ends` start.
    offsets: Vec<u32>,
    ends: Vec<End>,
}

/// An edge seen from a cell.
#[derive(Clone, Copy, Debug)]
struct End {
    /// The other vertex.
    vertex: u32,
    weight: f64,
    /// From the cell's vertex to the other.
    rest: DVec3,
}

/// The floored weight of the edge from `local` to its `place`-th neighbour.
pub(crate) fn floored(laplacian: &Laplacian, largest: &[f64], local: usize, place: usize) -> f64 {
    let neighbour = laplacian.neighbours(local)[place] as usize;
    let floor = FLOOR * 0.5 * (largest[local] + largest[neighbour]);
    laplacian.weights(local)[place].max(floor).max(f64::MIN_POSITIVE)
}

/// The largest weight of each local vertex of the operator.
pub(crate) fn largest_weights(laplacian: &Laplacian) -> Vec<f64> {
    (0..laplacian.vertices().len())
        .map(|local| laplacian.weights(local).iter().fold(0.0, |a: f64, &b| a.max(b)))
        .collect()
}

impl Spokes {
    /// The terms of `domain`'s cells; `laplacian` has full rows for them and for their neighbours.
    pub fn new(surface: &Surface, laplacian: &Laplacian, domain: &Domain) -> Self {
        let largest = largest_weights(laplacian);
        let mut offsets = vec![0];
        let mut ends = Vec::new();
        for &vertex in &domain.vertices[..domain.cell_count] {
            let own = surface.positions[vertex as usize];
            if let Some(local) = laplacian.local(vertex) {
                for (place, &neighbour) in laplacian.neighbours(local).iter().enumerate() {
                    let other = laplacian.vertices()[neighbour as usize];
                    let number = domain.local_of[other as usize];
                    ends.push(End {
                        vertex: number,
                        weight: floored(laplacian, &largest, local, place),
                        rest: surface.positions[other as usize] - own,
                    });
                }
            }
            offsets.push(ends.len() as u32);
        }
        Self { offsets, ends }
    }

    fn around(&self, cell: usize) -> &[End] {
        &self.ends[self.offsets[cell] as usize..self.offsets[cell + 1] as usize]
    }

    /// ½ Σ_ij w_ij |e_ij|².
    pub fn scale(&self) -> f64 {
        0.5 * self
            .ends
            .iter()
            .map(|end| end.weight * end.rest.length_squared())
            .sum::<f64>()
    }

    /// As [`super::shape::Energy::evaluate`].
    pub fn evaluate(&self, shape: &mut Shape, scratch: &mut Scratch) {
        let Shape {
            displacements,
            rotations,
            gradient,
            energy,
        } = shape;
        let turns = &mut scratch.turns;
        let deformed = |cell: usize, end: &End| end.rest + (displacements[end.vertex as usize] - displacements[cell]);
        fit_cells(rotations, turns, |cell| {
            let mut sum = DMat3::ZERO;
            for end in self.around(cell) {
                let (edge, rest) = (deformed(cell, end) * end.weight, end.rest);
                sum += DMat3::from_cols(edge * rest.x, edge * rest.y, edge * rest.z);
            }
            sum
        });
        let solved_count = gradient.len();
        let partial: Vec<f64> = gradient
            .par_chunks_mut(CHUNK)
            .enumerate()
            .map(|(chunk, gradient)| {
                let mut sum = 0.0;
                for (place, gradient) in gradient.iter_mut().enumerate() {
                    let cell = chunk * CHUNK + place;
                    let mut pull = DVec3::ZERO;
                    for end in self.around(cell) {
                        let edge = deformed(cell, end);
                        let own = edge - turns[cell] * end.rest;
                        sum += end.weight * own.length_squared();
                        pull -= own * end.weight;
                        // A solved vertex's neighbours all have cells.
                        pull -= (edge - turns[end.vertex as usize] * end.rest) * end.weight;
                    }
                    *gradient = (0.5 * pull).to_array();
                }
                sum
            })
            .collect();
        let mut sum = partial.iter().sum::<f64>();
        for cell in solved_count..rotations.len() {
            for end in self.around(cell) {
                sum += end.weight * (deformed(cell, end) - turns[cell] * end.rest).length_squared();
            }
        }
        *energy = 0.25 * sum;
    }
}
