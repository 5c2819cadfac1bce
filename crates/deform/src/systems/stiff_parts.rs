//! Stiff parts: the connected parts of a surface that are stiffer than the rest, what leads each of them, and springs
//! that tie one to its motion. A linear method turns nothing by itself, so it gives each part a rigid motion.

use pliant_mesh::SurfaceVertex;

use crate::Role;
use crate::handles::Handle;
use crate::numerical::graph::Graph;
use crate::operators::triangulation::Triangulation;
use crate::region::boundary_problem::BoundaryProblem;
use crate::systems::operator::BilaplacianOperator;
use crate::systems::setup::Prescribed;

/// The most parts with their own motion: the plate's method needs the columns of a handle for each.
const MOST: usize = 16;

/// The source of a part's motion.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum Guide {
    /// No vertex of it is held.
    Free,
    Fixed,
    Handle(u16),
}

/// s₁ of each surface vertex.
pub(crate) fn least_stiffness(operator: &BilaplacianOperator, problem: &BoundaryProblem) -> Vec<f64> {
    let laplacian = &operator.laplacian;
    let mut of_component = vec![f64::INFINITY; problem.topology.components().len()];
    let component = |vertex: u32| problem.topology.component(SurfaceVertex(vertex)) as usize;
    for (local, &vertex) in laplacian.vertices().iter().enumerate() {
        if laplacian.is_full(local) {
            let least = &mut of_component[component(vertex)];
            *least = least.min(problem.stiffness[vertex as usize]);
        }
    }
    let of = |vertex: usize| of_component[component(vertex as u32)].max(1.0);
    (0..problem.stiffness.len()).map(of).collect()
}

/// The parts that are stiffer than `least` and reach the bending part, the heaviest first, and their guides; parts
/// between several guides are left out.
pub(crate) fn stiff_components(
    operator: &BilaplacianOperator,
    triangulation: &Triangulation,
    problem: &BoundaryProblem,
    least: &[f64],
) -> Vec<(Vec<u32>, Guide)> {
    let is_stiff = |vertex: usize| problem.stiffness[vertex] > least[vertex];
    let mut is_seen = vec![false; least.len()];
    let mut parts: Vec<(f64, Vec<u32>, Guide)> = Vec::new();
    for &first in operator.laplacian.vertices() {
        if is_seen[first as usize] || !is_stiff(first as usize) {
            continue;
        }
        is_seen[first as usize] = true;
        let (mut part, mut guides, mut weight) = (vec![first], Vec::new(), 0.0);
        let mut next = 0;
        while let Some(&vertex) = part.get(next) {
            next += 1;
            let guide = match problem.roles[vertex as usize] {
                Role::Handle(handle) if problem.constraints.weight(handle).is_none() => Guide::Handle(handle),
                Role::Fixed => Guide::Fixed,
                Role::Free | Role::Handle(_) => Guide::Free,
            };
            if guide == Guide::Free {
                weight += problem.stiffness[vertex as usize] - least[vertex as usize];
            } else if !guides.contains(&guide) {
                guides.push(guide);
            }
            for other in triangulation.neighbours(SurfaceVertex(vertex)) {
                if is_stiff(other.index()) && !std::mem::replace(&mut is_seen[other.index()], true) {
                    part.push(other.0);
                }
            }
        }
        part.sort_unstable();
        if guides.len() < 2 && weight > 0.0 {
            parts.push((weight, part, guides.first().copied().unwrap_or(Guide::Free)));
        }
    }
    parts.sort_by(|a, b| b.0.total_cmp(&a.0));
    parts.truncate(MOST);
    parts.into_iter().map(|(_, part, guide)| (part, guide)).collect()
}

/// Springs from a part's moving vertices to the part: their places in a field and the part's coordinates there.
pub(crate) fn hang(
    operator: &mut BilaplacianOperator,
    problem: &BoundaryProblem,
    part: &Handle,
    wave_number: f64,
    excess: &impl Fn(u32) -> f64,
) -> Prescribed {
    let (mut locals, mut strengths, mut coordinates) = (Vec::new(), Vec::new(), Vec::new());
    for &vertex in &part.vertices {
        let moves = match problem.roles[vertex as usize] {
            Role::Free => true,
            Role::Fixed => false,
            Role::Handle(handle) => problem.constraints.weight(handle).is_some(),
        };
        let Some(local) = operator.laplacian.local(vertex).filter(|_| moves) else {
            continue;
        };
        let inverse_area = operator.laplacian.inverse_areas()[local];
        if inverse_area > 0.0 {
            locals.push(local as u32);
            strengths.push(operator.bending * excess(vertex) * wave_number.powi(4) / inverse_area);
            coordinates.push(part.coordinates(problem.surface.positions[vertex as usize]));
        }
    }
    operator
        .hang(&locals, &strengths)
        .into_iter()
        .zip(coordinates)
        .collect()
}
