//! Which vertices shape the space: those that triangles use. Bare points beside triangles go along with it.

use crate::Problem;

/// Those of these vertices that triangles use, or all where triangles use none of them.
pub(crate) fn shaping(problem: &Problem, vertices: impl Iterator<Item = u32> + Clone) -> Vec<u32> {
    let first_bare = problem.topology.bare_points().start;
    let used: Vec<u32> = vertices
        .clone()
        .filter(|vertex| (*vertex as usize) < first_bare)
        .collect();
    if used.is_empty() { vertices.collect() } else { used }
}
