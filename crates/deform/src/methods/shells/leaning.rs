//! The change of the matrix by free weights of examples.
//!
//! With the weights eliminated (see `examples`) the matrix is K − C (G + ε diag G)⁻¹ Cᵀ, with K the matrix of constant
//! weights (`system`) and C = JᵀW Δ. Its inverse is K⁻¹ + U S⁻¹ Uᵀ with U = K⁻¹ C and S = G + ε diag G − Cᵀ U: one more
//! solution for each free weight, while the pattern of K is unchanged. It is positive definite if S is.

use glam::DVec3;
use rayon::prelude::*;

use super::shape::{Energy, Slopes};
use crate::numerical::dense::{Lu, is_positive_definite};
use crate::numerical::rows::CHUNK;
use crate::numerical::sums::{Field, add, dot};
use faer::Mat;

/// U and S, which turn K⁻¹ into the inverse of the reduced matrix.
#[derive(Debug)]
pub(super) struct Leaning {
    columns: Vec<Field>,
    small: Lu,
}

impl Leaning {
    /// Computes both for the gradients `slopes`; `solve` applies K⁻¹. None if no weight is free, or S is not positive
    /// definite: then K alone leads downhill.
    pub fn of(energy: &Energy, slopes: &Slopes, solve: impl Fn(&mut Field)) -> Option<Self> {
        let examples = &energy.examples;
        if !examples.are_free() {
            return None;
        }
        let (mut sources, mut columns) = (Vec::new(), Vec::new());
        for &example in examples.free() {
            let source = column(energy, slopes, example);
            let mut column = source.clone();
            solve(&mut column);
            sources.push(source);
            columns.push(column);
        }
        let mut small = examples.regular();
        for (row, source) in sources.iter().enumerate() {
            for (other, column) in columns.iter().enumerate() {
                small[(row, other)] -= 0.5 * (dot(source, column) + dot(&sources[other], &columns[row]));
            }
        }
        is_positive_definite(small.clone()).then(|| Self {
            columns,
            small: Lu::of(small),
        })
    }

    /// Adds U S⁻¹ Uᵀ b to x.
    pub fn add(&self, b: &[[f64; 3]], x: &mut [[f64; 3]]) {
        let right = Mat::from_fn(self.columns.len(), 1, |row, _| dot(&self.columns[row], b));
        let shares = self.small.solved(right);
        for (row, column) in self.columns.iter().enumerate() {
            add(x, shares[(row, 0)], column);
        }
    }
}

/// The column of C of a free example: up to its sign, the derivative of the energy's gradient by the example's weight.
fn column(energy: &Energy, slopes: &Slopes, example: usize) -> Field {
    let elements = &energy.elements;
    let [length, angle_rad, area, volume] = energy.examples.differences(example);
    let mut column: Field = (0..elements.solved_count)
        .into_par_iter()
        .with_min_len(CHUNK)
        .map(|vertex| {
            let mut sum = DVec3::ZERO;
            for &entry in energy.edges_at(vertex) {
                let place = entry as usize / 2;
                let pull = slopes.edges[place] * (elements.edges[place].weight * length(place));
                sum += if entry % 2 == 0 { -pull } else { pull };
            }
            for &entry in energy.hinges_at(vertex) {
                let (place, corner) = (entry as usize / 4, entry as usize % 4);
                let turn = elements.hinges[place].weight * angle_rad(place);
                sum += slopes.hinges[place][corner] * turn;
            }
            for &entry in energy.faces_at(vertex) {
                let (place, corner) = (entry as usize / 4, entry as usize % 4);
                sum += slopes.faces[place][corner] * (elements.faces[place].weight * area(place));
            }
            sum.to_array()
        })
        .collect();
    for (number, part) in energy.enclosed.parts.iter().enumerate() {
        let factor = part.weight * volume(number);
        for &vertex in &part.solved {
            let slope = slopes.volume[vertex as usize];
            let own = &mut column[vertex as usize];
            own.iter_mut()
                .zip(slope)
                .for_each(|(own, slope)| *own += factor * slope);
        }
    }
    column
}
