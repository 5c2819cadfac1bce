//! The majorising quadratic's matrix on the solved vertices, as compressed columns in the order of elimination, scaled
//! to a unit diagonal: the Laplacian −L or, with bending, a thin plate.

use glam::DVec3;
use rayon::prelude::*;

use super::cells::{Cells, vector};
use super::spokes::{floored, largest_weights};
use crate::budget::reserved;
use crate::coarse::domain::Domain;
use crate::descent::springs::Spring;
use crate::numerical::rows::CHUNK;
use crate::sparse::factor_error::FactorError;
use crate::sparse::matrix::ScaledMatrix;
use crate::sparse::ordering::hubs::hub_degree;
use crate::{ArapEnergy, Laplacian};

/// The matrix on the solved vertices, and its entries for constrained ones.
pub(crate) struct System {
    /// S A S, A the majorising quadratic's matrix.
    pub matrix: ScaledMatrix,
    /// Solved vertex, constrained local vertex, −A's entry.
    coupling: Vec<(u32, u32, f64)>,
    springs: Vec<Spring>,
}

impl System {
    /// The right-hand side for the values `x` of constrained local vertices, −A_sc x, and of soft handles' targets, W
    /// x.
    pub fn pull(&self, x: &impl Fn(u32) -> f64) -> Vec<f64> {
        let mut pull = vec![0.0; self.matrix.scale.len()];
        for &(vertex, other, weight) in &self.coupling {
            pull[vertex as usize] += weight * x(other);
        }
        for spring in &self.springs {
            pull[spring.local as usize] += spring.strength * x(spring.local);
        }
        pull
    }
}

/// A solved vertex' diagonal entry, and minus the others of its row by local vertex.
struct MatrixRow {
    diagonal: f64,
    others: Vec<(u32, f64)>,
}

/// Assembles the bending matrix of cells that bend: their weights' Laplacian less Σ_i Z_i β_i K_i Z_iᵀ, Z_i's rows
/// being G_iv for the ring's vertices and minus their sum for the cell's own.
///
/// The subtracted part of a hub's cell would couple all its neighbours with each other and is left out. The quadratic
/// is larger then and still majorises the energy, so the minimum is the same, and only steps differ, at hubs.
///
/// # Errors
/// [`FactorError::Memory`].
pub(crate) fn assemble_bending(cells: &Cells, domain: &Domain, springs: &[Spring]) -> Result<System, FactorError> {
    let most = hub_degree(domain.local_of.len());
    let rows: Vec<MatrixRow> = (0..domain.solved_count.div_ceil(CHUNK))
        .into_par_iter()
        .map_init(
            || vec![0_u32; domain.vertices.len()],
            |slots, chunk| {
                let range = chunk * CHUNK..((chunk + 1) * CHUNK).min(domain.solved_count);
                range
                    .map(|column| bending_row(cells, column as u32, most, slots))
                    .collect::<Vec<_>>()
            },
        )
        .flatten()
        .collect();
    assembled(&rows, domain, springs)
}

/// Cells with more than `most` neighbours belong to hubs. `slots` are all zero before and after the call.
fn bending_row(cells: &Cells, column: u32, most: usize, slots: &mut [u32]) -> MatrixRow {
    let mut others: Vec<(u32, f64)> = Vec::new();
    let mut add = |others: &mut Vec<(u32, f64)>, end: u32, value: f64| {
        let slot = &mut slots[end as usize];
        if *slot == 0 {
            others.push((end, 0.0));
            *slot = others.len() as u32;
        }
        others[*slot as usize - 1].1 += value;
    };
    let around = cells.around(column as usize);
    add(&mut others, column, 0.0);
    for place in around.clone() {
        let weight = cells.towards[place][3];
        add(&mut others, cells.ends[place], weight);
        add(&mut others, column, -weight);
    }
    for &cell in std::iter::once(&column).chain(&cells.ends[around]) {
        let ring = cells.around(cell as usize);
        if ring.len() > most {
            continue;
        }
        let sum: DVec3 = ring.clone().map(|place| vector(cells.towards[place])).sum();
        let row = |end: u32| {
            let own = ring.clone().find(|&place| cells.ends[place] == end);
            own.map_or(-sum, |place| vector(cells.towards[place]))
        };
        let [xx, xy, xz, yy, yz, zz] = cells.bending[cell as usize].hold;
        let z = row(column);
        let held = DVec3::new(
            xx * z.x + xy * z.y + xz * z.z,
            xy * z.x + yy * z.y + yz * z.z,
            xz * z.x + yz * z.y + zz * z.z,
        );
        add(&mut others, cell, -held.dot(sum));
        for place in ring.clone() {
            add(&mut others, cells.ends[place], held.dot(vector(cells.towards[place])));
        }
    }
    for (end, _) in &others {
        slots[*end as usize] = 0;
    }
    let diagonal = -others.swap_remove(0).1;
    MatrixRow { diagonal, others }
}

/// Assembles the Laplacian −L of the energy; `laplacian` has full rows for the solved vertices at least.
///
/// # Errors
/// [`FactorError::Memory`].
pub(crate) fn assemble(
    laplacian: &Laplacian,
    domain: &Domain,
    springs: &[Spring],
    energy: ArapEnergy,
) -> Result<System, FactorError> {
    let largest = match energy {
        ArapEnergy::Spokes => largest_weights(laplacian),
        ArapEnergy::SpokesAndRims | ArapEnergy::Smooth => Vec::new(),
    };
    let rows: Vec<MatrixRow> = domain.vertices[..domain.solved_count]
        .iter()
        .map(|&vertex| {
            let mut row = MatrixRow {
                diagonal: 0.0,
                others: Vec::new(),
            };
            if let Some(local) = laplacian.local(vertex) {
                for (place, &neighbour) in laplacian.neighbours(local).iter().enumerate() {
                    let weight = match energy {
                        ArapEnergy::Spokes => floored(laplacian, &largest, local, place),
                        ArapEnergy::SpokesAndRims | ArapEnergy::Smooth => laplacian.weights(local)[place],
                    };
                    row.diagonal += weight;
                    let other = domain.local_of[laplacian.vertices()[neighbour as usize] as usize];
                    row.others.push((other, weight));
                }
            }
            row
        })
        .collect();
    assembled(&rows, domain, springs)
}

fn assembled(rows: &[MatrixRow], domain: &Domain, springs: &[Spring]) -> Result<System, FactorError> {
    let mut diagonal: Vec<f64> = rows.iter().map(|row| row.diagonal).collect();
    for spring in springs {
        diagonal[spring.local as usize] += spring.strength;
    }
    let scale: Vec<f64> = diagonal
        .iter()
        .map(|&value| if value > 0.0 { value.sqrt().recip() } else { 1.0 })
        .collect();
    let below = |(column, row): (usize, &MatrixRow)| {
        let solved = column as u32..domain.solved_count as u32;
        1 + row.others.iter().filter(|(other, _)| solved.contains(other)).count()
    };
    let entries: usize = rows.iter().enumerate().map(below).sum();
    u32::try_from(entries).map_err(|_| FactorError::Memory)?;
    let mut matrix = ScaledMatrix {
        scale,
        lower_offsets: reserved(rows.len() + 1)?,
        lower_rows: reserved(entries)?,
        lower_values: reserved(entries)?,
    };
    matrix.lower_offsets.push(0);
    let mut coupling = Vec::new();
    for (column, row) in rows.iter().enumerate() {
        let scale = matrix.scale[column];
        matrix.lower_rows.push(column as u32);
        matrix.lower_values.push(diagonal[column] * scale * scale);
        for &(other, value) in &row.others {
            if other as usize >= domain.solved_count {
                coupling.push((column as u32, other, value));
            } else if other as usize > column {
                matrix.lower_rows.push(other);
                matrix.lower_values.push(-value * scale * matrix.scale[other as usize]);
            }
        }
        matrix.lower_offsets.push(matrix.lower_rows.len() as u32);
    }
    Ok(System {
        springs: springs.to_vec(),
        matrix,
        coupling,
    })
}
