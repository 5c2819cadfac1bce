//! The matrix JᵀJ of the residuals, whose pattern is analysed once.
//!
//! A column's rows are the vertices that share an edge or a hinge with its own; those of a triangle share its edges.
//! Volumes are left out of it: their gradients g enter the solution by the formula of Sherman and Morrison,
//! (K + w g gᵀ)⁻¹ b = y − z w gᵀy / (1 + w gᵀz) with y = K⁻¹ b and z = K⁻¹ g, component by component.

use glam::DVec3;
use pliant_mesh::Cancel;
use rayon::prelude::*;

use super::elements::Elements;
use super::leaning::Leaning;
use super::shape::{Energy, Slopes};
use crate::budget::{Budget, bytes_of, filled, reserved};
use crate::numerical::sums::Field;
use crate::operators::{CHUNK, place_in};
use crate::sparse::cholesky::Factor;
use crate::sparse::factor_error::FactorError;
use crate::sparse::matrix::ScaledMatrix;

/// Unknowns of a vertex.
const DOF: usize = 3;

/// What is added to the unit diagonal: the least for rounding, more where no length of a step lowers the energy or the
/// matrix is singular.
const DAMPINGS: [f64; 5] = [1e-13, 1e-10, 1e-7, 1e-4, 1e-2];

/// The matrix and its factor.
#[derive(Debug)]
pub(super) struct System {
    pattern: Pattern,
    matrix: ScaledMatrix,
    factor: Factor,
    /// The place in [`DAMPINGS`].
    damping: usize,
    /// Steps with the present factor, or none if there is none.
    age: Option<u32>,
    /// What the free weights of examples change of the inverse, as of the present factor.
    leaning: Option<Leaning>,
}

/// Which vertices share an edge or a hinge.
#[derive(Clone, Debug)]
pub(super) struct Pattern {
    offsets: Vec<u32>,
    /// Of each solved vertex: itself, and those after it in the order of elimination, ascending.
    rows: Vec<u32>,
}

impl Pattern {
    /// Of the solved vertices.
    pub fn of(elements: &Elements) -> Self {
        let count = elements.solved_count;
        // A hinge's vertices are joined by edges but for those across.
        let across = elements.hinges.iter().map(|hinge| [hinge.corners[2], hinge.corners[3]]);
        let pairs = || {
            let all = elements.edges.iter().map(|edge| edge.ends).chain(across.clone());
            let ordered = all.map(|[one, other]| [one.min(other), one.max(other)]);
            ordered.filter(|pair| (pair[1] as usize) < count)
        };
        let mut offsets: Vec<u32> = vec![0; count + 1];
        pairs().for_each(|[one, _]| offsets[one as usize + 1] += 1);
        for vertex in 0..count {
            offsets[vertex + 1] += offsets[vertex] + 1;
        }
        let mut next = offsets.clone();
        let mut all = vec![0; offsets[count] as usize];
        let itself = (0..count as u32).map(|vertex| [vertex, vertex]);
        for [one, other] in itself.chain(pairs()) {
            all[next[one as usize] as usize] = other;
            next[one as usize] += 1;
        }
        let (mut rows, mut ends) = (Vec::with_capacity(all.len()), vec![0]);
        for vertex in 0..count {
            let own = &mut all[offsets[vertex] as usize..offsets[vertex + 1] as usize];
            own.sort_unstable();
            let first = rows.len();
            for &row in own.iter() {
                if rows.len() == first || rows.last() != Some(&row) {
                    rows.push(row);
                }
            }
            ends.push(rows.len() as u32);
        }
        Self { offsets: ends, rows }
    }

    /// A vertex' own row and those below.
    pub fn rows(&self, vertex: usize) -> &[u32] {
        &self.rows[self.offsets[vertex] as usize..self.offsets[vertex + 1] as usize]
    }

    /// How many vertices it has.
    pub fn count(&self) -> usize {
        self.offsets.len() - 1
    }

    /// A matrix of zeros with `dof` columns a vertex.
    pub fn matrix(&self, dof: usize) -> Result<ScaledMatrix, FactorError> {
        let pairs = self.rows.len() - self.count();
        let entries = self.count() * dof * (dof + 1) / 2 + pairs * dof * dof;
        u32::try_from(entries).map_err(|_| FactorError::Memory)?;
        let mut offsets = reserved(self.count() * dof + 1)?;
        offsets.push(0);
        let mut rows = reserved(entries)?;
        for vertex in 0..self.count() {
            for k in 0..dof {
                for &row in self.rows(vertex) {
                    let first = if row as usize == vertex { k } else { 0 };
                    rows.extend((first..dof).map(|l| (dof * row as usize + l) as u32));
                }
                offsets.push(rows.len() as u32);
            }
        }
        Ok(ScaledMatrix {
            scale: filled(1.0, self.count() * dof)?,
            lower_offsets: offsets,
            lower_values: filled(0.0, rows.len())?,
            lower_rows: rows,
        })
    }
}

/// Scales a matrix to a unit diagonal.
pub(super) fn scale(matrix: &mut ScaledMatrix) {
    for (column, scale) in matrix.scale.iter_mut().enumerate() {
        let diagonal = matrix.lower_values[matrix.lower_offsets[column] as usize];
        *scale = if diagonal > 0.0 { diagonal.sqrt().recip() } else { 1.0 };
    }
    matrix.scale_values();
}

impl System {
    /// Analyses the matrix, whose supernodes of vertices end at `ends`. Returns what is left of the budget.
    ///
    /// # Errors
    /// It takes more than the budget, or more memory than there is.
    pub fn of(pattern: &Pattern, ends: &[u32], budget: Budget) -> Result<(Self, Budget), FactorError> {
        let bytes = bytes_of(pattern.rows.len(), DOF * DOF * (size_of::<f64>() + size_of::<u32>()));
        let budget = budget.without(bytes)?;
        let matrix = pattern.matrix(DOF)?;
        let ends: Vec<u32> = ends.iter().map(|end| DOF as u32 * end).collect();
        let factor = Factor::analysed(&matrix, &ends, budget)?;
        let budget = budget.without(bytes_of(factor.stored(), size_of::<f64>()))?;
        let system = Self {
            pattern: pattern.clone(),
            matrix,
            factor,
            damping: 0,
            age: None,
            leaning: None,
        };
        Ok((system, budget))
    }

    /// How many numbers the factor stores.
    pub fn stored(&self) -> usize {
        self.factor.stored()
    }

    /// Operations of a factorisation.
    pub fn work(&self) -> f64 {
        self.factor.work()
    }

    /// The next step factors, as little damped as possible.
    pub fn undamp(&mut self) {
        self.damping = 0;
        self.age = None;
    }

    /// The next step factors, damped more. Whether it can be.
    pub fn damp(&mut self) -> bool {
        self.damping += 1;
        self.age = None;
        self.damping < DAMPINGS.len()
    }

    /// A step went well: the next factor is damped less.
    pub fn relax(&mut self) {
        if self.damping > 0 {
            self.damping -= 1;
            self.age = None;
        }
    }

    /// The next step factors.
    pub fn renew(&mut self) {
        self.age = None;
    }

    /// Whether a factor is due, which has served for so many steps or is missing; counts a step.
    pub fn is_due(&mut self, steps: u32) -> bool {
        let age = self.age.filter(|age| *age < steps);
        self.age = Some(age.unwrap_or(0) + 1);
        age.is_none()
    }

    /// Fills in the matrix with these gradients and factors it.
    ///
    /// # Errors
    /// It is not positive definite, however much it is damped, or memory is short.
    pub fn factor(&mut self, energy: &Energy, slopes: &Slopes) -> Result<(), FactorError> {
        self.assemble(energy, slopes);
        let cancel = Cancel::new();
        loop {
            let damping = DAMPINGS[self.damping.min(DAMPINGS.len() - 1)];
            match self.factor.fill(&self.matrix, damping, &cancel) {
                Err(FactorError::Pivot(_)) if self.damping + 1 < DAMPINGS.len() => self.damping += 1,
                Err(error) => return Err(error),
                Ok(()) => break,
            }
        }
        self.leaning = Leaning::of(energy, slopes, |x| self.apply_residuals(energy, slopes, x));
        Ok(())
    }

    fn assemble(&mut self, energy: &Energy, slopes: &Slopes) {
        let Self { pattern, matrix, .. } = self;
        let count = pattern.count();
        let mut chunks = Vec::with_capacity(count / CHUNK + 1);
        let mut rest = matrix.lower_values.as_mut_slice();
        for first in (0..count).step_by(CHUNK) {
            let end = (first + CHUNK).min(count);
            let entries = matrix.lower_offsets[DOF * end] - matrix.lower_offsets[DOF * first];
            let (own, tail) = rest.split_at_mut(entries as usize);
            chunks.push((first..end, own));
            rest = tail;
        }
        chunks.into_par_iter().for_each(|(vertices, mut values)| {
            let mut blocks: Vec<[[f64; DOF]; DOF]> = Vec::new();
            for vertex in vertices {
                let rows = pattern.rows(vertex);
                blocks.clear();
                blocks.resize(rows.len(), [[0.0; DOF]; DOF]);
                add_blocks(energy, slopes, vertex, rows, &mut blocks);
                for k in 0..DOF {
                    let len = DOF * rows.len() - k;
                    let (column, tail) = values.split_at_mut(len);
                    values = tail;
                    let entries = blocks.iter().flatten().skip(k).map(|row| row[k]);
                    column.iter_mut().zip(entries).for_each(|(value, entry)| *value = entry);
                }
            }
        });
        for (local, more) in energy.on_diagonal() {
            for k in 0..DOF {
                let diagonal = matrix.lower_offsets[DOF * local as usize + k];
                matrix.lower_values[diagonal as usize] += more;
            }
        }
        scale(matrix);
    }

    /// x ← (JᵀJ)⁻¹ x, with the volumes of `slopes` and the free weights as of the factor.
    pub fn apply(&self, energy: &Energy, slopes: &Slopes, x: &mut [[f64; 3]]) {
        let right = self.leaning.as_ref().map(|_| x.to_vec());
        self.apply_residuals(energy, slopes, x);
        if let (Some(leaning), Some(right)) = (&self.leaning, right) {
            leaning.add(&right, x);
        }
    }

    /// The same with all weights held.
    fn apply_residuals(&self, energy: &Energy, slopes: &Slopes, x: &mut [[f64; 3]]) {
        if slopes.volume.is_empty() {
            let [solution] = self.solve([&*x]);
            x.copy_from_slice(&solution);
            return;
        }
        let [solution, swelling] = self.solve([&*x, &slopes.volume]);
        x.copy_from_slice(&solution);
        for part in &energy.enclosed.parts {
            let dot = |field: &[[f64; 3]]| -> f64 {
                let of = |&vertex: &u32| -> f64 {
                    let (a, b) = (field[vertex as usize], slopes.volume[vertex as usize]);
                    a.iter().zip(b).map(|(a, b)| a * b).sum()
                };
                part.solved.iter().map(of).sum()
            };
            let share = part.weight * dot(&solution) / (1.0 + part.weight * dot(&swelling));
            for &vertex in &part.solved {
                let swelling = swelling[vertex as usize];
                let own = &mut x[vertex as usize];
                own.iter_mut()
                    .zip(swelling)
                    .for_each(|(own, swelling)| *own -= share * swelling);
            }
        }
    }

    fn solve<const K: usize>(&self, fields: [&[[f64; 3]]; K]) -> [Field; K] {
        let scale = &self.matrix.scale;
        let mut columns: Vec<[f64; K]> = (0..scale.len())
            .map(|place| fields.map(|field| field[place / DOF][place % DOF] * scale[place]))
            .collect();
        self.factor.solve(&mut columns);
        std::array::from_fn(|k| {
            let vertices = columns.chunks_exact(DOF).zip(scale.chunks_exact(DOF));
            vertices
                .map(|(own, scale)| std::array::from_fn(|axis| own[axis][k] * scale[axis]))
                .collect()
        })
    }
}

/// Adds w ∇ᵣr ∇_vr ᵀ of all residuals r around a vertex v to the blocks of the `rows`.
fn add_blocks(energy: &Energy, slopes: &Slopes, vertex: usize, rows: &[u32], blocks: &mut [[[f64; DOF]; DOF]]) {
    let mut add = |row: u32, weight: f64, of_row: DVec3, own: DVec3| {
        if row < vertex as u32 {
            return;
        }
        if let Some(place) = place_in(rows, &row) {
            let own = (own * weight).to_array();
            for (sums, factor) in blocks[place].iter_mut().zip(of_row.to_array()) {
                sums.iter_mut().zip(own).for_each(|(sum, own)| *sum += factor * own);
            }
        }
    };
    for &entry in energy.edges_at(vertex) {
        let (place, end) = (entry as usize / 2, entry as usize % 2);
        let edge = &energy.elements.edges[place];
        let along = slopes.edges[place];
        add(vertex as u32, edge.weight, along, along);
        add(edge.ends[1 - end], edge.weight, -along, along);
    }
    for &entry in energy.faces_at(vertex) {
        let (place, corner) = (entry as usize / 4, entry as usize % 4);
        let corners = &energy.elements.faces[place].corners;
        let (weight, slopes) = (slopes.face_weights[place], &slopes.faces[place]);
        for (&row, &slope) in corners.iter().zip(slopes) {
            add(row, weight, slope, slopes[corner]);
        }
    }
    for &entry in energy.hinges_at(vertex) {
        let (place, corner) = (entry as usize / 4, entry as usize % 4);
        let hinge = &energy.elements.hinges[place];
        let slopes = &slopes.hinges[place];
        for (&row, &slope) in hinge.corners.iter().zip(slopes) {
            add(row, hinge.weight, slope, slopes[corner]);
        }
    }
}
