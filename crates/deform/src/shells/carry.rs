//! Carries what a coarse level does over to the surface: deformation transfer [SP04] on the unfolded energy.
//!
//! Each edge and each hinge of a base shape is turned by the mean M of its ends' turns, and the positions x are sought
//! that fit them best,
//!
//! ½ Σ_e w_e |x_b − x_a − M (b_b − b_a)|² + ½ Σ_h w_h |Σ f_i x_i − M Σ f_i b_i|²,
//!
//! with the weights of the edges and hinges and the linear angle's factors f. The gradient at a first guess, solved with
//! the unfolded energy's factor, is what the guess misses.

use glam::{DMat3, DVec3};
use rayon::prelude::*;

use super::hinge::flat;
use super::shape::{Energy, Shape};
use crate::numerical::sums::Field;
use crate::operators::CHUNK;

/// What is kept for it.
#[derive(Debug)]
pub(super) struct Carrier {
    /// f of each hinge. **f32**: they only make a direction.
    factors: Vec<[f32; 4]>,
    edges: Vec<DVec3>,
    hinges: Vec<DVec3>,
}

impl Carrier {
    /// For these elements.
    pub fn of(energy: &Energy) -> Self {
        let elements = &energy.elements;
        let factors = elements.hinges.par_iter().with_min_len(CHUNK).map(|hinge| {
            let factors = flat(hinge.corners.map(|corner| elements.rest[corner as usize]));
            factors.map(|factor| factor as f32)
        });
        Self {
            factors: factors.collect(),
            edges: Vec::new(),
            hinges: Vec::new(),
        }
    }

    /// The gradient at `shape`, for the base positions and the turns of all local vertices.
    pub fn pull(&mut self, energy: &Energy, base: &[DVec3], shape: &Shape, turns: &[DMat3]) -> Field {
        let elements = &energy.elements;
        let at = |local: u32| elements.rest[local as usize] + shape.displacements[local as usize];
        let turn = |a: u32, b: u32| (turns[a as usize] + turns[b as usize]) * 0.5;
        let Self { factors, edges, hinges } = self;
        elements
            .edges
            .par_iter()
            .with_min_len(CHUNK)
            .map(|edge| {
                let [a, b] = edge.ends;
                let turned = turn(a, b) * (base[b as usize] - base[a as usize]);
                (at(b) - at(a) - turned) * edge.weight
            })
            .collect_into_vec(edges);
        elements
            .hinges
            .par_iter()
            .zip(&*factors)
            .with_min_len(CHUNK)
            .map(|(hinge, factors)| {
                let [a, b, ..] = hinge.corners;
                let sum = |place: &dyn Fn(u32) -> DVec3| -> DVec3 {
                    // From a corner, so that rounding in the factors has little to multiply.
                    let origin = place(a);
                    let each = hinge.corners.iter().zip(factors);
                    each.map(|(&corner, &factor)| (place(corner) - origin) * f64::from(factor))
                        .sum()
                };
                let before = sum(&|corner| base[corner as usize]);
                (sum(&at) - turn(a, b) * before) * hinge.weight
            })
            .collect_into_vec(hinges);
        let mut pull: Field = (0..elements.solved_count)
            .into_par_iter()
            .with_min_len(CHUNK)
            .map(|vertex| {
                let mut sum = DVec3::ZERO;
                for &entry in energy.edges_at(vertex) {
                    let pull = edges[entry as usize / 2];
                    sum += if entry % 2 == 0 { -pull } else { pull };
                }
                for &entry in energy.hinges_at(vertex) {
                    let (place, corner) = (entry as usize / 4, entry as usize % 4);
                    sum += hinges[place] * f64::from(factors[place][corner]);
                }
                sum.to_array()
            })
            .collect();
        energy.springs.add_gradient(&shape.displacements, &mut pull);
        pull
    }
}
