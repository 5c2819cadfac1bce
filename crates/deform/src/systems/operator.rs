//! The bi-Laplacian's operator A = k_s (−L) + k_b (−L)(−M⁻¹ L)ⁿ⁻¹, applied by differences along edges.
//!
//! One factor −L is outermost in both terms, so A d = −L φ with φ = k_s d + k_b (−M⁻¹ L)ⁿ⁻¹ d: zero on constants to the
//! last bit at every order.
//!
//! Painted stiffness s scales the density of the energy, ½ ∫ k_s s |∇d|² + k_b s |Δd|²: the faces' cotangents in
//! stretching and in the middle L of order 3, the cells of M⁻¹ at order 2, with the natural term where it varies
//! ([`crate::systems::natural`]). A stiff part keeps its curvature, turns with its surroundings, and joins soft
//! parts without a crease. (If the cotangents of both outer L were scaled, which is ∫ |div(s ∇d)|², stiff parts would
//! keep their slope in space: they would not turn, and crease at their rim.)

use std::borrow::Cow;

use rayon::prelude::*;

use crate::Laplacian;
use crate::numerical::rows::CHUNK;
use crate::sparse::ordering::hubs::hub_degree;
use crate::systems::natural::NaturalTerm;
use crate::systems::plate_energy::PlateEnergy;
use crate::systems::springs::Springs;

/// The functions that L is applied to last: φ, and d itself if stretching has its own L.
#[derive(Debug)]
pub(crate) struct Potential<'a, const K: usize> {
    phi: Cow<'a, [[f64; K]]>,
    d: &'a [[f64; K]],
    /// The natural term's part; empty without one.
    stress: Vec<[[f64; K]; 2]>,
}

/// A over the local vertices of its Laplacian, which has full rows around everything that moves.
///
/// A *field* has one entry per local vertex, then one per spring: the target of the spring's vertex.
#[derive(Debug)]
pub(crate) struct BilaplacianOperator {
    pub laplacian: Laplacian,
    /// The L between two others at order 3, if it differs.
    pub middle: Option<Laplacian>,
    /// The L of stretching, if it differs.
    pub stretched: Option<Laplacian>,
    /// s of each local vertex' cell at order 2; empty if it is 1 everywhere.
    pub cell_stiffness: Vec<f64>,
    /// The natural boundaries at order 2.
    pub natural: Option<NaturalTerm>,
    /// The soft handles' springs, W in (A + W) d = W c.
    pub springs: Springs,
    /// A vertex with more solved neighbours than this is a hub: see [`crate::systems::hubs`].
    pub hub_degree: usize,
    /// n: the number of factors L in the second term.
    pub power: u32,
    /// k_s over the squared diagonal.
    pub stretching: f64,
    /// k_b times the diagonal to the power 2 (n − 2).
    pub bending: f64,
}

impl<'a, const K: usize> Potential<'a, K> {
    /// The potential of order 1.
    fn of(d: &'a [[f64; K]]) -> Self {
        Self {
            phi: d.into(),
            d,
            stress: Vec::new(),
        }
    }
}

impl BilaplacianOperator {
    /// The operator of an energy for a surface of this diagonal.
    pub fn new(laplacian: Laplacian, energy: PlateEnergy, diagonal: f64) -> Self {
        let square = if diagonal > 0.0 { diagonal * diagonal } else { 1.0 };
        let bending = match energy.power {
            1 => energy.bending / square,
            2 => energy.bending,
            _ => energy.bending * square,
        };
        Self {
            hub_degree: hub_degree(laplacian.vertices().len()),
            laplacian,
            middle: None,
            stretched: None,
            cell_stiffness: Vec::new(),
            natural: None,
            springs: Springs::default(),
            power: energy.power,
            stretching: energy.stretching / square,
            bending,
        }
    }

    /// −L alone: a membrane of stiffness 1, without springs.
    pub fn membrane(laplacian: Laplacian) -> Self {
        Self::new(laplacian, PlateEnergy::of_power(1), 1.0)
    }

    /// The number of entries of a field.
    pub fn field_len(&self) -> usize {
        self.laplacian.vertices().len() + self.springs.len()
    }

    /// The local vertex of a field's entry.
    pub fn local_of(&self, place: usize) -> u32 {
        match place.checked_sub(self.laplacian.vertices().len()) {
            Some(spring) => self.springs.local(spring),
            None => place as u32,
        }
    }

    /// Attaches springs of a weight to a handle's local vertices (see [`crate::Constraints`]); returns their places in
    /// a field.
    pub fn soften(&mut self, locals: &[u32], weight: f64) -> Vec<u32> {
        let area = |local: u32| self.laplacian.inverse_areas()[local as usize].recip();
        let square_wave_number = std::f64::consts::PI.powi(2) / locals.iter().map(|&local| area(local)).sum::<f64>();
        let resistance =
            self.stretching * square_wave_number + self.bending * square_wave_number.powi(self.power as i32);
        let strengths: Vec<f64> = locals.iter().map(|&local| weight * resistance * area(local)).collect();
        self.hang(locals, &strengths)
    }

    /// Attaches springs of these strengths to local vertices; returns their places in a field.
    pub fn hang(&mut self, locals: &[u32], strengths: &[f64]) -> Vec<u32> {
        let first = self.field_len() as u32;
        self.springs.add(self.laplacian.vertices().len(), locals, strengths);
        (first..self.field_len() as u32).collect()
    }

    /// The force of a spring on its vertex: W_i (c_i − d_i).
    pub fn pull<const K: usize>(&self, spring: usize, d: &[[f64; K]]) -> [f64; K] {
        let anchor = d[self.laplacian.vertices().len() + spring];
        let own = d[self.springs.local(spring) as usize];
        std::array::from_fn(|k| self.springs.strength(spring) * (anchor[k] - own[k]))
    }

    /// The stiffness of a local vertex's cell at order 2.
    #[inline]
    pub fn cell_stiffness(&self, local: usize) -> f64 {
        self.cell_stiffness.get(local).copied().unwrap_or(1.0)
    }

    /// φ of K functions on the local vertices, correct for vertices whose neighbours' rows are full.
    pub fn potential<'a, const K: usize>(&self, d: &'a [[f64; K]]) -> Potential<'a, K> {
        if self.power == 1 {
            return Potential::of(d);
        }
        let mut phi = self.laplacian.per_area(d);
        if self.power == 3 {
            phi = self.middle().per_area(&phi);
        }
        phi.par_iter_mut()
            .with_min_len(CHUNK)
            .zip(d)
            .enumerate()
            .for_each(|(local, (phi, d))| *phi = self.weighted(local, *phi, d));
        let stress = |natural: &NaturalTerm| {
            let locals = (0..self.laplacian.vertices().len()).into_par_iter().with_min_len(CHUNK);
            locals.map(|local| natural.stress(&self.laplacian, local, d)).collect()
        };
        Potential {
            phi: phi.into(),
            d,
            stress: self.natural.as_ref().map(stress).unwrap_or_default(),
        }
    }

    /// φ at order 1 or 2 of functions for which it is zero except at these local vertices.
    pub fn potential_at<'a, const K: usize>(&self, locals: &[u32], d: &'a [[f64; K]]) -> Potential<'a, K> {
        if self.power == 1 {
            return Potential::of(d);
        }
        let mut phi = vec![[0.0; K]; self.laplacian.vertices().len()];
        for &local in locals {
            let local = local as usize;
            let inverse_area = self.laplacian.inverse_areas()[local];
            let per_area = self.laplacian.row(local, d).map(|value| value * inverse_area);
            phi[local] = self.weighted(local, per_area, &d[local]);
        }
        let mut stress = Vec::new();
        if let Some(natural) = &self.natural {
            stress.resize(self.laplacian.vertices().len(), [[0.0; K]; 2]);
            for &local in locals {
                stress[local as usize] = natural.stress(&self.laplacian, local as usize, d);
            }
        }
        Potential {
            phi: phi.into(),
            d,
            stress,
        }
    }

    /// φ of a local vertex from d and the last Laplacian before the outermost one.
    #[inline]
    fn weighted<const K: usize>(&self, local: usize, laplacian: [f64; K], d: &[f64; K]) -> [f64; K] {
        let sign = if self.power == 2 { -self.bending } else { self.bending };
        let shared_stretching = if self.stretched.is_none() { self.stretching } else { 0.0 };
        let factor = sign * self.cell_stiffness(local);
        std::array::from_fn(|k| {
            let bent = laplacian[k] * factor;
            if shared_stretching > 0.0 {
                bent + shared_stretching * d[k]
            } else {
                bent
            }
        })
    }

    /// (A d)_i of `local`, given d's potential.
    #[inline]
    pub fn force<const K: usize>(&self, local: usize, potential: &Potential<'_, K>) -> [f64; K] {
        let factor = if self.power == 1 {
            -(self.stretching + self.bending)
        } else {
            -1.0
        };
        let mut force = self.laplacian.row(local, &potential.phi).map(|value| factor * value);
        if let Some(stretched) = &self.stretched {
            let row = stretched.row(local, potential.d);
            for k in 0..K {
                force[k] -= self.stretching * row[k];
            }
        }
        if let Some(natural) = &self.natural {
            let bent = natural.force(&self.laplacian, local, &potential.stress);
            for k in 0..K {
                force[k] += bent[k];
            }
        }
        force
    }

    /// ½ dᵀ A d over K functions and the springs' ½ (c − d)ᵀ W (c − d), summed from squares of differences, so that
    /// large common motions cost no digits.
    pub fn energy<const K: usize>(&self, d: &[[f64; K]]) -> f64 {
        let hung: f64 = (0..self.springs.len())
            .map(|spring| {
                let pull = self.pull(spring, d);
                pull.iter().map(|pull| pull * pull).sum::<f64>() / self.springs.strength(spring)
            })
            .sum();
        let stretch = |laplacian: &Laplacian, f: &[[f64; K]]| {
            sum_of_rows(laplacian.vertices().len(), |local| edges(laplacian, local, f))
        };
        let bend = match self.power {
            1 => stretch(&self.laplacian, d),
            2 => sum_of_rows(self.laplacian.vertices().len(), |local| {
                let row = self.laplacian.row(local, d);
                self.cell_stiffness(local)
                    * self.laplacian.inverse_areas()[local]
                    * row.iter().map(|value| value * value).sum::<f64>()
            }),
            _ => stretch(self.middle(), &self.laplacian.per_area(d)),
        };
        let stretched = if self.stretching > 0.0 {
            self.stretching * stretch(self.stretched.as_ref().unwrap_or(&self.laplacian), d)
        } else {
            0.0
        };
        let natural = self.natural.as_ref().map_or(0.0, |natural| {
            sum_of_rows(self.laplacian.vertices().len(), |local| {
                let density = natural.density(&self.laplacian, local);
                let rows = natural.hessian.row(&self.laplacian, local, d);
                density * rows.as_flattened().iter().map(|value| value * value).sum::<f64>()
            })
        });
        0.5 * (stretched + self.bending * bend + natural + hung)
    }

    /// The L between two others at order 3.
    pub fn middle(&self) -> &Laplacian {
        self.middle.as_ref().unwrap_or(&self.laplacian)
    }
}

/// This vertex' share of −fᵀ L f: half of each edge's, or all of it if the other end's row is not full.
fn edges<const K: usize>(laplacian: &Laplacian, local: usize, f: &[[f64; K]]) -> f64 {
    let ends = laplacian.neighbours(local).iter().zip(laplacian.weights(local));
    ends.map(|(&other, weight)| {
        let share = if laplacian.is_full(other as usize) { 0.5 } else { 1.0 };
        let square: f64 = (0..K).map(|k| (f[other as usize][k] - f[local][k]).powi(2)).sum();
        share * weight * square
    })
    .sum()
}

/// Summed in chunks of a fixed size, so that the result does not depend on the number of threads.
fn sum_of_rows(count: usize, row: impl Fn(usize) -> f64 + Sync) -> f64 {
    let partial: Vec<f64> = (0..count.div_ceil(CHUNK))
        .into_par_iter()
        .map(|chunk| (chunk * CHUNK..((chunk + 1) * CHUNK).min(count)).map(&row).sum())
        .collect();
    partial.iter().sum()
}
