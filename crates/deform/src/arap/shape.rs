//! A shape under an energy: where the vertices are, how the cells are turned, what it costs and which way is down.

use glam::{DMat3, DQuat, DVec3};
use rayon::prelude::*;

use super::rims::Rims;
use super::rotation::fit;
use super::spokes::Spokes;
use super::sums::Field;
use crate::operators::CHUNK;

/// A shape; energy and gradient belong to the displacements once they were evaluated.
#[derive(Clone, Debug, Default)]
pub(crate) struct Shape {
    /// Of each local vertex, in world units.
    pub displacements: Vec<DVec3>,
    /// Of each cell: the best one for the displacements, and a start for the next fit.
    pub rotations: Vec<DQuat>,
    /// dE/dp of each solved vertex.
    pub gradient: Field,
    /// E, in squared world units.
    pub energy: f64,
}

/// Room for an evaluation, kept from one to the next.
#[derive(Debug, Default)]
pub(crate) struct Scratch {
    /// Of each cell.
    pub turns: Vec<DMat3>,
    /// Of each face: its part of its corners' matrices S.
    pub covariances: Vec<DMat3>,
    /// Of each face: dE/de of its two edges.
    pub pulls: Vec<[DVec3; 2]>,
}

/// One of the two discretisations.
#[derive(Debug)]
pub(crate) enum Energy {
    /// Sorkine & Alexa 2007.
    Spokes(Spokes),
    /// Chao et al. 2010.
    Rims(Rims),
}

impl Energy {
    /// The energy of the rest shape's size: what the energy is measured against where it is nearly zero.
    pub fn scale(&self) -> f64 {
        match self {
            Self::Spokes(spokes) => spokes.scale(),
            Self::Rims(rims) => rims.scale(),
        }
    }

    /// Fits the rotations to the displacements, and finds energy and gradient.
    pub fn evaluate(&self, shape: &mut Shape, scratch: &mut Scratch) {
        match self {
            Self::Spokes(spokes) => spokes.evaluate(shape, scratch),
            Self::Rims(rims) => rims.evaluate(shape, scratch),
        }
    }
}

/// The best rotation of each cell for its matrix, started from `rotations`.
pub(crate) fn fit_cells(rotations: &mut [DQuat], turns: &mut Vec<DMat3>, matrix: impl Fn(usize) -> DMat3 + Sync) {
    turns.resize(rotations.len(), DMat3::IDENTITY);
    rotations
        .par_chunks_mut(CHUNK)
        .zip(turns.par_chunks_mut(CHUNK))
        .enumerate()
        .for_each(|(chunk, (rotations, turns))| {
            for (place, (rotation, turn)) in rotations.iter_mut().zip(turns).enumerate() {
                *rotation = fit(&matrix(chunk * CHUNK + place), *rotation);
                *turn = DMat3::from_quat(*rotation);
            }
        });
}
