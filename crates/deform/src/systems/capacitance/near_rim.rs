//! A preconditioner of the capacitance matrix: the plate near its rim alone.
//!
//! With E = D^½ C the capacitance matrix is S = 1 + E B Eᵀ, and by Woodbury's identity, the other way round,
//!
//! S⁻¹ = 1 − E A⁻¹ Eᵀ.
//!
//! Waves along the rim decay within about a wavelength from it. So A is cut off to a band b beside the rim, which is
//! clamped at its far edge, too:
//!
//! M = 1 − E A_bb⁻¹ Eᵀ, S⁻¹ ≤ M ≤ 1,
//!
//! because A_bb⁻¹ is at most the block of A⁻¹ there. So M is positive definite, no eigenvalue of M S is below 1, and
//! only waves longer than the band's width are above. Without it the directions grow as the square root of the rim's
//! length.

use std::collections::BTreeSet;

use pliant_mesh::{Cancel, SurfaceVertex};

use super::rows::CapacitanceRows;
use crate::budget::{Budget, bytes_of};
use crate::numerical::graph::Graph;
use crate::operators::Laplacian;
use crate::sparse::Elimination;
use crate::sparse::matrix::CONSTRAINED;
use crate::sparse::ordering::dissection::dissect;
use crate::sparse::refactorisation::{Refactorisation, RenewableFactor};
use crate::systems::assembly::assemble_bilaplacian;
use crate::systems::hubs::Hubs;
use crate::systems::operator::BilaplacianOperator;

/// The band has at most this share of the solved vertices: its factor is read as often as the Laplacian's.
const SHARE: usize = 16;

/// A band with fewer rings than this is left out.
const LEAST_RINGS: usize = 4;

/// The band's factor.
#[derive(Debug)]
pub(super) struct NearRim {
    /// The factor of T A_bb T, in scaled columns.
    factored: RenewableFactor,
    /// E T over the band's columns.
    rows: CapacitanceRows,
}

impl NearRim {
    /// The band beside the rim whose `rows` are over the local vertices `columns` of this `scale`. `None` if it would
    /// be too narrow or exceed the budget, or if its matrix would have hubs.
    pub fn of(
        operator: &BilaplacianOperator,
        (columns, column_of, scale): (&[u32], &[u32], &[f64]),
        rows: &CapacitanceRows,
        budget: Budget,
        cancel: &Cancel,
    ) -> Option<Self> {
        let laplacian = &operator.laplacian;
        let locals = band(laplacian, columns, column_of, rows)?;
        let graph = BandGraph::of(laplacian, &locals);
        let Elimination { order, ends } = dissect(&graph, locals.len(), operator.power, cancel).ok()?;
        let own_columns: Vec<u32> = order.iter().map(|&number| locals[number as usize]).collect();
        let mut own_column_of = vec![CONSTRAINED; column_of.len()];
        for (own, &local) in own_columns.iter().enumerate() {
            own_column_of[local as usize] = own as u32;
        }
        let hubs = Hubs::of(operator, &own_column_of);
        if !hubs.is_empty() {
            return None;
        }
        let matrix = assemble_bilaplacian(operator, &own_columns, &own_column_of, &hubs, budget).ok()?;
        let elimination = Elimination {
            order: own_columns
                .iter()
                .map(|&local| laplacian.vertices()[local as usize])
                .collect(),
            ends,
        };
        let factored = RenewableFactor::of(matrix, elimination, &[0.0], Refactorisation::Never, budget, cancel).ok()?;
        let own = |column: u32| own_column_of[columns[column as usize] as usize];
        let rescale = |column: u32| factored.scale()[own(column) as usize] / scale[column as usize];
        Some(Self {
            rows: rows.moved(own, rescale),
            factored,
        })
    }

    /// Bytes of the factor.
    pub fn bytes(&self) -> u64 {
        bytes_of(self.stored(), size_of::<f64>())
    }

    /// The number of entries that the factor stores.
    pub fn stored(&self) -> usize {
        self.factored.factor.stored()
    }

    /// q ← M q.
    pub fn precondition<const K: usize>(&self, q: &mut [[f64; K]]) {
        let mut x = vec![[0.0; K]; self.factored.scale().len()];
        self.rows.subtract_transposed(q, &mut x);
        self.factored.factor.solve(&mut x);
        for (q, change) in q.iter_mut().zip(self.rows.product(&x)) {
            for k in 0..K {
                q[k] += change[k];
            }
        }
    }
}

/// The solved local vertices within as many rings of the rim as their share allows, ascending.
fn band(laplacian: &Laplacian, columns: &[u32], column_of: &[u32], rows: &CapacitanceRows) -> Option<Vec<u32>> {
    let most = columns.len() / SHARE;
    let mut ring: Vec<u32> = rows.columns().map(|column| columns[column as usize]).collect();
    ring.sort_unstable();
    ring.dedup();
    if ring.is_empty() || ring.len() * LEAST_RINGS > most {
        return None;
    }
    let mut is_near = vec![false; column_of.len()];
    let mut near = Vec::new();
    while !ring.is_empty() && near.len() + ring.len() <= most {
        ring.iter().for_each(|&local| is_near[local as usize] = true);
        near.extend_from_slice(&ring);
        let around = ring.iter().flat_map(|&local| laplacian.neighbours(local as usize));
        let is_next = |local: &&u32| column_of[**local as usize] != CONSTRAINED && !is_near[**local as usize];
        ring = around
            .filter(is_next)
            .copied()
            .collect::<BTreeSet<_>>()
            .into_iter()
            .collect();
    }
    near.sort_unstable();
    Some(near)
}

/// The band's neighbours, by their numbers in it.
struct BandGraph {
    starts: Vec<usize>,
    neighbours: Vec<SurfaceVertex>,
}

impl BandGraph {
    /// The local vertices, ascending.
    fn of(laplacian: &Laplacian, locals: &[u32]) -> Self {
        let mut graph = Self {
            starts: vec![0],
            neighbours: Vec::new(),
        };
        for &local in locals {
            let start = graph.neighbours.len();
            let beside = laplacian.neighbours(local as usize).iter();
            let inside = beside.filter_map(|other| locals.binary_search(other).ok());
            graph
                .neighbours
                .extend(inside.map(|number| SurfaceVertex(number as u32)));
            graph.neighbours[start..].sort_unstable();
            graph.starts.push(graph.neighbours.len());
        }
        graph
    }
}

impl Graph for BandGraph {
    fn neighbours(&self, vertex: SurfaceVertex) -> &[SurfaceVertex] {
        &self.neighbours[self.starts[vertex.index()]..self.starts[vertex.index() + 1]]
    }
}
