//! The bi-Laplacian's treatment of hubs: vertices with very many neighbours, such as the tip of a fan.
//!
//! At order 2 and above the curvature at a hub couples all of its neighbours with each other: for a fan of d triangles
//! the matrix would have d² / 2 entries. But together they are one square, A = B + c p pᵀ, in which p is the hub's row
//! of −L. So the matrix is assembled without the curvature at hubs, and the difference is a correction of low rank
//! ([`LowRank`](crate::sparse::low_rank::LowRank)), which is exact: the shape is the same.
//!
//! With u_h = 0 at a hub h (order 3: A = Qᵀ P Q with Q = M⁻¹ P) B lacks
//!
//! - order 2: c_h p_h p_hᵀ, c_h = k_b s_h / M_hh;
//! - order 3: k_b (g_h q_hᵀ + q_h g_hᵀ + Σ_k P_hk q_h q_kᵀ), q_h being Q's row and g_h = Q₀ᵀ P e_h, Q₀ Q without its
//!   rows at hubs.
//!
//! Without any term at hubs B would not resist a peak there. So it gets a *stand-in* for p with few entries, p̃_h =
//! P_hh (e_h − the mean over some neighbours), which the correction removes again.

use std::collections::BTreeMap;

use crate::sparse::low_rank::SparseVector;
use crate::sparse::matrix::CONSTRAINED;
use crate::systems::operator::BilaplacianOperator;

/// The number of neighbours that represent all of a hub's.
const SAMPLES: usize = 16;

/// The hubs of a bi-Laplacian's operator.
#[derive(Debug, Default)]
pub(crate) struct Hubs {
    /// Local vertices, ascending.
    locals: Vec<u32>,
    /// By local vertex; empty if there is no hub.
    is_hub: Vec<bool>,
    /// For each hub γ and t with B = A₀ + Σ γ t tᵀ, by local vertex.
    stand_ins: Vec<(f64, SparseVector)>,
    /// For each local vertex the stand-ins that have an entry there.
    standing: BTreeMap<u32, Vec<(usize, f64)>>,
}

impl Hubs {
    /// The operator's vertices with too many solved neighbours: neighbours that have an entry in `column_of`.
    pub fn of(operator: &BilaplacianOperator, column_of: &[u32]) -> Self {
        if operator.power == 1 {
            return Self::default();
        }
        let laplacian = &operator.laplacian;
        let is_hub = |local: usize| {
            let ring = laplacian.neighbours(local);
            let solved = |other: &&u32| column_of[**other as usize] != CONSTRAINED;
            ring.len() > operator.hub_degree && ring.iter().filter(solved).count() > operator.hub_degree
        };
        let locals: Vec<u32> = (0..column_of.len()).filter(|&l| is_hub(l)).map(|l| l as u32).collect();
        if locals.is_empty() {
            return Self::default();
        }
        let mut hubs = Self {
            is_hub: vec![false; column_of.len()],
            stand_ins: locals.iter().map(|&hub| stand_in(operator, hub as usize)).collect(),
            locals,
            standing: BTreeMap::new(),
        };
        for (number, &hub) in hubs.locals.iter().enumerate() {
            hubs.is_hub[hub as usize] = true;
            for &(local, value) in &hubs.stand_ins[number].1 {
                hubs.standing.entry(local).or_default().push((number, value));
            }
        }
        hubs
    }

    /// Returns true if there is none.
    pub fn is_empty(&self) -> bool {
        self.locals.is_empty()
    }

    /// Returns true if the curvature at a local vertex is left out of the matrix.
    #[inline]
    pub fn contains(&self, local: u32) -> bool {
        self.is_hub.get(local as usize).copied().unwrap_or(false)
    }

    /// The correction's rank.
    pub fn rank(&self, operator: &BilaplacianOperator) -> usize {
        self.locals.len() * operator.power as usize
    }

    /// The stand-ins' part of B's column of a local vertex: rows and values.
    pub fn stand_in_column(&self, local: u32) -> impl Iterator<Item = (u32, f64)> + '_ {
        let own = self.standing.get(&local).into_iter().flatten();
        own.flat_map(|&(number, value)| {
            let (weight, entries) = &self.stand_ins[number];
            entries.iter().map(move |&(row, other)| (row, weight * value * other))
        })
    }

    /// U and C, row by row, of S A S = S B S + U C Uᵀ.
    pub fn correction(
        &self,
        operator: &BilaplacianOperator,
        column_of: &[u32],
        scale: &[f64],
    ) -> (Vec<SparseVector>, Vec<f64>) {
        let solved = |entries: SparseVector, factor: f64| -> SparseVector {
            let columns = entries
                .into_iter()
                .map(|(local, value)| (column_of[local as usize], value));
            let columns = columns.filter(|&(column, _)| column != CONSTRAINED);
            columns
                .map(|(column, value)| (column, factor * value * scale[column as usize]))
                .collect()
        };
        let count = self.locals.len();
        let rank = self.rank(operator);
        let (mut vectors, mut c) = (Vec::with_capacity(rank), vec![0.0; rank * rank]);
        let inverse_areas = operator.laplacian.inverse_areas();
        let hubs = || self.locals.iter().map(|&hub| hub as usize);
        let roots: Vec<f64> = match operator.power {
            2 => hubs().map(|hub| curvature_weight(operator, hub).sqrt()).collect(),
            _ => hubs().map(|hub| middle_weight(operator, hub).sqrt()).collect(),
        };
        for (hub, &root) in hubs().zip(&roots) {
            let factor = if operator.power == 2 {
                root
            } else {
                root * inverse_areas[hub]
            };
            vectors.push(solved(row(&operator.laplacian, hub), factor));
        }
        if operator.power == 2 {
            (0..count).for_each(|h| c[h * rank + h] = 1.0);
        } else {
            for (h, hub) in hubs().enumerate() {
                let root = if roots[h] > 0.0 { roots[h] } else { 1.0 };
                vectors.push(solved(self.beside(operator, hub), operator.bending / root));
                let of_q = if roots[h] > 0.0 { 1.0 } else { 0.0 };
                (c[h * rank + count + h], c[(count + h) * rank + h]) = (of_q, of_q);
                for (local, value) in row(operator.middle(), hub) {
                    if let Ok(k) = self.locals.binary_search(&local) {
                        let roots = roots[h] * roots[k];
                        c[h * rank + k] = if roots > 0.0 {
                            operator.bending * value / roots
                        } else {
                            0.0
                        };
                    }
                }
            }
        }
        for (number, (weight, entries)) in self.stand_ins.iter().enumerate() {
            vectors.push(solved(entries.clone(), weight.sqrt()));
            let place = rank - count + number;
            c[place * rank + place] = -1.0;
        }
        (vectors, c)
    }

    /// g_h = Q₀ᵀ P e_h of a hub, by local vertex.
    fn beside(&self, operator: &BilaplacianOperator, hub: usize) -> SparseVector {
        let laplacian = &operator.laplacian;
        let mut sums: BTreeMap<u32, f64> = BTreeMap::new();
        for (other, value) in row(operator.middle(), hub) {
            if !self.contains(other) {
                let factor = value * laplacian.inverse_areas()[other as usize];
                for (local, value) in row(laplacian, other as usize) {
                    *sums.entry(local).or_default() += factor * value;
                }
            }
        }
        sums.into_iter().collect()
    }
}

/// k_b s_h / M_hh: the factor of the square of (L d)_h at order 2.
fn curvature_weight(operator: &BilaplacianOperator, hub: usize) -> f64 {
    operator.bending * operator.cell_stiffness(hub) * operator.laplacian.inverse_areas()[hub]
}

/// k_b P_hh, P the middle −L of order 3: the factor of the square of the curvature at h, if that around it is 0.
fn middle_weight(operator: &BilaplacianOperator, hub: usize) -> f64 {
    let weights = operator.middle().weights(hub);
    operator.bending * weights.iter().sum::<f64>().max(0.0)
}

/// γ and t of a hub.
fn stand_in(operator: &BilaplacianOperator, hub: usize) -> (f64, SparseVector) {
    let laplacian = &operator.laplacian;
    let (ring, weights) = (laplacian.neighbours(hub), laplacian.weights(hub));
    let whole: f64 = weights.iter().sum();
    let (weight, factor) = match operator.power {
        2 => (curvature_weight(operator, hub), 1.0),
        _ => (middle_weight(operator, hub), laplacian.inverse_areas()[hub]),
    };
    // Evenly spread over the weights, so that a few heavy neighbours are included.
    let positive: f64 = weights.iter().map(|weight| weight.max(0.0)).sum();
    let step = positive / SAMPLES as f64;
    let (mut sampled, mut sum) = (Vec::with_capacity(SAMPLES), 0.0);
    for (&other, &weight) in ring.iter().zip(weights) {
        sum += weight.max(0.0);
        if sum > (sampled.len() as f64 + 0.5) * step {
            sampled.push(other);
        }
    }
    let share = -factor * whole / sampled.len().max(1) as f64;
    let mut entries = vec![(hub as u32, factor * whole)];
    entries.extend(sampled.into_iter().map(|other| (other, share)));
    (weight, entries)
}

/// The row of −L of a local vertex, the diagonal first.
fn row(laplacian: &crate::Laplacian, local: usize) -> SparseVector {
    let (ring, weights) = (laplacian.neighbours(local), laplacian.weights(local));
    let diagonal = (local as u32, weights.iter().sum());
    let others = ring.iter().zip(weights).map(|(&other, &weight)| (other, -weight));
    std::iter::once(diagonal).chain(others).collect()
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "tests")]
mod tests {
    use std::f64::consts::TAU;

    use glam::DVec3;
    use pliant_mesh::{Cancel, Progress, Surface, SurfaceVertex, Topology};

    use crate::handles::Handle;
    use crate::region::boundary_problem::BoundaryProblem;
    use crate::sparse::refactorisation::Refactorisation;
    use crate::systems::factored::BilaplacianSystem;
    use crate::systems::setup::{Boundaries, operator};
    use crate::{Bilaplacian, BilaplacianOrder, Budget, Method, Ordering, Role};

    /// Rings of `count` vertices around one in the middle, on a bumpy dish.
    fn wheel(count: usize, rings: usize) -> Surface {
        let mut surface = Surface::default();
        surface.positions.push(DVec3::new(0.01, 0.02, 0.3));
        for ring in 1..=rings {
            for place in 0..count {
                let angle = TAU * place as f64 / count as f64;
                let height = 0.05 * (5.0 * angle).sin();
                let radius = ring as f64 / rings as f64;
                surface
                    .positions
                    .push(DVec3::new(radius * angle.cos(), radius * angle.sin(), height * radius));
            }
        }
        let at = |ring: usize, place: usize| (1 + (ring - 1) * count + place % count) as u32;
        for place in 0..count {
            surface
                .triangles
                .push([0, at(1, place), at(1, place + 1)].map(SurfaceVertex));
            for ring in 1..rings {
                let [a, b] = [at(ring, place), at(ring, place + 1)];
                let [c, d] = [at(ring + 1, place), at(ring + 1, place + 1)];
                surface
                    .triangles
                    .extend([[a, c, b], [b, c, d]].map(|t| t.map(SurfaceVertex)));
            }
        }
        sorted(surface)
    }

    /// Triangles on one edge, like the pages of a book, the edge's ends being the lowest vertices, each with two more.
    fn book(count: usize) -> Surface {
        let mut surface = Surface::default();
        surface.positions.extend([DVec3::ZERO, DVec3::X]);
        for page in 0..count {
            let angle = TAU * page as f64 / count as f64;
            let (y, z) = (angle.cos(), angle.sin());
            let first = surface.positions.len() as u32;
            surface.positions.extend([
                DVec3::new(0.3 + 0.2 * (3.0 * angle).sin(), y, z),
                DVec3::new(0.1, 2.0 * y, 2.0 * z),
                DVec3::new(0.9, 2.0 * y, 2.0 * z),
            ]);
            let page = [[0, 1, first], [0, first, first + 1], [1, first + 2, first]];
            surface.triangles.extend(page.map(|t| t.map(SurfaceVertex)));
        }
        sorted(surface)
    }

    fn sorted(mut surface: Surface) -> Surface {
        surface.triangles.sort_unstable_by_key(|triangle| {
            let mut key = *triangle;
            key.sort_unstable();
            key
        });
        surface
    }

    /// The handle's four functions if vertices of more than `hub_degree` neighbours are hubs, and the number of the
    /// factor's entries.
    fn solved(surface: &Surface, options: &Bilaplacian, hub_degree: usize) -> (Vec<[f64; 4]>, usize) {
        let topology = Topology::of(surface);
        let role = |p: &DVec3| match p.y {
            y if y > 0.8 => Role::Handle(0),
            y if y < -0.8 => Role::Fixed,
            _ => Role::Free,
        };
        let roles: Vec<Role> = surface.positions.iter().map(role).collect();
        let stiffness: Vec<f64> = (0..roles.len()).map(|v| 1.0 + (v % 4) as f64).collect();
        let method = Method::from(options.clone());
        let problem = BoundaryProblem::new((surface, &topology), &roles, &stiffness);
        let partition = method.partition(&problem).unwrap();
        let handles = [Handle::new(partition.handles[0].clone(), &surface.positions)];
        let (progress, cancel) = (Progress::new(), Cancel::new());
        let ordering = Ordering::of(&topology, options.operator_power(), &progress, &cancel).unwrap();
        let (mut operator, prescribed) =
            operator(&problem, options.energy(), &partition, &handles, Boundaries::Natural);
        operator.hub_degree = hub_degree;
        let elimination = ordering.elimination(&partition.solved);
        let mut system = BilaplacianSystem::new(
            operator,
            elimination,
            Refactorisation::Never,
            Budget::default(),
            &cancel,
        )
        .unwrap();
        let mut d = vec![[0.0, 0.0, 0.0, 0.0, 1.0]; system.operator.field_len()];
        for &(place, [x, y, z, w]) in &prescribed[0] {
            d[place as usize] = [x, y, z, w, 1.0];
        }
        system.check(&mut d, &cancel).unwrap();
        let handle = d.iter().map(|&[x, y, z, w, _]| [x, y, z, w]).collect();
        (handle, system.factor_len())
    }

    #[test]
    fn a_hub_left_to_its_correction_gives_the_shape_of_the_whole_matrix() {
        for (name, surface) in [("wheel", wheel(300, 3)), ("book", book(300))] {
            for order in [BilaplacianOrder::ThinPlate, BilaplacianOrder::CurvatureVariation] {
                for stretching in [0.0, 20.0] {
                    let options = Bilaplacian {
                        order,
                        stretching,
                        ..Bilaplacian::default()
                    };
                    let (whole, _) = solved(&surface, &options, usize::MAX);
                    let (split, _) = solved(&surface, &options, 100);
                    let error = whole.as_flattened().iter().zip(split.as_flattened());
                    let error = error.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
                    assert!(error < 1e-8, "{name} {order:?} {stretching}: {error:e}");
                }
            }
        }
    }

    #[test]
    fn the_factor_grows_as_the_hub_does_and_not_as_its_square() {
        for order in [BilaplacianOrder::ThinPlate, BilaplacianOrder::CurvatureVariation] {
            let options = Bilaplacian {
                order,
                ..Bilaplacian::default()
            };
            for shape in [|count| wheel(count, 2), book] {
                let [once, twice] = [700, 1400].map(|count| solved(&shape(count), &options, 512).1);
                assert!(twice < 3 * once, "{order:?}: {once} {twice}");
            }
        }
    }
}
