//! An approximate inverse of the Gauss–Newton matrix: a factorisation for few prisms, cells of prisms for many.
//!
//! A cell moves its prisms as one rigid body, so that cells are coupled by the same joints as prisms, and so are cells
//! of cells. One cycle relaxes the fine bodies (each to its own minimum, one colour after the other), solves the
//! remainder on the cells, and relaxes again in the opposite order, which makes it a symmetric positive definite
//! preconditioner. The minimum is that of the full resolution, reached sooner.

use glam::{DMat3, DVec3};
use pliant_mesh::Cancel;
use rayon::prelude::*;

use super::colours::Colours;
use super::factored::Factored;
use super::joints::Joints;
use super::pose::Pose;
use super::system::{Block, own_block};
use crate::budget::Budget;
use crate::numerical::rows::CHUNK;
use crate::sparse::factor_error::FactorError;
use crate::sparse::ordering::graph::elimination;

/// Up to this many bodies are solved directly.
pub(crate) const DIRECT: usize = 16_000;

/// The number of bodies in a cell.
const CELL: usize = 8;

/// The factor on a cell's motion: rigid cells bend only at their borders and so resist too much.
const OVERCORRECTION: f64 = 1.4;

/// Velocity or force of a body: (ω, v) or (torque, force).
pub(crate) type Wrench = [f64; 6];

/// H⁻¹ at rest, approximately.
#[derive(Debug)]
pub(crate) enum Preconditioner {
    Direct(Box<Factored>),
    Cells(Box<Cells>),
}

/// One level and those below it.
#[derive(Debug)]
pub(crate) struct Cells {
    cell_of: Vec<u32>,
    /// The vector from the cell's centre to the body's.
    arms: Vec<DVec3>,
    /// H_ii⁻¹.
    inverses: Vec<Block>,
    colours: Colours,
    coarse: Joints,
    below: Preconditioner,
}

impl Preconditioner {
    /// The hierarchy for the bodies of `joints` at rest; up to `direct` bodies the matrix is factored.
    ///
    /// # Errors
    /// Those of [`Factored::at`]; a pivot is named by one of its prisms.
    pub fn of(joints: &Joints, direct: usize, budget: Budget, cancel: &Cancel) -> Result<Self, FactorError> {
        if joints.count() <= direct {
            let at_rest = Pose::at_rest(joints.count(), joints.centres.len() - joints.count());
            return Ok(Self::Direct(Box::new(Factored::at(joints, &at_rest, budget, cancel)?)));
        }
        let mut cell_of = cells(joints);
        let mut coarse = joints.of_cells(&cell_of);
        if coarse.count() <= direct {
            let (offsets, neighbours) = coarse.graph();
            let mut rank = vec![0; coarse.count()];
            let elimination = elimination(&offsets, &neighbours, cancel).map_err(|_| FactorError::Cancelled)?;
            for (place, &cell) in elimination.order.iter().enumerate() {
                rank[cell as usize] = place as u32;
            }
            for cell in &mut cell_of {
                *cell = rank[*cell as usize];
            }
            coarse = joints.of_cells(&cell_of);
            coarse.block_ends = elimination.ends;
        }
        let below = Self::of(&coarse, direct, budget, cancel).map_err(|error| match error {
            FactorError::Pivot(cell) => {
                FactorError::Pivot(cell_of.iter().position(|&own| own as usize == cell).unwrap_or_default())
            }
            other => other,
        })?;
        let arm = |(body, &cell): (usize, &u32)| joints.centres[body] - coarse.centres[cell as usize];
        Ok(Self::Cells(Box::new(Cells {
            arms: cell_of.iter().enumerate().map(arm).collect(),
            cell_of,
            inverses: (0..joints.count())
                .into_par_iter()
                .map(|body| inverse_block(joints, body))
                .collect(),
            colours: Colours::of(joints),
            coarse,
            below,
        })))
    }

    /// The number of stored entries.
    pub fn stored(&self) -> usize {
        match self {
            Self::Direct(factored) => factored.stored(),
            Self::Cells(cells) => 36 * cells.inverses.len() + cells.below.stored(),
        }
    }

    /// x ← (H⁻¹)_ωω x, approximately: the angular velocities for torques without forces.
    pub fn apply(&self, joints: &Joints, x: &mut [[f64; 3]]) {
        let mut wrenches: Vec<Wrench> = x.iter().map(|x| [x[0], x[1], x[2], 0.0, 0.0, 0.0]).collect();
        self.solve(joints, &mut wrenches);
        for (x, w) in x.iter_mut().zip(wrenches) {
            x.copy_from_slice(&w[..3]);
        }
    }

    fn solve(&self, joints: &Joints, b: &mut Vec<Wrench>) {
        match self {
            Self::Direct(factored) => factored.solve(b),
            Self::Cells(cells) => *b = cells.cycle(joints, b),
        }
    }
}

impl Cells {
    fn cycle(&self, joints: &Joints, b: &[Wrench]) -> Vec<Wrench> {
        let mut x = vec![[0.0; 6]; b.len()];
        for class in self.colours.classes() {
            self.relax(joints, class, b, &mut x);
        }
        let residual: Vec<Wrench> = (0..b.len())
            .into_par_iter()
            .with_min_len(CHUNK)
            .map(|body| residual(joints, body, b, &x))
            .collect();
        let mut gathered = vec![[0.0; 6]; self.coarse.count()];
        for ((r, &cell), &arm) in residual.iter().zip(&self.cell_of).zip(&self.arms) {
            let (torque, force) = halves(r);
            let moved = joined(torque + arm.cross(force), force);
            for (sum, value) in gathered[cell as usize].iter_mut().zip(moved) {
                *sum += value;
            }
        }
        self.below.solve(&self.coarse, &mut gathered);
        x.par_iter_mut()
            .zip(&self.cell_of)
            .zip(&self.arms)
            .with_min_len(CHUNK)
            .for_each(|((x, &cell), &arm)| {
                let (turn, slide) = halves(&gathered[cell as usize]);
                let own = joined(turn, slide + turn.cross(arm));
                for (x, value) in x.iter_mut().zip(own) {
                    *x += OVERCORRECTION * value;
                }
            });
        for class in self.colours.classes().iter().rev() {
            self.relax(joints, class, b, &mut x);
        }
        x
    }

    /// Moves each body of a colour to the minimum of its own part of the energy.
    fn relax(&self, joints: &Joints, class: &[u32], b: &[Wrench], x: &mut [Wrench]) {
        let steps: Vec<Wrench> = class
            .par_iter()
            .with_min_len(CHUNK)
            .map(|&body| {
                let left = residual(joints, body as usize, b, x);
                self.inverses[body as usize].map(|row| row.iter().zip(left).map(|(a, b)| a * b).sum())
            })
            .collect();
        for (&body, step) in class.iter().zip(steps) {
            for (x, step) in x[body as usize].iter_mut().zip(step) {
                *x += step;
            }
        }
    }
}

fn halves(wrench: &Wrench) -> (DVec3, DVec3) {
    (DVec3::from_slice(&wrench[..3]), DVec3::from_slice(&wrench[3..]))
}

fn joined(first: DVec3, second: DVec3) -> Wrench {
    [first.x, first.y, first.z, second.x, second.y, second.z]
}

/// b − H x at rest, for one body.
fn residual(joints: &Joints, body: usize, b: &[Wrench], x: &[Wrench]) -> Wrench {
    let (mut torque, mut force) = halves(&b[body]);
    let (turn, slide) = halves(&x[body]);
    for side in joints.sides(body) {
        let mut apart = slide + turn.cross(side.own_arm);
        let mut bent = turn;
        if let Some(other) = x.get(side.other as usize) {
            let (other_turn, other_slide) = halves(other);
            apart -= other_slide + other_turn.cross(side.other_arm);
            bent -= other_turn;
        }
        let c = side.spread;
        let trace = c.x_axis.x + c.y_axis.y + c.z_axis.z;
        force -= apart * side.weight;
        torque -= (side.own_arm.cross(apart) + bent * trace - c * bent) * side.weight;
    }
    joined(torque, force)
}

/// H_ii⁻¹; directions without stiffness stay unchanged.
fn inverse_block(joints: &Joints, body: usize) -> Block {
    let mut sum = [[0.0; 6]; 6];
    for side in joints.sides(body) {
        for (sum, block) in sum.iter_mut().flatten().zip(own_block(side).iter().flatten()) {
            *sum += block;
        }
    }
    let part = |row: usize, column: usize| {
        DMat3::from_cols_array_2d(&std::array::from_fn(|c| {
            std::array::from_fn(|r| sum[row + r][column + c])
        }))
    };
    // The blocks are turning A, mixed B, and sliding D = d I.
    let (a, b, d) = (part(0, 0), part(0, 3), sum[3][3]);
    let mut inverse = [[0.0; 6]; 6];
    if d <= 0.0 {
        return inverse;
    }
    let schur = a - b * b.transpose() * d.recip();
    let turning = schur.inverse();
    if !turning.is_finite() {
        for (k, row) in inverse.iter_mut().enumerate().skip(3) {
            row[k] = d.recip();
        }
        return inverse;
    }
    let mixed = turning * b * -d.recip();
    let sliding = DMat3::from_diagonal(DVec3::splat(d.recip())) + b.transpose() * turning * b * (d * d).recip();
    for row in 0..3 {
        for column in 0..3 {
            inverse[row][column] = turning.col(column)[row];
            inverse[row][column + 3] = mixed.col(column)[row];
            inverse[column + 3][row] = mixed.col(column)[row];
            inverse[row + 3][column + 3] = sliding.col(column)[row];
        }
    }
    inverse
}

/// The cell of each body. Cells grow breadth-first from the unassigned body with the lowest number; bodies left over
/// between cells join one of them.
fn cells(joints: &Joints) -> Vec<u32> {
    const NONE: u32 = u32::MAX;
    let count = joints.count();
    let mut cell_of = vec![NONE; count];
    let mut cell_count = 0;
    for &seed in joints.walk() {
        if cell_of[seed as usize] != NONE {
            continue;
        }
        let mut members = vec![seed];
        cell_of[seed as usize] = cell_count;
        let mut next = 0;
        while next < members.len() && members.len() < CELL {
            for side in joints.sides(members[next] as usize) {
                let other = side.other as usize;
                if other < count && cell_of[other] == NONE && members.len() < CELL {
                    cell_of[other] = cell_count;
                    members.push(side.other);
                }
            }
            next += 1;
        }
        let mut beside = joints.sides(seed as usize).iter().map(|side| side.other as usize);
        let neighbour = beside.find(|&other| other < count && cell_of[other] != cell_count);
        match neighbour {
            Some(other) if members.len() <= CELL / 3 => {
                let cell = cell_of[other];
                for member in members {
                    cell_of[member as usize] = cell;
                }
            }
            _ => cell_count += 1,
        }
    }
    cell_of
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "tests")]
mod tests {
    use pliant_mesh::{Cancel, shapes};

    use super::super::joints::Joints;
    use super::super::pose::tests::{joints_of, noise};
    use super::{Preconditioner, Wrench, residual};
    use crate::Budget;

    fn random(count: usize, seed: usize) -> Vec<Wrench> {
        let value = |body: usize, k: usize| noise(6 * body + k + 1000 * seed);
        (0..count).map(|body| std::array::from_fn(|k| value(body, k))).collect()
    }

    fn dot(a: &[Wrench], b: &[Wrench]) -> f64 {
        a.iter().flatten().zip(b.iter().flatten()).map(|(a, b)| a * b).sum()
    }

    /// H x.
    fn product(joints: &Joints, x: &[Wrench]) -> Vec<Wrench> {
        let zeros = vec![[0.0; 6]; x.len()];
        (0..x.len())
            .map(|body| residual(joints, body, &zeros, x).map(|value| -value))
            .collect()
    }

    fn solved(preconditioner: &Preconditioner, joints: &Joints, b: &[Wrench]) -> Vec<Wrench> {
        let mut x = b.to_vec();
        preconditioner.solve(joints, &mut x);
        x
    }

    #[test]
    fn the_direct_inverse_undoes_the_product() {
        let joints = joints_of(shapes::torus(30, 20));
        let direct = Preconditioner::of(&joints, usize::MAX, Budget::default(), &Cancel::new()).unwrap();
        let x = random(joints.count(), 1);
        let back = solved(&direct, &joints, &product(&joints, &x));
        let error = back
            .iter()
            .flatten()
            .zip(x.iter().flatten())
            .map(|(a, b)| (a - b).abs());
        assert!(error.fold(0.0, f64::max) < 1e-6);
    }

    #[test]
    fn a_cycle_is_symmetric_and_positive_and_brings_every_error_down() {
        // Two levels, and three.
        for direct in [400, 50] {
            let joints = joints_of(shapes::torus(60, 30));
            let cells = Preconditioner::of(&joints, direct, Budget::default(), &Cancel::new()).unwrap();
            assert!(matches!(cells, Preconditioner::Cells(_)));
            let (a, b) = (random(joints.count(), 1), random(joints.count(), 2));
            let (ca, cb) = (solved(&cells, &joints, &a), solved(&cells, &joints, &b));
            assert!((dot(&a, &cb) - dot(&b, &ca)).abs() < 1e-9 * dot(&a, &ca));
            assert!(dot(&a, &ca) > 0.0 && dot(&b, &cb) > 0.0);
            // After some rounds only the most persistent error is left.
            let mut error = random(joints.count(), 3);
            let mut rate = 0.0;
            for _ in 0..30 {
                let before = dot(&error, &product(&joints, &error));
                let step = solved(&cells, &joints, &product(&joints, &error));
                for (e, s) in error.iter_mut().flatten().zip(step.iter().flatten()) {
                    *e -= s;
                }
                rate = (dot(&error, &product(&joints, &error)) / before).sqrt();
            }
            assert!(rate < 0.9, "{direct}: {rate}");
        }
    }
}
