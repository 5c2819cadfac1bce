//! The rows that held vertices reach: the right-hand side of a field that is zero on all solved vertices.
//!
//! A solve begins from zero, and its first residual −A_fc d_c is zero except near held or moved vertices. On a scan
//! that is a small part of the rows, and a frame with a load can skip the others.

use crate::Laplacian;
use crate::sparse::matrix::CONSTRAINED;
use crate::systems::operator::BilaplacianOperator;

/// The rows that prescribed values reach.
#[derive(Debug)]
pub(crate) struct HeldReach {
    /// The local vertices where the potential of prescribed values need not be zero.
    rows: Vec<u32>,
    /// The columns of the solved vertices whose force need not be.
    columns: Vec<u32>,
}

impl HeldReach {
    /// For the operator and the column of each local vertex. `None` if the reach is wider than two edges, or covers so
    /// much of the surface that nothing is saved.
    pub fn of(operator: &BilaplacianOperator, columns: &[u32], column_of: &[u32]) -> Option<Self> {
        if operator.power > 2 || operator.stretched.is_some() {
            return None;
        }
        let laplacian = &operator.laplacian;
        let mut is_reached: Vec<bool> = column_of.iter().map(|&column| column == CONSTRAINED).collect();
        if operator.power == 2 {
            is_reached = (0..column_of.len())
                .map(|local| sees_reached(laplacian, &is_reached, local))
                .collect();
        }
        let seen: Vec<u32> = (0..columns.len() as u32)
            .filter(|&column| sees_reached(laplacian, &is_reached, columns[column as usize] as usize))
            .collect();
        let rows = (0..column_of.len() as u32).filter(|&local| is_reached[local as usize]);
        (4 * seen.len() < columns.len()).then(|| Self {
            rows: rows.collect(),
            columns: seen,
        })
    }

    /// S (−A d) on the columns, for a field that is zero on the solved vertices.
    pub fn scaled_force<const K: usize>(
        &self,
        operator: &BilaplacianOperator,
        (columns, scale): (&[u32], &[f64]),
        d: &[[f64; K]],
    ) -> Vec<[f64; K]> {
        let potential = operator.potential_at(&self.rows, d);
        let mut residual = vec![[0.0; K]; columns.len()];
        for &column in &self.columns {
            let column = column as usize;
            let force = operator.force(columns[column] as usize, &potential);
            residual[column] = force.map(|value| -value * scale[column]);
        }
        residual
    }
}

/// Returns true if a local vertex or one beside it is reached.
fn sees_reached(laplacian: &Laplacian, is_reached: &[bool], local: usize) -> bool {
    let mut beside = laplacian.neighbours(local).iter();
    is_reached[local] || beside.any(|&other| is_reached[other as usize])
}
