//! The majorising quadratic's matrix on the solved vertices, as compressed columns in the order of elimination, scaled
//! to a unit diagonal: the Laplacian −L, or with bending a plate.

use super::domain::Domain;
use super::spokes::{floored, largest_weights};
use super::springs::Spring;
use crate::shell::assembly::assemble_shell;
use crate::shell::operator::ShellOperator;
use crate::sparse::matrix::{CONSTRAINED, ScaledMatrix};
use crate::{ArapEnergy, Bilaplacian, Laplacian};

/// The matrix on the solved vertices, and how constrained ones pull at them.
pub(crate) struct System {
    /// S A S, A the majorising quadratic's matrix.
    pub matrix: ScaledMatrix,
    coupling: Coupling,
    springs: Vec<Spring>,
}

enum Coupling {
    /// Solved vertex, constrained local vertex, weight.
    Edges(Vec<(u32, u32, f64)>),
    /// The operator, each solved vertex's row in it, and the domain's local vertex of each of its.
    Plate {
        operator: Box<ShellOperator>,
        columns: Vec<u32>,
        domain_of: Vec<u32>,
    },
}

impl System {
    /// −A_sc x for the values `x` of constrained local vertices, and W x for those that a soft handle wants of its solved
    /// ones: the right-hand side whose solution extends them.
    pub fn pull(&self, x: &impl Fn(u32) -> f64) -> Vec<f64> {
        let mut pull = self.pull_of_constrained(x);
        for spring in &self.springs {
            pull[spring.local as usize] += spring.strength * x(spring.local);
        }
        pull
    }

    fn pull_of_constrained(&self, x: &impl Fn(u32) -> f64) -> Vec<f64> {
        match &self.coupling {
            Coupling::Edges(edges) => {
                let mut pull = vec![0.0; self.matrix.scale.len()];
                for &(vertex, other, weight) in edges {
                    pull[vertex as usize] += weight * x(other);
                }
                pull
            }
            Coupling::Plate {
                operator,
                columns,
                domain_of,
            } => {
                let value = |&vertex: &u32| {
                    let is_solved = (vertex as usize) < columns.len();
                    [if is_solved { 0.0 } else { x(vertex) }]
                };
                let values: Vec<[f64; 1]> = domain_of.iter().map(value).collect();
                let potential = operator.potential(&values);
                let pull = |&column: &u32| -operator.force(column as usize, &potential)[0];
                columns.iter().map(pull).collect()
            }
        }
    }
}

/// The thin plate that also stretches, −L + `bending` L M⁻¹ L; `laplacian` has full rows for all cells.
pub(crate) fn assemble_plate(laplacian: Laplacian, domain: &Domain, springs: &[Spring], bending: f64) -> System {
    let domain_of: Vec<u32> = laplacian
        .vertices()
        .iter()
        .map(|&vertex| domain.local_of[vertex as usize])
        .collect();
    let mut columns = vec![0; domain.solved_count];
    let mut column_of = vec![CONSTRAINED; domain_of.len()];
    for (local, &vertex) in domain_of.iter().enumerate() {
        if (vertex as usize) < domain.solved_count {
            columns[vertex as usize] = local as u32;
            column_of[local] = vertex;
        }
    }
    let mut operator = ShellOperator::new(laplacian, &Bilaplacian::default(), 1.0);
    (operator.stretching, operator.bending) = (1.0, bending);
    let hung: Vec<u32> = springs.iter().map(|spring| columns[spring.local as usize]).collect();
    let strengths: Vec<f64> = springs.iter().map(|spring| spring.strength).collect();
    operator.springs.add(column_of.len(), &hung, &strengths);
    System {
        springs: springs.to_vec(),
        matrix: assemble_shell(&operator, &columns, &column_of),
        coupling: Coupling::Plate {
            operator: Box::new(operator),
            columns,
            domain_of,
        },
    }
}

/// Assembles the Laplacian −L of the energy; `laplacian` has full rows for the solved vertices at least.
pub(crate) fn assemble(laplacian: &Laplacian, domain: &Domain, springs: &[Spring], energy: ArapEnergy) -> System {
    let largest = match energy {
        ArapEnergy::Spokes => largest_weights(laplacian),
        ArapEnergy::SpokesAndRims | ArapEnergy::Smooth => Vec::new(),
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
                    ArapEnergy::SpokesAndRims | ArapEnergy::Smooth => laplacian.weights(local)[place],
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
    for spring in springs {
        diagonal[spring.local as usize] += spring.strength;
    }
    let scale: Vec<f64> = diagonal
        .iter()
        .map(|&value| if value > 0.0 { value.sqrt().recip() } else { 1.0 })
        .collect();
    let mut matrix = ScaledMatrix {
        scale,
        lower_offsets: vec![0],
        lower_rows: Vec::new(),
        lower_values: Vec::new(),
    };
    for (column, row) in rows.iter().enumerate() {
        let scale = matrix.scale[column];
        matrix.lower_rows.push(column as u32);
        matrix.lower_values.push(diagonal[column] * scale * scale);
        for &(other, value) in row {
            if other as usize > column {
                matrix.lower_rows.push(other);
                matrix.lower_values.push(value * scale * matrix.scale[other as usize]);
            }
        }
        matrix.lower_offsets.push(matrix.lower_rows.len() as u32);
    }
    System {
        springs: springs.to_vec(),
        matrix,
        coupling: Coupling::Edges(constrained),
    }
}
