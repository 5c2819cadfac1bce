//! A shape under an energy: where the vertices are, how the cells are turned, what it costs and which way is down.

use glam::{DMat3, DQuat, DVec3};
use rayon::prelude::*;

use super::rims::Rims;
use super::spokes::Spokes;
use crate::operators::CHUNK;
use crate::rotation::fit;
use crate::sums::Field;

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

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "tests")]
mod tests {
    use glam::{DQuat, DVec3};
    use pliant_mesh::{Surface, shapes};

    use super::{Energy, Scratch, Shape};
    use crate::Laplacian;
    use crate::arap::domain::Domain;
    use crate::arap::rims::Rims;
    use crate::arap::spokes::Spokes;

    fn noise(k: usize) -> f64 {
        ((k as f64 * 12.9898).sin() * 43_758.545).fract()
    }

    fn check(surface: &Surface, domain: &Domain, energy: &Energy) {
        let count = domain.vertices.len();
        let size = surface.positions[1].distance(surface.positions[0]);
        let at = |displacements: &[DVec3]| {
            let mut shape = Shape {
                displacements: displacements.to_vec(),
                rotations: vec![DQuat::IDENTITY; domain.cell_count],
                gradient: vec![[0.0; 3]; domain.solved_count],
                energy: 0.0,
            };
            energy.evaluate(&mut shape, &mut Scratch::default());
            shape
        };
        let displacements: Vec<DVec3> = (0..count)
            .map(|v| DVec3::new(noise(3 * v), noise(3 * v + 1), noise(3 * v + 2)) * 0.6 * size)
            .collect();
        let gradient = at(&displacements).gradient;
        let largest = gradient.iter().flatten().fold(0.0, |a: f64, b| a.max(b.abs()));
        for vertex in (0..domain.solved_count).step_by(7) {
            for axis in 0..3 {
                let step = 1e-5 * size;
                let beside = |sign: f64| {
                    let mut moved = displacements.clone();
                    moved[vertex][axis] += sign * step;
                    at(&moved).energy
                };
                let slope = (beside(1.0) - beside(-1.0)) / (2.0 * step);
                let error = (slope - gradient[vertex][axis]).abs();
                assert!(
                    error < 1e-6 * largest,
                    "{vertex} {axis}: {slope} {}",
                    gradient[vertex][axis]
                );
            }
        }
    }

    #[test]
    fn the_gradient_is_that_of_the_energy() {
        for drawn in [shapes::torus(20, 10), shapes::grid(7, 9), shapes::non_manifold_fan(5)] {
            let model = shapes::model(drawn);
            let count = model.surface.positions.len() as u32;
            let order: Vec<u32> = (0..count).rev().filter(|v| v % 3 != 0).collect();
            let domain = Domain::of(&model.surface, &model.topology, &order);
            let stiffness: Vec<f64> = (0..count).map(|v| 1.0 + f64::from(v % 5)).collect();
            let laplacian = Laplacian::of(&model.surface, &model.topology, &stiffness);
            check(
                &model.surface,
                &domain,
                &Energy::Rims(Rims::new(&model.surface, &stiffness, &domain)),
            );
            check(
                &model.surface,
                &domain,
                &Energy::Spokes(Spokes::new(&model.surface, &laplacian, &domain)),
            );
        }
    }
}
