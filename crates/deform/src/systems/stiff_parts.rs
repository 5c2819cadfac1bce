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

/// A level of stiffness above which connected vertices are parts.
///
/// There are two of them: parts above 1, and parts of ordinary stiffness that soft ones separate. Without the second, a
/// soft band took none of a bend: the rest sheared instead. A part of the first kind may be inside one of the second, and
/// adds its own excess to that.
pub(crate) struct Level {
    /// s₁ of each surface vertex.
    least: Vec<f64>,
    /// Stiffness above this belongs to the next level.
    most: f64,
}

impl Level {
    /// The level of parts above 1.
    pub fn stiff(operator: &BilaplacianOperator, problem: &BoundaryProblem) -> Self {
        let least = least_stiffness(operator, problem);
        Self {
            least: least.into_iter().map(|least| least.max(1.0)).collect(),
            most: f64::INFINITY,
        }
    }

    /// Both levels, or that of parts above 1 if nothing is soft.
    pub fn all(operator: &BilaplacianOperator, problem: &BoundaryProblem) -> Vec<Self> {
        let least = least_stiffness(operator, problem);
        let ordinary = least.iter().any(|least| *least < 1.0).then(|| Self {
            least: least.into_iter().map(|least| least.min(1.0)).collect(),
            most: 1.0,
        });
        ordinary.into_iter().chain([Self::stiff(operator, problem)]).collect()
    }

    /// The stiffness of a vertex above the level's least; not above its most.
    pub fn excess(&self, problem: &BoundaryProblem, vertex: u32) -> f64 {
        (self.stiffness(problem, vertex) - self.least[vertex as usize]).max(0.0)
    }

    /// The excess as a share of the vertex' stiffness up to the level's most.
    pub fn share(&self, problem: &BoundaryProblem, vertex: u32) -> f64 {
        self.excess(problem, vertex) / self.stiffness(problem, vertex)
    }

    fn stiffness(&self, problem: &BoundaryProblem, vertex: u32) -> f64 {
        problem.stiffness[vertex as usize].min(self.most)
    }
}

/// The least stiffness of each surface vertex' component; infinite where nothing bends.
fn least_stiffness(operator: &BilaplacianOperator, problem: &BoundaryProblem) -> Vec<f64> {
    let laplacian = &operator.laplacian;
    let mut of_component = vec![f64::INFINITY; problem.topology.components().len()];
    let component = |vertex: u32| problem.topology.component(SurfaceVertex(vertex)) as usize;
    for (local, &vertex) in laplacian.vertices().iter().enumerate() {
        if laplacian.is_full(local) {
            let least = &mut of_component[component(vertex)];
            *least = least.min(problem.stiffness[vertex as usize]);
        }
    }
    (0..problem.stiffness.len() as u32)
        .map(|vertex| of_component[component(vertex)])
        .collect()
}

/// The parts of a level that reach the bending part, the heaviest first, and their guides; parts between several guides
/// are left out.
pub(crate) fn stiff_components(
    operator: &BilaplacianOperator,
    triangulation: &Triangulation,
    problem: &BoundaryProblem,
    level: &Level,
) -> Vec<(Vec<u32>, Guide)> {
    let excess = |vertex: u32| level.excess(problem, vertex);
    let mut is_seen = vec![false; problem.stiffness.len()];
    let mut parts: Vec<(f64, Vec<u32>, Guide)> = Vec::new();
    for &first in operator.laplacian.vertices() {
        if is_seen[first as usize] || excess(first) <= 0.0 {
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
                weight += excess(vertex);
            } else if !guides.contains(&guide) {
                guides.push(guide);
            }
            for other in triangulation.neighbours(SurfaceVertex(vertex)) {
                if excess(other.0) > 0.0 && !std::mem::replace(&mut is_seen[other.index()], true) {
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
