//! The transformation of each vertex' rest frame, T = R S.
//!
//! R is a rotation, which is solved for; S is the handles' blended stretch, which is constant.

use glam::{DMat3, DQuat, DVec3};
use rayon::prelude::*;

use crate::handles::polar::Polar;
use crate::numerical::rotation::fit;
use crate::numerical::rows::CHUNK;
use crate::operators::gradients::Gradients;

/// A vertex' transformation.
#[derive(Clone, Copy, Debug)]
pub(super) struct Frame {
    pub rotation: DQuat,
    /// S − I.
    pub stretch: DMat3,
    /// T − I: zero to the last bit where nothing turns or stretches.
    pub change: DMat3,
}

impl Default for Frame {
    fn default() -> Self {
        Self {
            rotation: DQuat::IDENTITY,
            stretch: DMat3::ZERO,
            change: DMat3::ZERO,
        }
    }
}

impl Frame {
    fn of(rotation: DQuat, stretch: DMat3) -> Self {
        let turned = DMat3::from_quat(rotation);
        Self {
            rotation,
            stretch,
            change: (turned - DMat3::IDENTITY) + turned * stretch,
        }
    }
}

/// A handle's rotation and stretch.
#[derive(Clone, Copy, Debug)]
pub(super) struct HandleFrame {
    rotation: DQuat,
    /// R − I.
    turn: DMat3,
    stretch: DMat3,
}

impl HandleFrame {
    /// The rotation and stretch of a handle's linear map.
    pub fn of(polar: &Polar) -> Self {
        let rotation = DQuat::from_scaled_axis(polar.turn_rad);
        Self {
            rotation: if rotation.w < 0.0 { -rotation } else { rotation },
            turn: DMat3::from_quat(rotation) - DMat3::IDENTITY,
            stretch: polar.stretch,
        }
    }
}

/// Returns the linear solution: the handles' transformations blended by the weights, one row a frame, with R made a
/// rotation again.
pub(super) fn blend(handles: &[HandleFrame], weights: &[f64], frames: &mut [Frame]) {
    frames
        .par_iter_mut()
        .zip(weights.par_chunks_exact(handles.len()))
        .with_min_len(CHUNK)
        .for_each(|(frame, weights)| {
            let (mut turn, mut stretch) = (DMat3::ZERO, DMat3::ZERO);
            let mut guess = DQuat::from_xyzw(0.0, 0.0, 0.0, 1.0 - weights.iter().sum::<f64>());
            for (handle, &weight) in handles.iter().zip(weights) {
                turn += handle.turn * weight;
                stretch += handle.stretch * weight;
                guess += handle.rotation * weight;
            }
            if turn == DMat3::ZERO && stretch == DMat3::ZERO {
                *frame = Frame::default();
                return;
            }
            let guess = if guess.length_squared() > 1e-6 {
                guess.normalize()
            } else {
                DQuat::IDENTITY
            };
            *frame = Frame::of(fit(&(turn + DMat3::IDENTITY), guess), stretch);
        });
}

/// Fits rotations to a field of displacements of the solved vertices `columns`: each minimises Σ w |e' − R S e|² over
/// the edges of the faces around it. `covariances` is scratch memory for the faces.
pub(super) fn fit_to(
    gradients: &Gradients,
    columns: &[u32],
    field: &[[f64; 3]],
    covariances: &mut Vec<DMat3>,
    frames: &mut [Frame],
) {
    let faces = gradients.faces();
    covariances.resize(faces.len(), DMat3::ZERO);
    covariances
        .par_iter_mut()
        .zip(faces)
        .with_min_len(CHUNK)
        .for_each(|(own, face)| *own = face.covariance(field));
    let fitted: Vec<Frame> = columns
        .par_iter()
        .with_min_len(CHUNK)
        .enumerate()
        .map(|(column, &local)| {
            let Frame { rotation, stretch, .. } = frames[local as usize];
            let sum: DMat3 = gradients.around(column).map(|face| covariances[face]).sum();
            let stretched = DMat3::from_diagonal(DVec3::ONE) + stretch;
            Frame::of(fit(&(sum * stretched.transpose()), rotation), stretch)
        })
        .collect();
    for (&local, frame) in columns.iter().zip(fitted) {
        frames[local as usize] = frame;
    }
}
