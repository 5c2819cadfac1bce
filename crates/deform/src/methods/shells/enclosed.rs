//! The volumes that closed components enclose.
//!
//! V = Σ p_a · (p_b × p_c) / 6 over a component's triangles, and its gradient at a vertex is Σ p_b × p_c / 6. A
//! component counts as closed if its triangles pass each edge equally often in both directions.

use glam::DVec3;
use pliant_mesh::SurfaceVertex;
use rayon::prelude::*;

use super::Shells;
use super::elements::Elements;
use crate::numerical::rows::CHUNK;
use crate::numerical::sums::CHUNKS_A_TASK;
use crate::region::boundary_problem::BoundaryProblem;

/// A component whose volume is below this share of the largest volume that its area could enclose has no volume.
const NOTHING: f64 = 1e-6;

/// All closed components that bend.
#[derive(Clone, Debug, Default)]
pub(super) struct Enclosed {
    pub parts: Vec<Part>,
}

/// A closed component: ½ weight (V − volume)².
#[derive(Clone, Debug)]
pub(super) struct Part {
    /// Its triangles, by local vertices.
    faces: Vec<[u32; 3]>,
    /// Its solved vertices, ascending.
    pub solved: Vec<u32>,
    pub volume: f64,
    pub weight: f64,
}

impl Enclosed {
    /// Finds the components with a solved vertex and numbers all their vertices; none if the option `volume` is 0.
    pub fn of(problem: &BoundaryProblem, options: &Shells, elements: &mut Elements) -> Self {
        if options.volume == 0.0 {
            return Self::default();
        }
        let BoundaryProblem { surface, topology, .. } = *problem;
        let component = |vertex: SurfaceVertex| topology.component(vertex) as usize;
        let mut faces = vec![Vec::new(); topology.components().len()];
        let mut solved = vec![Vec::new(); faces.len()];
        for (local, &vertex) in elements.vertices[..elements.solved_count].iter().enumerate() {
            solved[component(SurfaceVertex(vertex))].push(local as u32);
        }
        for corners in &surface.triangles {
            if !solved[component(corners[0])].is_empty() {
                faces[component(corners[0])].push(*corners);
            }
        }
        let mut local_of = elements.local_of(surface.positions.len());
        let origin = match elements.vertices.first() {
            Some(&vertex) => surface.positions[vertex as usize] - elements.rest[0],
            None => return Self::default(),
        };
        let mut parts = Vec::new();
        for (faces, solved) in faces.into_iter().zip(solved) {
            if faces.is_empty() || !is_closed(&faces) {
                continue;
            }
            let mut numbered = |corner: SurfaceVertex| {
                elements.add(&mut local_of, corner.0, surface.positions[corner.index()] - origin)
            };
            let faces: Vec<[u32; 3]> = faces.into_iter().map(|corners| corners.map(&mut numbered)).collect();
            let area: f64 = faces
                .iter()
                .map(|corners| {
                    let [a, b, c] = corners.map(|corner| elements.rest[corner as usize]);
                    0.5 * (b - a).cross(c - a).length()
                })
                .sum();
            let mut part = Part {
                faces,
                solved,
                volume: 0.0,
                weight: 0.0,
            };
            part.volume = part.volume_at(&|local| elements.rest[local as usize]);
            if part.volume.abs() > NOTHING * area.powf(1.5) {
                part.weight = options.volume * area / (part.volume * part.volume);
                parts.push(part);
            }
        }
        Self { parts }
    }
}

impl Part {
    /// V with the local vertices at these positions.
    pub fn volume_at(&self, at: &(impl Fn(u32) -> DVec3 + Sync)) -> f64 {
        let sums: Vec<f64> = self
            .faces
            .par_chunks(CHUNK)
            .with_min_len(CHUNKS_A_TASK)
            .map(|faces| {
                let six = faces.iter().map(|corners| {
                    let [a, b, c] = corners.map(at);
                    a.dot(b.cross(c))
                });
                six.sum::<f64>()
            })
            .collect();
        sums.iter().sum::<f64>() / 6.0
    }

    /// Adds V's gradient at its solved vertices.
    pub fn add_gradient(&self, at: &impl Fn(u32) -> DVec3, gradient: &mut [[f64; 3]]) {
        for corners in &self.faces {
            let [a, b, c] = corners.map(at);
            for (corner, slope) in corners.iter().zip([b.cross(c), c.cross(a), a.cross(b)]) {
                if let Some(own) = gradient.get_mut(*corner as usize) {
                    let slope = (slope / 6.0).to_array();
                    own.iter_mut().zip(slope).for_each(|(own, slope)| *own += slope);
                }
            }
        }
    }
}

/// True if the triangles pass each edge equally often in both directions.
fn is_closed(faces: &[[SurfaceVertex; 3]]) -> bool {
    let mut sides: Vec<(u32, u32, i32)> = faces
        .iter()
        .flat_map(|&[a, b, c]| [(a.0, b.0), (b.0, c.0), (c.0, a.0)])
        .map(|(from, to)| (from.min(to), from.max(to), if from < to { 1 } else { -1 }))
        .collect();
    sides.par_sort_unstable();
    let mut edges = sides.chunk_by(|one, other| (one.0, one.1) == (other.0, other.1));
    edges.all(|edge| edge.iter().map(|side| side.2).sum::<i32>() == 0)
}
