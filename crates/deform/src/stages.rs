//! The stages of a binding, for measurements, which alone need them separately.

use pliant_mesh::Cancel;

pub use crate::methods::cage::parts as cage;

use crate::handles::Handle;
use crate::sparse::Elimination;
use crate::sparse::cholesky::Factor;
use crate::sparse::matrix::{CONSTRAINED, ScaledMatrix};
use crate::systems::assembly::assemble_bilaplacian;
use crate::systems::hubs::Hubs;
use crate::systems::operator::BilaplacianOperator;
use crate::systems::setup::{Boundaries, operator};
use crate::{Bilaplacian, Budget, Ordering, Problem};

/// The operator of a bi-Laplacian, and the order in which its vertices are eliminated.
#[derive(Debug)]
pub struct Operator {
    operator: BilaplacianOperator,
    elimination: Elimination,
}

/// The assembled matrix.
#[derive(Debug)]
pub struct Matrix(ScaledMatrix);

/// Its factor, empty or filled.
#[derive(Debug)]
pub struct Factored(Factor);

impl Operator {
    /// The operator of a problem that can be bound.
    pub fn of(problem: &Problem, options: &Bilaplacian, ordering: &Ordering) -> Option<Self> {
        let boundary = problem.boundary();
        let partition = problem.method.partition(&boundary).ok()?;
        let positions = &problem.surface.positions;
        let handle = |vertices: &Vec<u32>| Handle::new(vertices.clone(), positions);
        let handles: Vec<Handle> = partition.handles.iter().map(handle).collect();
        Some(Self {
            operator: operator(&boundary, options.energy(), &partition, &handles, Boundaries::Natural).0,
            elimination: ordering.elimination(&partition.solved),
        })
    }

    /// Its matrix, the curvature at hubs included; `None` if it needs too much memory.
    pub fn assemble(&self) -> Option<Matrix> {
        let laplacian = &self.operator.laplacian;
        let columns: Vec<u32> = laplacian.locals(&self.elimination.order);
        let mut column_of = vec![CONSTRAINED; laplacian.vertices().len()];
        for (column, &local) in columns.iter().enumerate() {
            column_of[local as usize] = column as u32;
        }
        let matrix = assemble_bilaplacian(
            &self.operator,
            &columns,
            &column_of,
            &Hubs::default(),
            Budget::default(),
        );
        matrix.ok().map(Matrix)
    }

    /// The symbolic factorisation of the matrix.
    pub fn analyse(&self, matrix: &Matrix) -> Option<Factored> {
        let factor = Factor::analysed(&matrix.0, &self.elimination.ends, Budget::default());
        factor.ok().map(Factored)
    }
}

impl Matrix {
    /// The number of columns.
    pub fn column_count(&self) -> usize {
        self.0.scale.len()
    }

    /// Column starts, rows and values on and below the diagonal, in the order of elimination. The diagonal comes first
    /// in its column; the other rows are in any order.
    pub fn lower_columns(&self) -> (&[u32], &[u32], &[f64]) {
        (&self.0.lower_offsets, &self.0.lower_rows, &self.0.lower_values)
    }
}

impl Factored {
    /// Factors; `None` if the matrix is not positive definite.
    pub fn fill(&mut self, matrix: &Matrix) -> Option<()> {
        self.0.fill(&matrix.0, 0.0, &Cancel::new()).ok()
    }

    /// Solves for K right-hand sides in place, with one row per column of the matrix.
    pub fn solve<const K: usize>(&self, x: &mut [[f64; K]]) {
        self.0.solve(x);
    }

    /// The number of stored entries.
    pub fn stored(&self) -> usize {
        self.0.stored()
    }

    /// The number of columns.
    pub fn column_count(&self) -> usize {
        self.0.column_count()
    }

    /// Multiplications and additions of the factorisation.
    pub fn work(&self) -> f64 {
        self.0.work()
    }
}
