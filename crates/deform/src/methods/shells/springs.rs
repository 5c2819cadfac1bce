//! The springs of soft handles, by the sheet's resistance.

use super::Shells;
use super::elements::Elements;
use crate::descent::springs::Springs;
use crate::handles::Handle;
use crate::methods::primo::edges::area;
use crate::region::boundary_problem::BoundaryProblem;
use crate::region::partition::Partition;

/// The springs of soft handles: each resists like a sheet of the material, q A_i (k_s + k_b D² q) for the handle's
/// square wave number q.
pub(super) fn springs(
    problem: &BoundaryProblem,
    options: &Shells,
    partition: &Partition,
    handles: &[Handle],
    elements: &Elements,
) -> Springs<f64> {
    let surface = problem.surface;
    let mut areas = vec![0.0; surface.positions.len()];
    if partition.soft.iter().any(Option::is_some) {
        for (face, corners) in (0..).zip(&surface.triangles) {
            let share = area(surface, face) / 3.0;
            corners.iter().for_each(|corner| areas[corner.index()] += share);
        }
    }
    let size = problem.size();
    let local_of = elements.local_of(surface.positions.len());
    let is_solved = |local: &u32| (*local as usize) < elements.solved_count;
    Springs::of(
        (handles, &partition.soft),
        &surface.positions,
        |vertex| Some(areas[vertex as usize]),
        |square_wave_number| {
            let bending = options.bending * size * size * square_wave_number;
            square_wave_number * (options.stretching + bending)
        },
        |vertex| Some(local_of[vertex as usize]).filter(is_solved),
        1.0,
    )
}
