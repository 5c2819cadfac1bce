//! Examples: further shapes that give lengths, angles, areas and volumes which the surface may have [FB11].
//!
//! With the weights w the energy's targets are l*(w) = l̄ + Σ_k w_k (l_k − l̄), and the same for angles, areas and
//! volumes. An angle's difference is the one of at most half a turn. Weights are given or free. The residuals are
//! linear in the free ones, so the best ones for a shape are the solution of a small dense system, and the energy is a
//! function of the shape alone (variable projection [GP73]):
//!
//! E(x) = min_w ½ Σ_i W_i (v_i(x) − v̄_i − Σ_k w_k Δ_ik)² + ½ ε Σ_k G_kk w_k²,  G_kl = Σ_i W_i Δ_ik Δ_il.
//!
//! The last term keeps a free weight at 0 if it changes nothing in the shape. The energy's gradient is that of the
//! residuals with these weights held constant; `leaning` has its matrix.

use faer::Mat;
use glam::DVec3;
use pliant_mesh::face_area;
use rayon::prelude::*;

use super::elements::{Edge, Elements, Face, Hinge};
use super::enclosed::Enclosed;
use super::hinge::{angle_rad, unwrapped};
use crate::numerical::dense::{Lu, solved};
use crate::numerical::rows::CHUNK;
use crate::numerical::sums::CHUNKS_A_TASK;

/// ε.
const MILD: f64 = 1e-6;

/// The examples, as far as the energy needs them. Tables have a row for each edge, hinge, triangle or component, with
/// one entry for each example.
#[derive(Debug, Default)]
pub(super) struct Examples {
    /// For each example the displacements of its local vertices from rest.
    pub displacements: Vec<Vec<DVec3>>,
    /// Δ.
    lengths: Vec<f64>,
    angles_rad: Vec<f64>,
    areas: Vec<f64>,
    volumes: Vec<f64>,
    /// G, row by row.
    products: Vec<f64>,
    /// The weight of each example; `None` if it is free.
    given: Vec<Option<f64>>,
    /// The numbers of the free ones.
    free: Vec<usize>,
    /// The free part of G + ε diag G.
    normal: Option<Lu>,
}

impl Examples {
    /// Measures the examples of a problem.
    pub fn of(brought: Option<&crate::Examples>, elements: &Elements, enclosed: &Enclosed) -> Self {
        let shapes = brought.map_or(&[][..], |brought| &brought.shapes);
        let displacements: Vec<Vec<DVec3>> = shapes
            .iter()
            .map(|shape| {
                let own = elements.vertices.iter();
                own.map(|&vertex| shape.displacements[vertex as usize]).collect()
            })
            .collect();
        let places = |own: &[DVec3], local: u32| elements.rest[local as usize] + own[local as usize];
        let mut lengths = Vec::with_capacity(elements.edges.len() * shapes.len());
        for Edge { ends, length, .. } in &elements.edges {
            lengths.extend(displacements.iter().map(|own| {
                let [a, b] = ends.map(|end| places(own, end));
                a.distance(b) - length
            }));
        }
        let mut angles_rad = Vec::with_capacity(elements.hinges.len() * shapes.len());
        for Hinge {
            corners,
            angle_rad: rest,
            ..
        } in &elements.hinges
        {
            let turned = |own: &Vec<DVec3>| unwrapped(angle_rad(corners.map(|corner| places(own, corner))) - rest, 0.0);
            angles_rad.extend(displacements.iter().map(turned));
        }
        let mut areas = Vec::with_capacity(elements.faces.len() * shapes.len());
        for Face {
            corners, area: rest, ..
        } in &elements.faces
        {
            let grown = |own: &Vec<DVec3>| face_area(corners.map(|corner| places(own, corner))) - rest;
            areas.extend(displacements.iter().map(grown));
        }
        let mut volumes = Vec::new();
        for part in &enclosed.parts {
            let swollen = |own: &Vec<DVec3>| part.volume_at(&|local| places(own, local)) - part.volume;
            volumes.extend(displacements.iter().map(swollen));
        }
        let mut examples = Self {
            displacements,
            lengths,
            angles_rad,
            areas,
            volumes,
            products: Vec::new(),
            given: Vec::new(),
            free: Vec::new(),
            normal: None,
        };
        for other in 0..shapes.len() {
            examples.products.extend(examples.moments(
                elements,
                enclosed,
                &|edge| examples.lengths[edge * shapes.len() + other],
                &|hinge| examples.angles_rad[hinge * shapes.len() + other],
                &|face| examples.areas[face * shapes.len() + other],
                &|part| examples.volumes[part * shapes.len() + other],
            ));
        }
        examples.give(&vec![Some(0.0); shapes.len()]);
        examples
    }

    /// Bytes of each local vertex for each example, with its edges, hinges, triangles and column.
    pub const ROW: usize = 24 + 8 * 8 + 2 * 24 + 56;

    pub fn count(&self) -> usize {
        self.displacements.len()
    }

    /// Sets the weights; `None` makes one free.
    pub fn give(&mut self, weights: &[Option<f64>]) {
        self.given = weights.to_vec();
        self.free = (0..weights.len()).filter(|&k| weights[k].is_none()).collect();
        self.normal = (!self.free.is_empty()).then(|| Lu::of(self.regular()));
    }

    /// The free part of G + ε diag G. An example that is the rest shape has the weight 0.
    pub fn regular(&self) -> Mat<f64> {
        let (count, free) = (self.count(), &self.free);
        Mat::from_fn(free.len(), free.len(), |row, column| {
            let product = self.products[free[row] * count + free[column]];
            let more = if row == column { self.regularity(free[row]) } else { 0.0 };
            product + more
        })
    }

    /// ε G_kk.
    fn regularity(&self, example: usize) -> f64 {
        let own = self.products[example * (self.count() + 1)];
        if own > 0.0 { MILD * own } else { 1.0 }
    }

    /// True if some weights are free.
    pub fn are_free(&self) -> bool {
        !self.free.is_empty()
    }

    /// The given weights, and 0 for the free ones.
    pub fn given(&self) -> impl Iterator<Item = f64> + '_ {
        self.given.iter().map(|weight| weight.unwrap_or(0.0))
    }

    /// The numbers of the free weights.
    pub fn free(&self) -> &[usize] {
        &self.free
    }

    /// l* − l̄ of an edge.
    pub fn length(&self, edge: usize, weights: &[f64]) -> f64 {
        blended(&self.lengths, edge, weights)
    }

    /// θ* − θ̄ of a hinge.
    pub fn angle_rad(&self, hinge: usize, weights: &[f64]) -> f64 {
        blended(&self.angles_rad, hinge, weights)
    }

    /// A* − Ā of a triangle.
    pub fn area(&self, face: usize, weights: &[f64]) -> f64 {
        blended(&self.areas, face, weights)
    }

    /// The least of A − Ā that an example gives a triangle, 0 where all make it larger.
    pub fn least_area(&self, face: usize) -> f64 {
        let count = self.count();
        self.areas[face * count..(face + 1) * count]
            .iter()
            .copied()
            .fold(0.0, f64::min)
    }

    /// V* − V̄ of a closed component.
    pub fn volume(&self, part: usize, weights: &[f64]) -> f64 {
        blended(&self.volumes, part, weights)
    }

    /// Δ of an example at an edge, a hinge, a triangle and a closed component.
    pub fn differences(&self, example: usize) -> [impl Fn(usize) -> f64 + Sync + '_; 4] {
        let count = self.count();
        [&self.lengths, &self.angles_rad, &self.areas, &self.volumes]
            .map(|rows| move |place: usize| rows[place * count + example])
    }

    /// ½ ε Σ G_kk w_k² over the free weights.
    pub fn energy(&self, weights: &[f64]) -> f64 {
        let held = self.free.iter().map(|&k| self.regularity(k) * weights[k].powi(2));
        0.5 * held.sum::<f64>()
    }

    /// The weights of a shape of these displacements and angles: the given ones, and the best values of the free ones.
    pub fn weigh(
        &self,
        elements: &Elements,
        enclosed: &Enclosed,
        displacements: &[DVec3],
        angles_rad: &[f64],
        weights: &mut Vec<f64>,
    ) {
        weights.clear();
        weights.extend(self.given());
        let Some(normal) = &self.normal else { return };
        let at = |local: u32| elements.rest[local as usize] + displacements[local as usize];
        let moments = self.moments(
            elements,
            enclosed,
            &|edge| {
                let Edge {
                    ends: [a, b], length, ..
                } = elements.edges[edge];
                at(a).distance(at(b)) - length
            },
            &|hinge| angles_rad[hinge] - elements.hinges[hinge].angle_rad,
            &|face| {
                let Face {
                    corners, area: rest, ..
                } = elements.faces[face];
                face_area(corners.map(at)) - rest
            },
            &|part| enclosed.parts[part].volume_at(&at) - enclosed.parts[part].volume,
        );
        let right = Mat::from_fn(self.free.len(), 1, |row, _| {
            let row = self.free[row];
            let products = &self.products[row * self.count()..(row + 1) * self.count()];
            moments[row] - products.iter().zip(&*weights).map(|(a, b)| a * b).sum::<f64>()
        });
        let found = normal.solved(right);
        for (place, &k) in self.free.iter().enumerate() {
            weights[k] = found[(place, 0)];
        }
    }

    /// Σ_i W_i Δ_ik v_i for each example k, over the values v of the edges, hinges, triangles and components.
    fn moments(
        &self,
        elements: &Elements,
        enclosed: &Enclosed,
        of_edge: &(impl Fn(usize) -> f64 + Sync),
        of_hinge: &(impl Fn(usize) -> f64 + Sync),
        of_face: &(impl Fn(usize) -> f64 + Sync),
        of_part: &impl Fn(usize) -> f64,
    ) -> Vec<f64> {
        let mut sums = vec![0.0; self.count()];
        let mut add = |weights: &(dyn Fn(usize) -> f64 + Sync), rows: &[f64], count: usize| {
            let chunks = count.div_ceil(CHUNK);
            let partial: Vec<Vec<f64>> = (0..chunks)
                .into_par_iter()
                .with_min_len(CHUNKS_A_TASK)
                .map(|chunk| {
                    let mut sums = vec![0.0; self.count()];
                    for place in chunk * CHUNK..count.min((chunk + 1) * CHUNK) {
                        let value = weights(place);
                        let row = &rows[place * self.count()..(place + 1) * self.count()];
                        sums.iter_mut().zip(row).for_each(|(sum, own)| *sum += value * own);
                    }
                    sums
                })
                .collect();
            for own in partial {
                sums.iter_mut().zip(own).for_each(|(sum, own)| *sum += own);
            }
        };
        let (edges, hinges) = (&elements.edges, &elements.hinges);
        add(&|edge| edges[edge].weight * of_edge(edge), &self.lengths, edges.len());
        add(
            &|hinge| hinges[hinge].weight * of_hinge(hinge),
            &self.angles_rad,
            hinges.len(),
        );
        let faces = &elements.faces;
        add(&|face| faces[face].weight * of_face(face), &self.areas, faces.len());
        for (number, part) in enclosed.parts.iter().enumerate() {
            let value = part.weight * of_part(number);
            let row = &self.volumes[number * self.count()..(number + 1) * self.count()];
            sums.iter_mut().zip(row).for_each(|(sum, own)| *sum += value * own);
        }
        sums
    }

    /// A first guess of the free weights: with the given ones, they bring the rest shape nearest to the wanted
    /// displacements of these local vertices.
    pub fn guess(&self, wanted: impl Iterator<Item = (usize, DVec3)>) -> Vec<f64> {
        let mut weights: Vec<f64> = self.given().collect();
        let free = &self.free;
        let (mut normal, mut right) = (Mat::zeros(free.len(), free.len()), Mat::zeros(free.len(), 1));
        for (local, displacement) in wanted {
            let moved = |k: usize| self.displacements[k][local];
            let given: DVec3 = weights.iter().enumerate().map(|(k, weight)| moved(k) * *weight).sum();
            for (row, &k) in free.iter().enumerate() {
                right[(row, 0)] += moved(k).dot(displacement - given);
                for (column, &l) in free.iter().enumerate() {
                    normal[(row, column)] += moved(k).dot(moved(l));
                }
            }
        }
        for row in 0..free.len() {
            let own: f64 = normal[(row, row)];
            normal[(row, row)] += if own > 0.0 { MILD * own } else { 1.0 };
        }
        let found = solved(normal, right);
        for (row, &k) in free.iter().enumerate() {
            weights[k] = found[(row, 0)].clamp(-1.0, 2.0);
        }
        weights
    }
}

fn blended(rows: &[f64], place: usize, weights: &[f64]) -> f64 {
    let row = &rows[place * weights.len()..(place + 1) * weights.len()];
    row.iter().zip(weights).map(|(own, weight)| own * weight).sum()
}
