//! The vertices that shape the space: those of triangles. Bare points beside triangles follow.

use crate::region::boundary_problem::BoundaryProblem;

/// The vertices in these that triangles use, or all if triangles use none of them.
pub(crate) fn shaping(problem: &BoundaryProblem, vertices: impl Iterator<Item = u32> + Clone) -> Vec<u32> {
    let first_bare = problem.topology.bare_points().start;
    let used: Vec<u32> = vertices
        .clone()
        .filter(|vertex| (*vertex as usize) < first_bare)
        .collect();
    if used.is_empty() { vertices.collect() } else { used }
}
