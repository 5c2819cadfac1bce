//! The matrix of a Newton step, whose pattern is analysed once.
//!
//! The Hessian is P − N with two positive matrices: P is JᵀJ and the positive part of the residuals' own second
//! derivatives, N the negative part (`curvature`). A step takes P − N if that is positive definite, which its
//! factorisation shows, and otherwise P − c N with the first c of a few for which it is. On bent scans P alone took two
//! to six times as many steps: it is too firm for a shape that is about to buckle. A multiple of the diagonal in place
//! of a smaller c resists moves of whole limbs most and took up to twice as many.
//!
//! A column's rows are the vertices that share an edge or a hinge with its own; those of a triangle share its edges.
//! The matrix excludes volumes: their gradients g enter the solution by the formula of Sherman and Morrison, (K + w g
//! gᵀ)⁻¹ b = y − z w gᵀy / (1 + w gᵀz) with y = K⁻¹ b and z = K⁻¹ g, component by component.

use glam::DMat3;
use pliant_mesh::Cancel;
use rayon::prelude::*;

use super::curvature::{self, FaceCurvature, Parts, Wing, outer};
use super::elements::Elements;
use super::leaning::Leaning;
use super::shape::{Energy, Shape, Slopes};
use crate::budget::{Budget, bytes_of, filled, reserved};
use crate::numerical::rows::{CHUNK, place_in};
use crate::numerical::sums::Field;
use crate::sparse::cholesky::Factor;
use crate::sparse::factor_error::FactorError;
use crate::sparse::matrix::ScaledMatrix;

/// Unknowns of a vertex.
const DOF: usize = 3;

/// Matrices from the exact to the firmest: the share of N, and the addition to the unit diagonal. A later one is taken
/// if an earlier one is not positive definite or no length of its step lowers the energy.
const RUNGS: [(f64, f64); 8] = [
    (1.0, 1e-13),
    (0.95, 1e-13),
    (0.8, 1e-13),
    (0.0, 1e-13),
    (0.0, 1e-10),
    (0.0, 1e-7),
    (0.0, 1e-4),
    (0.0, 1e-2),
];

/// The first rung that is positive definite up to rounding.
const SAFE: usize = 3;

/// The matrix and its factor.
#[derive(Debug)]
pub(super) struct System {
    pattern: Pattern,
    /// Its values are a combination of the two parts.
    matrix: ScaledMatrix,
    positive: Vec<f64>,
    negative: Vec<f64>,
    factor: Factor,
    /// The present place in [`RUNGS`].
    rung: usize,
    /// The change of the inverse by the free weights of examples, for the present factor.
    leaning: Option<Leaning>,
}

/// The pairs of vertices that share an edge or a hinge.
#[derive(Clone, Debug)]
pub(super) struct Pattern {
    offsets: Vec<u32>,
    /// For each solved vertex: itself, and its later neighbours in the order of elimination, ascending.
    rows: Vec<u32>,
}

impl Pattern {
    /// The pattern of the solved vertices.
    pub fn of(elements: &Elements) -> Self {
        let count = elements.solved_count;
        // Edges join a hinge's vertices except the two across it.
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

    /// The number of its vertices.
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
    /// Analyses the matrix, whose supernodes of vertices end at `ends`. Returns the rest of the budget too.
    ///
    /// # Errors
    /// It takes more than the budget, or more memory than there is.
    pub fn of(pattern: &Pattern, ends: &[u32], budget: Budget) -> Result<(Self, Budget), FactorError> {
        let bytes = bytes_of(
            pattern.rows.len(),
            DOF * DOF * (3 * size_of::<f64>() + size_of::<u32>()),
        );
        let budget = budget.without(bytes)?;
        let matrix = pattern.matrix(DOF)?;
        let ends: Vec<u32> = ends.iter().map(|end| DOF as u32 * end).collect();
        let factor = Factor::analysed(&matrix, &ends, budget)?;
        let budget = budget.without(bytes_of(factor.stored(), size_of::<f64>()))?;
        let system = Self {
            pattern: pattern.clone(),
            positive: filled(0.0, matrix.lower_values.len())?,
            negative: filled(0.0, matrix.lower_values.len())?,
            matrix,
            factor,
            rung: SAFE,
            leaning: None,
        };
        Ok((system, budget))
    }

    /// The count of numbers that the factor stores.
    pub fn stored(&self) -> usize {
        self.factor.stored()
    }

    /// The operations of a factorisation.
    pub fn work(&self) -> f64 {
        self.factor.work()
    }

    /// The next step takes P: after a jump of the handles nothing nearer to the Hessian is positive definite.
    pub fn undamp(&mut self) {
        self.rung = SAFE;
    }

    /// The next step takes a firmer matrix. Returns true if there is one.
    pub fn damp(&mut self) -> bool {
        self.rung += 1;
        self.rung < RUNGS.len()
    }

    /// After a good step, the next one tries a matrix nearer to the Hessian.
    pub fn relax(&mut self) {
        self.rung = self.rung.saturating_sub(1);
    }

    /// Fills in the matrix at an evaluated shape with its gradients, and factors it.
    ///
    /// # Errors
    /// It is not positive definite on any rung, memory is short, or it was cancelled.
    pub fn factor(
        &mut self,
        energy: &Energy,
        shape: &Shape,
        slopes: &Slopes,
        cancel: &Cancel,
    ) -> Result<(), FactorError> {
        self.assemble(energy, shape, slopes);
        loop {
            let (share, damping) = RUNGS[self.rung.min(RUNGS.len() - 1)];
            self.combine(energy, share);
            match self.factor.fill(&self.matrix, damping, cancel) {
                Err(FactorError::Pivot(_)) if self.rung + 1 < RUNGS.len() => self.rung += 1,
                Err(error) => return Err(error),
                Ok(()) => break,
            }
        }
        self.leaning = Leaning::of(energy, slopes, |x| self.apply_residuals(energy, slopes, x));
        Ok(())
    }

    /// Makes the matrix P less a share of N, scaled.
    fn combine(&mut self, energy: &Energy, share: f64) {
        let parts = self.positive.par_iter().zip(&self.negative);
        self.matrix
            .lower_values
            .par_iter_mut()
            .zip(parts)
            .with_min_len(CHUNK)
            .for_each(|(value, (positive, negative))| *value = positive - share * negative);
        for (local, more) in energy.on_diagonal() {
            for k in 0..DOF {
                let diagonal = self.matrix.lower_offsets[DOF * local as usize + k];
                self.matrix.lower_values[diagonal as usize] += more;
            }
        }
        scale(&mut self.matrix);
    }

    /// Finds P and N.
    fn assemble(&mut self, energy: &Energy, shape: &Shape, slopes: &Slopes) {
        let Self {
            pattern,
            matrix,
            positive,
            negative,
            ..
        } = self;
        let count = pattern.count();
        let mut chunks = Vec::with_capacity(count / CHUNK + 1);
        let mut rest = [positive.as_mut_slice(), negative.as_mut_slice()];
        for first in (0..count).step_by(CHUNK) {
            let end = (first + CHUNK).min(count);
            let entries = matrix.lower_offsets[DOF * end] - matrix.lower_offsets[DOF * first];
            let [own, tail] = split(rest, entries as usize);
            chunks.push((first..end, own));
            rest = tail;
        }
        chunks.into_par_iter().for_each(|(vertices, mut values)| {
            let mut blocks: Vec<Parts> = Vec::new();
            for vertex in vertices {
                let rows = pattern.rows(vertex);
                blocks.clear();
                blocks.resize(rows.len(), curvature::NONE);
                add_blocks(energy, shape, slopes, vertex, rows, &mut blocks);
                for k in 0..DOF {
                    let [columns, tail] = split(values, DOF * rows.len() - k);
                    values = tail;
                    for (part, column) in columns.into_iter().enumerate() {
                        let entries = blocks.iter().flat_map(|own| own[part].col(k).to_array()).skip(k);
                        column.iter_mut().zip(entries).for_each(|(value, entry)| *value = entry);
                    }
                }
            }
        });
    }

    /// x ← H⁻¹ x for the factored matrix H, with the volumes of `slopes` and the free weights of the factor.
    pub fn apply(&self, energy: &Energy, slopes: &Slopes, x: &mut [[f64; 3]]) {
        let right = self.leaning.as_ref().map(|_| x.to_vec());
        self.apply_residuals(energy, slopes, x);
        if let (Some(leaning), Some(right)) = (&self.leaning, right) {
            leaning.add(&right, x);
        }
    }

    /// The same with all weights constant.
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

/// Splits both slices at a place.
fn split(both: [&mut [f64]; 2], at: usize) -> [[&mut [f64]; 2]; 2] {
    let [(a, b), (c, d)] = both.map(|slice| slice.split_at_mut(at));
    [[a, c], [b, d]]
}

/// Adds the second derivatives of all residuals around a vertex to the blocks of the `rows` in its column.
fn add_blocks(energy: &Energy, shape: &Shape, slopes: &Slopes, vertex: usize, rows: &[u32], blocks: &mut [Parts]) {
    let mut add = |row: u32, block: Parts| {
        if row < vertex as u32 {
            return;
        }
        if let Some(place) = place_in(rows, &row) {
            blocks[place].iter_mut().zip(block).for_each(|(sum, own)| *sum += own);
        }
    };
    let elements = &energy.elements;
    for &entry in energy.edges_at(vertex) {
        let (place, end) = (entry as usize / 2, entry as usize % 2);
        let (edge, along) = (&elements.edges[place], slopes.edges[place]);
        let (length, pull) = energy.edge_at(shape, place);
        let [mut positive, negative] = curvature::of_edge(along, length, pull);
        positive += outer(along, along) * edge.weight;
        add(vertex as u32, [positive, negative]);
        add(edge.ends[1 - end], [-positive, -negative]);
    }
    for &entry in energy.faces_at(vertex) {
        let (place, corner) = (entry as usize / 4, entry as usize % 4);
        let (weight, slopes) = (slopes.face_weights[place], &slopes.faces[place]);
        let (corners, area, pull) = energy.face_at(shape, place);
        let curvature = FaceCurvature::of(corners, area, pull);
        for (row, &local) in elements.faces[place].corners.iter().enumerate() {
            let of_both = [slopes[row], slopes[corner]];
            let [positive, negative] = curvature.block([row, corner], of_both);
            add(local, [positive + outer(of_both[0], of_both[1] * weight), negative]);
        }
    }
    for &entry in energy.hinges_at(vertex) {
        let (place, corner) = (entry as usize / 4, entry as usize % 4);
        let (hinge, slopes) = (&elements.hinges[place], &slopes.hinges[place]);
        for (&row, &slope) in hinge.corners.iter().zip(slopes) {
            add(row, [outer(slope, slopes[corner] * hinge.weight), DMat3::ZERO]);
        }
        let (corners, moment) = energy.hinge_at(shape, place);
        for (wing, own) in Wing::both(corners, moment).iter().zip([[0, 1, 2], [0, 1, 3]]) {
            let Some(column) = own.iter().position(|&k| k == corner) else {
                continue;
            };
            for (row, &k) in own.iter().enumerate() {
                add(hinge.corners[k], wing.block(row, column));
            }
        }
    }
}
