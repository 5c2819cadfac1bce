//! Parts too far away for a method of space to bend with the space: the specks of a scan.
//!
//! If everything may bend, a speck would stretch the box, the grid or the nodes of such a method, and its field is
//! useless far from everything held. So a speck follows the nearest surface, like loose parts in methods of the
//! surface.

use pliant_mesh::{Bounds, SurfaceVertex};

use crate::region::boundary_problem::BoundaryProblem;

/// The largest size of a speck, as a share of the diagonal of the parts that handles move and hold.
const MOST: f64 = 0.5;

/// The components, ascending, without a handle or a fixed vertex, whose distance from those with one exceeds the size
/// of those. Bare points are not included: they may be a cloud.
pub(super) fn strays(problem: &BoundaryProblem, driven: &[bool], held: &[bool]) -> Vec<u32> {
    let components = problem.topology.components();
    let has_faces = |component: usize| components[component].face_count > 0;
    let is_loose = |component: usize| !driven[component] && !held[component] && has_faces(component);
    if !(0..components.len()).any(is_loose) {
        return Vec::new();
    }
    let positions = &problem.surface.positions;
    let bounds = |component: usize| {
        let vertices = problem.topology.vertices_of(component as u32);
        Bounds::around(vertices.map(|SurfaceVertex(vertex)| positions[vertex as usize]))
    };
    let in_hand = (0..components.len()).filter(|&component| driven[component] || held[component]);
    let Some(in_hand) = in_hand.filter_map(bounds).reduce(|a, b| a.union(&b)) else {
        return Vec::new();
    };
    let size = in_hand.diagonal();
    let around = in_hand.grown(size);
    let is_stray = |&component: &usize| {
        let own = bounds(component).filter(|_| is_loose(component));
        own.is_some_and(|own| !own.meets(&around) && own.diagonal() <= MOST * size)
    };
    let strays = (0..components.len()).filter(is_stray);
    strays.map(|component| component as u32).collect()
}
