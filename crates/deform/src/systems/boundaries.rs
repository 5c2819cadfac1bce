//! The places of the bi-Laplacian's natural boundaries: see [`natural`](crate::systems::natural).

use pliant_mesh::SurfaceVertex;

use crate::operators::hessian::{RingHessian, RingKind};
use crate::operators::triangulation::Triangulation;
use crate::region::boundary_problem::BoundaryProblem;
use crate::region::partition::Partition;
use crate::systems::natural::NaturalTerm;
use crate::systems::operator::BilaplacianOperator;

/// Adds natural boundaries to the operator of order 2 at the surface's free borders and changes of stiffness.
pub(crate) fn make_natural(
    operator: &mut BilaplacianOperator,
    triangulation: &Triangulation,
    problem: &BoundaryProblem,
    partition: &Partition,
) {
    let laplacian = &operator.laplacian;
    let count = laplacian.vertices().len();
    let full = || (0..count).filter(|&local| laplacian.is_full(local));
    let stiffness = |local: usize| operator.cell_stiffness(local);
    let mut is_solved = vec![false; triangulation.vertex_count()];
    partition
        .solved
        .iter()
        .for_each(|&vertex| is_solved[vertex as usize] = true);
    let component = |local: usize| problem.topology.component(SurfaceVertex(laplacian.vertices()[local]));
    let mut of_component = vec![Extent::default(); problem.topology.components().len()];
    for local in full() {
        of_component[component(local) as usize].take(stiffness(local));
    }
    for vertex in problem.topology.boundary_edge_list().as_flattened() {
        if is_solved[vertex.index()] {
            of_component[problem.topology.component(*vertex) as usize].has_free_border = true;
        }
    }
    if of_component.iter().any(|extent| extent.has_free_border) {
        // The Hessian does not see linear functions: a held triangle determines which one it is.
        let mut is_held = vec![false; of_component.len()];
        for corners in &problem.surface.triangles {
            if !corners.iter().any(|corner| is_solved[corner.index()]) {
                is_held[problem.topology.component(corners[0]) as usize] = true;
            }
        }
        for (extent, is_held) in of_component.iter_mut().zip(is_held) {
            extent.has_free_border &= is_held && extent.most > extent.least;
        }
    }
    if !of_component.iter().any(Extent::is_natural) {
        return;
    }
    let hessian = RingHessian::of(triangulation, laplacian);
    let is_free = |local: u32| is_solved[laplacian.vertices()[local as usize] as usize];
    let is_known = |local: usize| {
        let is_hub = laplacian.neighbours(local).len() > operator.hub_degree;
        !is_hub && hessian.kinds()[local] != RingKind::Unknown
    };
    let (mut cells, mut weights) = (vec![0.0; count], vec![0.0; count]);
    for local in 0..count {
        let (extent, own) = (of_component[component(local) as usize], stiffness(local));
        let least = if extent.has_free_border { 0.0 } else { extent.least };
        // Beside hubs and edges with more than two triangles the Laplacian alone holds the surface.
        let mut around = laplacian.neighbours(local).iter();
        let is_regular =
            is_known(local) && around.all(|&other| is_known(other as usize) || !laplacian.is_full(other as usize));
        let kind = if is_regular {
            hessian.kinds()[local]
        } else {
            RingKind::Unknown
        };
        (cells[local], weights[local]) = match kind {
            RingKind::Closed if extent.is_natural() => (0.5 * (own + least), own - least),
            // A border held together with its neighbours clamps the surface by its Laplacian.
            RingKind::Fan(ends) if extent.has_free_border && ends.into_iter().any(is_free) => (0.0, own),
            RingKind::Fan(_) if extent.has_free_border && is_free(local as u32) => (0.0, own),
            _ => (own, 0.0),
        };
    }
    operator.cell_stiffness = cells;
    operator.natural = Some(NaturalTerm {
        hessian,
        weights: weights
            .into_iter()
            .map(|share| 2.0 * operator.bending * share)
            .collect(),
    });
}

/// The properties of a component.
#[derive(Clone, Copy, Default)]
struct Extent {
    least: f64,
    most: f64,
    has_free_border: bool,
}

impl Extent {
    fn take(&mut self, stiffness: f64) {
        self.least = if self.most == 0.0 {
            stiffness
        } else {
            self.least.min(stiffness)
        };
        self.most = self.most.max(stiffness);
    }

    fn is_natural(&self) -> bool {
        self.has_free_border || self.most > self.least
    }
}
