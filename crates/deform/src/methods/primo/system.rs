//! The Gauss–Newton matrix of the prisms' velocities.
//!
//! At f = c + arm + δ a prism's velocity (ω, v) moves the patch by v − [arm + δ]× ω in its own frame; δ has the second
//! moment C. With Q = R_iᵀ R_j a joint of weight w adds to the 6×6 blocks
//!
//! - H_ii: w ((|m|² I − m mᵀ) + (tr C I − C), [m]×; [m]×ᵀ, I),
//! - H_ij: −w ([m_i]×ᵀ Q [m_j]× + E([δ]×ᵀ Q [δ]×), [m_i]× Q; −Q [m_j]×, Q),
//!
//! rows and columns (ω, v). The matrix is positive semidefinite for every pose, because it omits the residual's own
//! curvature.

use std::collections::BTreeMap;

use glam::{DMat3, DVec3};
use rayon::prelude::*;

use super::joints::{Joints, Side};
use super::pose::Pose;
use crate::budget::reserved;
use crate::numerical::rows::CHUNK;
use crate::sparse::factor_error::FactorError;
use crate::sparse::matrix::ScaledMatrix;

/// A 6×6 block by its rows.
pub(crate) type Block = [[f64; 6]; 6];

/// Columns of each prism.
pub(crate) const DOF: usize = 6;

/// One prism's blocks: its own, and those with its solved neighbours, which are listed once each.
struct BlockRow {
    own: Block,
    others: Vec<(u32, Block)>,
}

/// The Gauss–Newton matrix at `pose`, scaled to a unit diagonal.
///
/// # Errors
/// [`FactorError::Memory`].
pub(crate) fn gauss_newton(joints: &Joints, pose: &Pose) -> Result<ScaledMatrix, FactorError> {
    let mut rows: Vec<BlockRow> = reserved(joints.count())?;
    let each = (0..joints.count()).into_par_iter().with_min_len(CHUNK);
    rows.par_extend(each.map(|prism| row(joints, pose, prism)));
    let below =
        |(prism, row): (usize, &BlockRow)| row.others.iter().filter(|(other, _)| *other as usize > prism).count();
    let blocks: usize = rows.iter().enumerate().map(below).sum();
    let entries = rows.len() * DOF * (DOF + 1) / 2 + blocks * DOF * DOF;
    u32::try_from(entries).map_err(|_| FactorError::Memory)?;
    let mut matrix = ScaledMatrix {
        scale: reserved(DOF * rows.len())?,
        lower_offsets: reserved(DOF * rows.len() + 1)?,
        lower_rows: reserved(entries)?,
        lower_values: reserved(entries)?,
    };
    matrix.lower_offsets.push(0);
    for row in &rows {
        let inverse_root = |k: usize| {
            if row.own[k][k] > 0.0 {
                row.own[k][k].sqrt().recip()
            } else {
                1.0
            }
        };
        matrix.scale.extend((0..DOF).map(inverse_root));
    }
    for (prism, row) in rows.iter().enumerate() {
        for k in 0..DOF {
            let first = (DOF * prism) as u32;
            for l in k..DOF {
                matrix.lower_rows.push(first + l as u32);
                matrix.lower_values.push(row.own[l][k]);
            }
            for (other, block) in &row.others {
                if *other as usize > prism {
                    let first = DOF as u32 * other;
                    matrix.lower_rows.extend(first..first + DOF as u32);
                    // H_ji = H_ijᵀ, so its column k is the row k of H_ij.
                    matrix.lower_values.extend_from_slice(&block[k]);
                }
            }
            matrix.lower_offsets.push(matrix.lower_rows.len() as u32);
        }
    }
    matrix.scale_values();
    Ok(matrix)
}

fn row(joints: &Joints, pose: &Pose, prism: usize) -> BlockRow {
    let mut row = BlockRow {
        own: [[0.0; 6]; 6],
        others: Vec::with_capacity(3),
    };
    // This searches a long row.
    let mut places = BTreeMap::new();
    let is_long = joints.sides(prism).len() > 32;
    let turned_back = pose.turns[prism].transpose();
    for side in joints.sides(prism) {
        add(&mut row.own, &own_block(side));
        if (side.other as usize) < joints.count() {
            let block = other_block(side, &(turned_back * pose.turns[side.other as usize]));
            let place = if is_long {
                let end = row.others.len();
                Some(*places.entry(side.other).or_insert(end)).filter(|&place| place < end)
            } else {
                row.others.iter().position(|(other, _)| *other == side.other)
            };
            match place {
                Some(place) => add(&mut row.others[place].1, &block),
                None => row.others.push((side.other, block)),
            }
        }
    }
    row
}

fn add(sum: &mut Block, block: &Block) {
    for (sum, block) in sum.iter_mut().flatten().zip(block.iter().flatten()) {
        *sum += block;
    }
}

/// H_ii.
pub(crate) fn own_block(side: &Side) -> Block {
    let (m, c) = (side.own_arm, side.spread);
    let cross = cross(m);
    let trace = c.x_axis.x + c.y_axis.y + c.z_axis.z;
    let inertia = -(cross * cross) + DMat3::from_diagonal(DVec3::splat(trace)) - c;
    joined(side.weight, inertia, cross, cross.transpose(), DMat3::IDENTITY)
}

/// H_ij.
pub(crate) fn other_block(side: &Side, q: &DMat3) -> Block {
    let (own, other) = (cross(side.own_arm), cross(side.other_arm));
    let turning = own.transpose() * *q * other + spread_turn(&side.spread, q);
    joined(-side.weight, turning, own * *q, -(*q * other), *q)
}

/// E([δ]×ᵀ Q [δ]×) for δ with the second moment `c`.
fn spread_turn(c: &DMat3, q: &DMat3) -> DMat3 {
    let mut sum = DMat3::ZERO;
    for k in 0..3 {
        // [δ]× = Σ δ_k E_k with E_k = [e_k]×, and C = Σ_kl C_kl e_k e_lᵀ.
        let left = cross(DVec3::AXES[k]).transpose() * *q;
        sum += left * cross(c.col(k));
    }
    sum
}

fn joined(weight: f64, turning: DMat3, mixed: DMat3, mixed_below: DMat3, sliding: DMat3) -> Block {
    let mut block = [[0.0; 6]; 6];
    for column in 0..3 {
        for row in 0..3 {
            block[row][column] = weight * turning.col(column)[row];
            block[row][column + 3] = weight * mixed.col(column)[row];
            block[row + 3][column] = weight * mixed_below.col(column)[row];
            block[row + 3][column + 3] = weight * sliding.col(column)[row];
        }
    }
    block
}

/// [m]×.
pub(crate) fn cross(m: DVec3) -> DMat3 {
    DMat3::from_cols(m.cross(DVec3::X), m.cross(DVec3::Y), m.cross(DVec3::Z))
}
