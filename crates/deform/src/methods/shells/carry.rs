//! Carries the motion of a coarse level over to the surface: deformation transfer [SP04] on the unfolded energy.
//!
//! Each edge and each hinge of a base shape is turned by the mean M of its ends' turns. The positions x that fit them
//! best minimise
//!
//! ½ Σ_e w_e |x_b − x_a − M (b_b − b_a)|² + ½ Σ_h w_h |Σ f_i x_i − M Σ f_i b_i|²,
//!
//! with the weights of the edges and hinges and the linear angle's factors f. The gradient at a first guess, solved
//! with the unfolded energy's factor, is the error of the guess.

use glam::{DMat3, DQuat, DVec3};
use rayon::prelude::*;

use super::blended::Turns;
use super::hinge::flat;
use super::shape::{Energy, Shape};
use crate::numerical::rows::CHUNK;
use crate::numerical::sums::Field;

/// The tables of the transfer, kept between frames.
#[derive(Debug)]
pub(super) struct Carrier {
    /// f of each hinge. **f32**: they only determine a direction.
    factors: Vec<[f32; 4]>,
    edges: Vec<DVec3>,
    hinges: Vec<DVec3>,
}

/// The shape whose edges and hinges are turned.
pub(super) struct Base<'a> {
    /// The positions of the local vertices.
    pub places: &'a [DVec3],
    /// The turn of each local vertex' surroundings.
    pub turns: &'a [DMat3],
    /// The strains that examples give the base before it turns: the turns back to rest, and the weights.
    pub strains: Option<Strains<'a>>,
}

/// The strains that examples add to a base, which is the rest shape.
pub(super) struct Strains<'a> {
    displacements: &'a [Vec<DVec3>],
    back: Vec<DQuat>,
    weights: &'a [f64],
}

impl<'a> Strains<'a> {
    /// The strains with these weights.
    pub fn of(energy: &'a Energy, turns: &Turns, weights: &'a [f64]) -> Self {
        Self {
            displacements: &energy.examples.displacements,
            back: turns.back(),
            weights,
        }
    }
}

impl Base<'_> {
    /// Turns a linear function of the positions near an edge from a to b by the mean of the turns of its ends.
    fn turned(&self, [a, b]: [u32; 2], function: impl Fn(&dyn Fn(u32) -> DVec3) -> DVec3) -> DVec3 {
        let base = function(&|local| self.places[local as usize]);
        let turn = |end: u32| self.turns[end as usize];
        let Some(strains) = &self.strains else {
            return (turn(a) + turn(b)) * 0.5 * base;
        };
        let strained = |end: u32| {
            let mut sum = base;
            let back = &strains.back[end as usize * strains.weights.len()..];
            for ((own, back), &weight) in strains.displacements.iter().zip(back).zip(strains.weights) {
                let example = function(&|local| self.places[local as usize] + own[local as usize]);
                sum += (*back * example - base) * weight;
            }
            turn(end) * sum
        };
        (strained(a) + strained(b)) * 0.5
    }
}

impl Carrier {
    /// Computes the factors of these elements' hinges.
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

    /// The gradient at `shape`, for the base and its turns.
    pub fn pull(&mut self, energy: &Energy, base: &Base, shape: &Shape) -> Field {
        let elements = &energy.elements;
        let at = |local: u32| elements.rest[local as usize] + shape.displacements[local as usize];
        let Self { factors, edges, hinges } = self;
        elements
            .edges
            .par_iter()
            .with_min_len(CHUNK)
            .map(|edge| {
                let [a, b] = edge.ends;
                let turned = base.turned(edge.ends, |place| place(b) - place(a));
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
                let sum = |place: &dyn Fn(u32) -> DVec3| {
                    // Differences from a corner keep the rounding errors of the factors small.
                    let origin = place(a);
                    let each = hinge.corners.iter().zip(factors);
                    each.map(|(&corner, &factor)| (place(corner) - origin) * f64::from(factor))
                        .sum::<DVec3>()
                };
                (sum(&at) - base.turned([a, b], sum)) * hinge.weight
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
        energy
            .springs
            .add_gradient(|vertex| shape.displacements[vertex], &mut pull);
        pull
    }
}
