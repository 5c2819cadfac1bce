//! The bound linear shell: A_ff d_f = −A_fc d_c, factored, refined and checked.
//!
//! A factorisation that succeeds proves nothing: condition numbers reach 1e15 on real scans. So every solve is refined
//! (see `refine`), and every bind solves for the constant 1, whose solution is known, and refuses where it is missed.

use std::sync::Arc;

use pliant_mesh::Cancel;
use rayon::prelude::*;

use crate::BindError;
use crate::operators::CHUNK;
use crate::shell::assembly::assemble_shell;
use crate::shell::operator::ShellOperator;
use crate::sparse::Elimination;
use crate::sparse::cholesky::{Factor, Renewable, Renewal};
use crate::sparse::factor_error::FactorError;
use crate::sparse::matrix::CONSTRAINED;

/// The factored shell over the local vertices of its Laplacian.
#[derive(Debug)]
pub(crate) struct Shell {
    pub operator: ShellOperator,
    /// The local vertex of each column of the factor.
    columns: Vec<u32>,
    /// The column of each of the operator's springs.
    spring_columns: Vec<u32>,
    factored: Arc<Renewable>,
    /// How slowly refinement went at the check: [`crate::shell::refine`].
    pub(super) contraction: f64,
}

/// Where the system could not be factored or solved, as a surface vertex.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(crate) enum ShellError {
    NotPositiveDefinite { vertex: u32 },
    Inaccurate { vertex: u32, error: f64 },
    OutOfMemory,
    Cancelled,
}

/// Shifts of the unit diagonal that are tried one after the other. Refinement with the unshifted operator takes their
/// effect out again; the check of the constant says whether it did.
const SHIFTS: [f64; 4] = [0.0, 1e-13, 1e-11, 1e-9];

impl Shell {
    /// Factors the shell in which the vertices of `elimination` are solved for, eliminated in that order; the
    /// operator's Laplacian has full rows for them and their neighbours.
    pub fn new(
        operator: ShellOperator,
        elimination: Elimination,
        renewal: Renewal,
        cancel: &Cancel,
    ) -> Result<Self, ShellError> {
        let laplacian = &operator.laplacian;
        let columns = laplacian.locals(&elimination.order);
        let mut column_of = vec![CONSTRAINED; laplacian.vertices().len()];
        for (column, &local) in columns.iter().enumerate() {
            column_of[local as usize] = column as u32;
        }
        let spring_columns = operator
            .springs
            .locals()
            .iter()
            .map(|&local| column_of[local as usize])
            .collect();
        let plate = assemble_shell(&operator, &columns, &column_of);
        cancel.check().map_err(|_| ShellError::Cancelled)?;
        match Renewable::of(plate, elimination, &SHIFTS, renewal, cancel) {
            Ok(factored) => Ok(Self {
                operator,
                columns,
                spring_columns,
                factored: Arc::new(factored),
                contraction: 0.0,
            }),
            Err(FactorError::Memory) => Err(ShellError::OutOfMemory),
            Err(FactorError::Cancelled) => Err(ShellError::Cancelled),
            Err(FactorError::Pivot(column)) => {
                let local = columns.get(column).map_or(0, |&local| local as usize);
                Err(ShellError::NotPositiveDefinite {
                    vertex: operator.laplacian.vertices()[local],
                })
            }
        }
    }

    /// The local vertices that are solved for.
    pub fn columns(&self) -> &[u32] {
        &self.columns
    }

    /// The factor of S A S, or nearly so.
    pub fn factor(&self) -> &Factor {
        &self.factored.factor
    }

    /// What a shell that is nearly the same can take over.
    pub fn factored(&self) -> &Arc<Renewable> {
        &self.factored
    }

    /// What was added to the scaled matrix' unit diagonal to factor it; 0 where nothing had to be.
    pub fn shift(&self) -> f64 {
        self.factored.shift
    }

    /// S: the scale of each column.
    pub fn scale(&self) -> &[f64] {
        self.factored.scale()
    }

    /// S (W (c − d) − A d) on the solved vertices, by differences along edges and springs.
    pub fn scaled_residual<const K: usize>(&self, d: &[[f64; K]]) -> Vec<[f64; K]> {
        let potential = self.operator.potential(d);
        let mut residual: Vec<[f64; K]> = self
            .columns
            .par_iter()
            .with_min_len(CHUNK)
            .zip(self.scale())
            .map(|(&local, &scale)| {
                self.operator
                    .force(local as usize, &potential)
                    .map(|value| -value * scale)
            })
            .collect();
        for (spring, &column) in self.spring_columns.iter().enumerate() {
            let pull = self.operator.pull(spring, d);
            for k in 0..K {
                residual[column as usize][k] += self.scale()[column as usize] * pull[k];
            }
        }
        residual
    }
}

impl ShellError {
    /// The error as the caller sees it.
    pub fn into_bind_error(self, component_of: impl Fn(u32) -> u32, free_count: usize) -> BindError {
        match self {
            Self::NotPositiveDefinite { vertex } => BindError::NotPositiveDefinite {
                component: component_of(vertex),
                vertex,
            },
            Self::Inaccurate { vertex, error } => BindError::Inaccurate {
                component: component_of(vertex),
                vertex,
                error,
            },
            Self::OutOfMemory => BindError::OutOfMemory { free_count },
            Self::Cancelled => BindError::Cancelled(pliant_mesh::Cancelled),
        }
    }
}
