//! Limbs: connected parts of a surface that bend, and the ends that bound them.

use pliant_mesh::SurfaceVertex;

use crate::Role;
use crate::handles::turns::{Ends, ends_among};
use crate::region::boundary_problem::BoundaryProblem;

/// The ends with a limb between them, each pair once, ascending. A hand that rides on a forearm
/// has a limb with it, and none with the shoulder.
pub(crate) fn ends_of_limbs(problem: &BoundaryProblem) -> Vec<Ends> {
    let mut ends = Vec::new();
    let mut is_seen = vec![false; problem.roles.len()];
    for (first, role) in problem.roles.iter().enumerate() {
        if *role != Role::Free || is_seen[first] {
            continue;
        }
        is_seen[first] = true;
        let (mut queue, mut handles, mut is_held) = (vec![first], Vec::new(), false);
        while let Some(vertex) = queue.pop() {
            for next in problem.topology.neighbours(SurfaceVertex(vertex as u32)) {
                let next = next.index();
                match problem.roles[next] {
                    Role::Fixed => is_held = true,
                    Role::Handle(handle) if !handles.contains(&handle) => handles.push(handle),
                    Role::Handle(_) => {}
                    Role::Free if std::mem::replace(&mut is_seen[next], true) => {}
                    Role::Free => queue.push(next),
                }
            }
        }
        handles.sort_unstable();
        ends.extend(ends_among(&handles, is_held));
    }
    ends.sort_unstable();
    ends.dedup();
    ends
}
