//! The Laplacian's matrix −L on the solved vertices, as compressed columns in the order of elimination, scaled to a
//! unit diagonal.

use super::domain::Domain;
use super::spokes::{floored, largest_weights};
use crate::sparse::matrix::ScaledMatrix;
use crate::{ArapEnergy, Laplacian};

/// The matrix, and each solved vertex's weights to constrained vertices.
pub(crate) struct System {
    /// S (−L) S.
    pub matrix: ScaledMatrix,
    /// Solved vertex, constrained local vertex, weight.
    pub constrained: Vec<(u32, u32, f64)>,
}

/// Assembles the system; `laplacian` has full rows for the solved vertices at least.
pub(crate) fn assemble(laplacian: &Laplacian, domain: &Domain, energy: ArapEnergy) -> System {
    let largest = match energy {
        ArapEnergy::Spokes => largest_weights(laplacian),
        ArapEnergy::SpokesAndRims => Vec::new(),
    };
    let mut rows: Vec<Vec<(u32, f64)>> = Vec::with_capacity(domain.solved_count);
    let mut constrained = Vec::new();
    let mut diagonal = Vec::with_capacity(domain.solved_count);
    for (column, &vertex) in domain.vertices[..domain.solved_count].iter().enumerate() {
        let mut row = Vec::new();
        let mut sum = 0.0;
        if let Some(local) = laplacian.local(vertex) {
            for (place, &neighbour) in laplacian.neighbours(local).iter().enumerate() {
                let weight = match energy {
                    ArapEnergy::Spokes => floored(laplacian, &largest, local, place),
                    ArapEnergy::SpokesAndRims => laplacian.weights(local)[place],
                };
                sum += weight;
                let other = domain.local_of[laplacian.vertices()[neighbour as usize] as usize];
                if (other as usize) < domain.solved_count {
                    row.push((other, -weight));
                } else {
                    constrained.push((column as u32, other, weight));
                }
            }
        }
        diagonal.push(sum);
        rows.push(row);
    }
    let scale: Vec<f64> = diagonal
        .iter()
        .map(|&value| if value > 0.0 { value.sqrt().recip() } else { 1.0 })
        .collect();
    let mut matrix = ScaledMatrix {
        scale,
        upper_offsets: vec![0],
        upper_rows: Vec::new(),
        lower_offsets: vec![0],
        lower_rows: Vec::new(),
        lower_values: Vec::new(),
    };
    for (column, row) in rows.iter().enumerate() {
        let scale = matrix.scale[column];
        matrix.lower_rows.push(column as u32);
        matrix.lower_values.push(diagonal[column] * scale * scale);
        for &(other, value) in row {
            if (other as usize) < column {
                matrix.upper_rows.push(other);
            } else {
                matrix.lower_rows.push(other);
                matrix.lower_values.push(value * scale * matrix.scale[other as usize]);
            }
        }
        matrix.upper_offsets.push(matrix.upper_rows.len() as u32);
        matrix.lower_offsets.push(matrix.lower_rows.len() as u32);
    }
    System { matrix, constrained }
}
