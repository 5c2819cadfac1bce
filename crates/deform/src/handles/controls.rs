//! Control points that handles drive and that a person moves by hand: their rest positions and present positions.
//!
//! The hand's displacements H are applied to the control points unchanged. With d(p) = Σ_i λ_i(p) D_i the handles then
//! solve for the rest: to the displacements that they require without the hand the method adds the smallest correction
//! C that removes the hand's share at the handles, min Σ_handles w |Σ λ_i (H_i + C_i)|² + Σ_fixed w |Σ λ_i C_i|² + ε
//! |C|². So handles are met as well as without the hand, fixed vertices stay, and without handles every point is where
//! the hand has put it.

use std::sync::Arc;

use faer::Mat;
use glam::{DMat3, DVec3};

use crate::attachment::Attachment;
use crate::handles::Motion;
use crate::numerical::dense::Lu;

/// The control points of a bound method.
#[derive(Debug)]
pub(crate) struct Controls {
    /// Their rest shape, and the positions to which the hand has moved them.
    pub attachment: Attachment,
    /// Their rest positions, in world units.
    pub rest: Vec<DVec3>,
    /// Row-major: the coefficients of one control point and handle, as in [`crate::HandleBases`].
    pub driven: Vec<[f64; 4]>,
    /// The hand's effect, if the attachment was brought.
    pub hand: Option<Hand>,
}

/// The hand's effect on control points.
#[derive(Debug)]
pub(crate) struct Hand {
    correction: Option<Correction>,
    /// H.
    displacements: Vec<DVec3>,
    /// H + C.
    corrected: Vec<DVec3>,
}

/// The map from H to C.
#[derive(Debug)]
struct Correction {
    matrix: Lu,
    /// Σ_handles w λ λᵀ.
    pull: Mat<f64>,
}

/// A point at which the hand's share is measured.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Hold {
    pub weight: f64,
    pub by: Holder,
}

/// Its holder.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum Holder {
    Handle,
    Fixed,
}

/// ε.
const LEAST: f64 = 1e-8;

impl Controls {
    /// The positions of the points for these motions of the handles.
    pub fn positions(&self, motions: &[Motion]) -> Vec<DVec3> {
        let rest = self.rest.iter().enumerate();
        let positions = rest.map(|(point, rest)| *rest + self.driven(point, motions) + self.by_hand(point));
        positions.collect()
    }

    /// The displacement of a control point by the handles.
    pub fn driven(&self, point: usize, motions: &[Motion]) -> DVec3 {
        let own = &self.driven[point * motions.len()..][..motions.len()];
        let terms = own.iter().zip(motions).map(|(coefficients, motion)| {
            let DMat3 { x_axis, y_axis, z_axis } = motion.linear;
            let columns = [x_axis, y_axis, z_axis, motion.shift];
            columns
                .iter()
                .zip(coefficients)
                .map(|(column, c)| *column * *c)
                .sum::<DVec3>()
        });
        terms.sum()
    }

    /// Sets the positions to which the hand has moved the points: one for each.
    pub fn move_to(&mut self, moved: Arc<Vec<DVec3>>) {
        if let Some(hand) = &mut self.hand {
            let displacements = self.rest.iter().zip(moved.iter()).map(|(rest, moved)| *moved - *rest);
            hand.displacements = displacements.collect();
            hand.corrected = hand.corrected();
        }
        self.attachment = self.attachment.with_moved(moved);
    }

    /// Returns true if the hand has moved a point.
    pub fn are_moved(&self) -> bool {
        let moves = |hand: &Hand| {
            hand.displacements
                .iter()
                .any(|displacement| *displacement != DVec3::ZERO)
        };
        self.hand.as_ref().is_some_and(moves)
    }

    /// H, if the hand has moved a point.
    pub fn displacements(&self) -> Option<&[DVec3]> {
        let hand = self.hand.as_ref().filter(|_| self.are_moved());
        hand.map(|hand| &*hand.displacements)
    }

    /// H + C, if the hand has moved a point.
    pub fn corrected(&self) -> Option<&[DVec3]> {
        let hand = self.hand.as_ref().filter(|_| self.are_moved());
        hand.map(|hand| &*hand.corrected)
    }

    fn by_hand(&self, point: usize) -> DVec3 {
        let hand = self.hand.as_ref();
        hand.and_then(|hand| hand.corrected.get(point).copied())
            .unwrap_or_default()
    }
}

impl Hand {
    /// The effect for this many control points; `weights` visits those with a weight at a hold, by its number.
    pub fn new(count: usize, holds: &[Hold], weights: impl Fn(usize, &mut dyn FnMut(usize, f64))) -> Self {
        Self {
            correction: Correction::new(count, holds, weights),
            displacements: Vec::new(),
            corrected: Vec::new(),
        }
    }

    fn corrected(&self) -> Vec<DVec3> {
        let Some(Correction { matrix, pull }) = &self.correction else {
            return self.displacements.clone();
        };
        let count = self.displacements.len();
        let pulled = |row: usize| {
            let terms = self.displacements.iter().enumerate();
            terms.map(|(column, own)| *own * pull[(row, column)]).sum::<DVec3>()
        };
        let pulled: Vec<DVec3> = (0..count).map(pulled).collect();
        let correction = matrix.solved(Mat::from_fn(count, 3, |row, axis| pulled[row][axis]));
        let own = self.displacements.iter().enumerate();
        own.map(|(row, own)| *own - DVec3::from_array([0, 1, 2].map(|axis| correction[(row, axis)])))
            .collect()
    }
}

impl Correction {
    /// `None` without handles.
    fn new(count: usize, holds: &[Hold], weights: impl Fn(usize, &mut dyn FnMut(usize, f64))) -> Option<Self> {
        holds.iter().find(|hold| hold.by == Holder::Handle)?;
        let mut matrix = Mat::<f64>::zeros(count, count);
        let mut pull = Mat::<f64>::zeros(count, count);
        let mut near: Vec<(usize, f64)> = Vec::new();
        for (number, hold) in holds.iter().enumerate() {
            near.clear();
            weights(number, &mut |control, weight| near.push((control, weight)));
            let into = match hold.by {
                Holder::Handle => &mut pull,
                Holder::Fixed => &mut matrix,
            };
            for &(column, b) in &near {
                for &(row, a) in &near {
                    into[(row, column)] += hold.weight * a * b;
                }
            }
        }
        for column in 0..count {
            for row in 0..count {
                matrix[(row, column)] += pull[(row, column)];
            }
            matrix[(column, column)] += LEAST;
        }
        Some(Self {
            matrix: Lu::of(matrix),
            pull,
        })
    }
}

/// Bytes of the hand's data for this many control points: the factored matrix and the handles' pull.
pub(crate) fn hand_bytes(count: usize) -> u64 {
    16 * (count as u64) * (count as u64 + 64)
}
