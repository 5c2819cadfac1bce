//! The cotangent Laplacian and the mixed areas of a part of the surface.
//!
//! Sign: (L f)_i = Σ_j w_ij (f_j − f_i) with w_ij = ½ Σ cot over the triangles on edge ij, so L is symmetric and
//! *negative* semidefinite ([BS08, equations 6 and 7], without the division by area), and L M⁻¹ L is positive
//! semidefinite. It is applied by differences along edges, which gives zero on constants to the last bit, however far
//! from the origin; a product with an assembled matrix does not.
//!
//! Robustness: a triangle's cotangents come from its three edge lengths, *mollified* if they hardly or don't satisfy
//! the triangle inequality ([SC20], section 4.5, here triangle by triangle and relative to its own longest edge, so
//! that sound triangles keep their shape and units don't matter). Other weights are for comparison: see
//! [`Discretisation`]. Each triangle's part of L is then negative semidefinite for any shape, and so is L: edges with a
//! negative weight do no harm. Areas are bounded below by a millionth of their component's mean. Stiffness scales each
//! *face* by the mean of its corners, which keeps that property; scaling edges would break it.

pub(crate) mod discretisation;
pub(crate) mod face_terms;
pub(crate) mod gradients;
pub(crate) mod hessian;
mod mollification;
pub(crate) mod triangulation;

use pliant_mesh::{Surface, SurfaceVertex, Topology};
use rayon::prelude::*;

pub use self::mollification::mollified_lengths;
pub(crate) use self::mollification::repairs;

use crate::Discretisation;
use crate::numerical::graph::Graph;
use crate::numerical::rows::{CHUNK, place_in};
use crate::operators::face_terms::{FaceTerms, Metric};
use crate::operators::triangulation::Triangulation;

/// The least area of a vertex, in units of the mean over its component.
const AREA_FLOOR: f64 = 1e-6;

/// The cotangent Laplacian over local vertices, which are numbered in the order of their surface vertices.
///
/// A *full* row knows all neighbours of its vertex; the other vertices have empty rows and only serve as neighbours.
#[derive(Clone, Debug, Default)]
pub struct Laplacian {
    vertices: Vec<u32>,
    offsets: Vec<u32>,
    neighbours: Vec<u32>,
    weights: Vec<f64>,
    inverse_areas: Vec<f64>,
    mollified_faces: usize,
}

/// Cuts the entries of compressed rows into those of [`CHUNK`] rows each.
fn row_chunks<'a, T: Send>(entries: &'a mut [T], offsets: &[u32]) -> rayon::vec::IntoIter<&'a mut [T]> {
    let mut rest = entries;
    let mut chunks = Vec::with_capacity(offsets.len() / CHUNK + 1);
    for rows in offsets[..offsets.len() - 1]
        .chunks(CHUNK)
        .enumerate()
        .map(|(chunk, rows)| chunk * CHUNK..chunk * CHUNK + rows.len())
    {
        let (own, tail) = std::mem::take(&mut rest).split_at_mut((offsets[rows.end] - offsets[rows.start]) as usize);
        chunks.push(own);
        rest = tail;
    }
    chunks.into_par_iter()
}

/// A surface vertex that has no local number.
const ABSENT: u32 = u32::MAX;

impl Laplacian {
    /// The operator with full rows for all of `surface`; `stiffness` has one entry per vertex.
    pub fn of(surface: &Surface, topology: &Topology, stiffness: &[f64]) -> Self {
        let all: Vec<u32> = (0..surface.positions.len() as u32).collect();
        Self::with_rows(surface, topology, stiffness, &all)
    }

    /// The operator with full rows for the surface vertices `rows` (ascending); their neighbours get empty rows.
    pub fn with_rows(surface: &Surface, topology: &Topology, stiffness: &[f64], rows: &[u32]) -> Self {
        Self::discretised(surface, topology, stiffness, rows, Discretisation::CotangentArea)
    }

    /// Like [`Laplacian::with_rows`], with given weights and areas instead of the default.
    pub fn discretised(
        surface: &Surface,
        topology: &Topology,
        stiffness: &[f64],
        rows: &[u32],
        discretisation: Discretisation,
    ) -> Self {
        let triangulation = Triangulation::of_surface(surface, topology);
        Self::on(&triangulation, stiffness, rows, discretisation, &|_, _| 1.0)
    }

    /// The operator on any triangles. The weights of each triangle, but not its areas, are multiplied by `factor` of
    /// its corners and lengths, which must be at least 0.
    pub(crate) fn on(
        triangulation: &Triangulation,
        stiffness: &[f64],
        rows: &[u32],
        discretisation: Discretisation,
        factor: &(dyn Fn([SurfaceVertex; 3], [f64; 3]) -> f64 + Sync),
    ) -> Self {
        let mut is_row = vec![false; triangulation.vertex_count()];
        rows.iter().for_each(|&row| is_row[row as usize] = true);
        let mut local_of: Vec<u32> = (0..triangulation.vertex_count() as u32)
            .into_par_iter()
            .with_min_len(CHUNK)
            .map(|vertex| {
                let near = || {
                    triangulation
                        .neighbours(SurfaceVertex(vertex))
                        .iter()
                        .any(|n| is_row[n.index()])
                };
                if is_row[vertex as usize] || near() { 0 } else { ABSENT }
            })
            .collect();
        let mut vertices = Vec::with_capacity(local_of.len());
        let mut offsets = Vec::with_capacity(local_of.len() + 1);
        offsets.push(0);
        let mut end = 0;
        for (vertex, local) in local_of.iter_mut().enumerate() {
            if *local != ABSENT {
                *local = vertices.len() as u32;
                vertices.push(vertex as u32);
                if is_row[vertex] {
                    end += triangulation.neighbours(SurfaceVertex(vertex as u32)).len() as u32;
                }
                offsets.push(end);
            }
        }
        let mut neighbours = vec![0; end as usize];
        let chunks = vertices.par_chunks(CHUNK).zip(row_chunks(&mut neighbours, &offsets));
        chunks.for_each(|(vertices, list)| {
            let full = vertices.iter().filter(|&&vertex| is_row[vertex as usize]);
            let found = full.flat_map(|&vertex| triangulation.neighbours(SurfaceVertex(vertex)));
            for (place, neighbour) in list.iter_mut().zip(found) {
                *place = local_of[neighbour.index()];
            }
        });
        let mut operator = Self {
            vertices,
            offsets,
            neighbours,
            ..Self::default()
        };
        let metric = Metric::of(triangulation, discretisation);
        let share = triangulation.share();
        let face = |face: u32| {
            let (corners, lengths) = (triangulation.corners(face), triangulation.lengths(face));
            let mut terms = metric.face(stiffness, corners, lengths);
            let factor = share * factor(corners, lengths);
            terms.half_cotangents = terms.half_cotangents.map(|weight| factor * weight);
            terms.areas = terms.areas.map(|area| share * area);
            terms
        };
        operator.fill(triangulation, &local_of, metric.common_area(), face);
        operator
    }

    /// Cotangents are computed per face, then gathered per row: both sides of an edge add up the same numbers in the
    /// same order, so the weights are symmetric to the last bit.
    fn fill(
        &mut self,
        triangulation: &Triangulation,
        local_of: &[u32],
        common_area: Option<f64>,
        face: impl Fn(u32) -> FaceTerms + Sync,
    ) {
        let full = |vertex: SurfaceVertex| match local_of[vertex.index()] {
            ABSENT => false,
            local => self.is_full(local as usize),
        };
        let faces: Vec<u32> = (0..triangulation.face_count() as u32)
            .into_par_iter()
            .with_min_len(CHUNK)
            .filter(|&face| triangulation.corners(face).into_iter().any(full))
            .collect();
        let terms: Vec<FaceTerms> = faces
            .par_iter()
            .with_min_len(CHUNK)
            .map(|&number| face(number))
            .collect();
        self.mollified_faces = triangulation.mollified_faces() + terms.iter().filter(|terms| terms.mollified).count();
        let mut slot_of_face = vec![ABSENT; triangulation.face_count()];
        for (slot, &face) in faces.iter().enumerate() {
            slot_of_face[face as usize] = slot as u32;
        }
        let mut weights = vec![0.0; self.neighbours.len()];
        let mut areas = vec![0.0; self.vertices.len()];
        let chunks = areas.par_chunks_mut(CHUNK).zip(row_chunks(&mut weights, &self.offsets));
        chunks.enumerate().for_each(|(chunk, (areas, mut weights))| {
            for (local, area) in (chunk * CHUNK..).zip(areas) {
                let vertex = SurfaceVertex(self.vertices[local]);
                let neighbours = self.neighbours(local);
                let (row, rest) = std::mem::take(&mut weights).split_at_mut(neighbours.len());
                weights = rest;
                if neighbours.is_empty() {
                    continue;
                }
                triangulation.for_each_face(vertex, |face| {
                    let terms = &terms[slot_of_face[face as usize] as usize];
                    let corners = triangulation.corners(face);
                    for own in (0..3).filter(|&corner| corners[corner] == vertex) {
                        *area += terms.areas[own];
                        // The edge from here to another corner is opposite the third one. An intrinsic triangle may
                        // have this vertex twice, and an edge from it to itself does not count.
                        for other in (0..3).filter(|&corner| corners[corner] != vertex) {
                            let number = local_of[corners[other].index()];
                            if let Some(place) = place_in(neighbours, &number) {
                                row[place] += terms.half_cotangents[3 - own - other];
                            }
                        }
                    }
                });
                if let Some(common) = common_area {
                    *area = common;
                }
            }
        });
        self.weights = weights;
        self.floor_areas(triangulation.topology(), &mut areas);
        self.inverse_areas = areas
            .iter()
            .map(|&area| if area > 0.0 { area.recip() } else { 0.0 })
            .collect();
    }

    fn floor_areas(&self, topology: &Topology, areas: &mut [f64]) {
        let mut sums = vec![(0.0, 0.0); topology.components().len()];
        let component = |local: usize| topology.component(SurfaceVertex(self.vertices[local])) as usize;
        for local in (0..areas.len()).filter(|&local| self.is_full(local)) {
            let sum = &mut sums[component(local)];
            *sum = (sum.0 + areas[local], sum.1 + 1.0);
        }
        for local in (0..areas.len()).filter(|&local| self.is_full(local)) {
            let (area, count) = sums[component(local)];
            // A solve is also possible on a component without any area: then only its lengths matter.
            let mean = if area > 0.0 { area / count } else { 1.0 };
            areas[local] = areas[local].max(AREA_FLOOR * mean);
        }
    }

    /// Multiplies 1 / M_ii by `factor` of the local vertex, which must be at least 0.
    pub(crate) fn scale_inverse_areas(&mut self, factor: impl Fn(usize) -> f64) {
        for (local, inverse) in self.inverse_areas.iter_mut().enumerate() {
            *inverse *= factor(local);
        }
    }

    /// The surface vertex behind each local one, ascending.
    pub fn vertices(&self) -> &[u32] {
        &self.vertices
    }

    /// The local number of a surface vertex.
    pub fn local(&self, surface_vertex: u32) -> Option<usize> {
        self.vertices.binary_search(&surface_vertex).ok()
    }

    /// The local numbers of these surface vertices, without those that have none.
    pub(crate) fn locals(&self, surface_vertices: &[u32]) -> Vec<u32> {
        let local = |&vertex: &u32| self.local(vertex).map(|local| local as u32);
        surface_vertices
            .par_iter()
            .with_min_len(CHUNK)
            .filter_map(local)
            .collect()
    }

    /// The local neighbours of `local`, ascending; none if the row is not full.
    pub fn neighbours(&self, local: usize) -> &[u32] {
        &self.neighbours[self.offsets[local] as usize..self.offsets[local + 1] as usize]
    }

    /// The weights w_ij of the edges to [`Laplacian::neighbours`], without unit.
    pub fn weights(&self, local: usize) -> &[f64] {
        &self.weights[self.offsets[local] as usize..self.offsets[local + 1] as usize]
    }

    /// Returns true if the row of `local` has all its neighbours. Every surface vertex has at least one.
    pub fn is_full(&self, local: usize) -> bool {
        self.offsets[local] < self.offsets[local + 1]
    }

    /// 1 / M_ii, the mixed Voronoi area's inverse \[MDSB03\]; 0 if the row is not full.
    pub fn inverse_areas(&self) -> &[f64] {
        &self.inverse_areas
    }

    /// The number of triangles too flat for their own cotangents.
    pub fn mollified_faces(&self) -> usize {
        self.mollified_faces
    }

    /// (L f)_i at `local`: Σ_j w_ij (f_j − f_i), 0 if the row is not full.
    #[inline]
    pub fn row<const K: usize>(&self, local: usize, f: &[[f64; K]]) -> [f64; K] {
        let own = f[local];
        let mut sum = [0.0; K];
        for (&neighbour, &weight) in self.neighbours(local).iter().zip(self.weights(local)) {
            let other = f[neighbour as usize];
            for k in 0..K {
                sum[k] += weight * (other[k] - own[k]);
            }
        }
        sum
    }

    /// M⁻¹ L f on the full rows, 0 on the others.
    pub fn per_area<const K: usize>(&self, f: &[[f64; K]]) -> Vec<[f64; K]> {
        (0..self.vertices.len())
            .into_par_iter()
            .with_min_len(CHUNK)
            .map(|local| self.row(local, f).map(|value| value * self.inverse_areas[local]))
            .collect()
    }
}
