//! The tips: parts that the reach cuts off from the body that stays.
//!
//! A reach around a finger's middle, an upper arm or a face leaves pieces of the surface beyond it that are connected
//! only to the free region: fingertips, hands, ears. If they were fixed in the air they would smear everything around
//! them, so they move too, as in topological masking: all of a limb beyond the cut. They are free without a constraint
//! of their own, so they keep their shape as well as the method allows.

use pliant_deform::Role;
use pliant_mesh::{Surface, SurfaceVertex, Topology, face_area};

/// An island is free if its area is less than this share of the largest one's.
///
/// If a cut divides the surface into halves, neither is clearly the body, and both stay. Measured against the largest
/// island, ear tips, hands, lower legs, tails and a head on its neck have 0.001 to 0.12 of its area, a whole leg of a
/// figure that is cut at its waist 0.30, and the shorter end of a bar that is cut at 40% of its length 0.36; the other
/// half of a bar or of an animal that is cut in its middle has 0.82 to 0.99.
const LARGEST_SHARE: f64 = 0.5;

/// A connected fixed part, beyond every reach.
#[derive(Clone, Copy, Debug)]
struct Island {
    component: u32,
    area: f64,
    is_tied: bool,
}

/// Sets free the islands of fixed vertices that are small compared with the largest one of their component.
///
/// An island stays if it `is_painted` or locked anywhere or borders on a handle itself: a person has decided about it.
/// In each component the largest island stays; among equal ones, the one with the lowest vertex. Components without a
/// free vertex do not change.
pub(super) fn free_tips(
    roles: &mut [Role],
    surface: &Surface,
    topology: &Topology,
    is_painted: impl Fn(SurfaceVertex) -> bool,
) {
    let (islands, of_vertex) = islands(roles, surface, topology, is_painted);
    let mut largest: Vec<f64> = vec![0.0; topology.components().len()];
    for island in &islands {
        let largest = &mut largest[island.component as usize];
        *largest = largest.max(island.area);
    }
    let comes_along =
        |island: &Island| !island.is_tied && island.area < LARGEST_SHARE * largest[island.component as usize];
    let comes_along: Vec<bool> = islands.iter().map(comes_along).collect();
    for (role, island) in roles.iter_mut().zip(&of_vertex) {
        if comes_along.get(*island as usize) == Some(&true) {
            *role = Role::Free;
        }
    }
}

/// In no island.
const NONE: u32 = u32::MAX;

/// The islands by their lowest vertex, and the number of each vertex's, or [`NONE`].
fn islands(
    roles: &[Role],
    surface: &Surface,
    topology: &Topology,
    is_painted: impl Fn(SurfaceVertex) -> bool,
) -> (Vec<Island>, Vec<u32>) {
    let mut cut = vec![false; topology.components().len()];
    for (vertex, role) in (0..).map(SurfaceVertex).zip(roles) {
        cut[topology.component(vertex) as usize] |= *role == Role::Free;
    }
    let mut of_vertex = vec![NONE; roles.len()];
    let (mut islands, mut front) = (Vec::<Island>::new(), Vec::new());
    for first in (0..roles.len() as u32).map(SurfaceVertex) {
        let component = topology.component(first);
        if roles[first.index()] != Role::Fixed || of_vertex[first.index()] != NONE || !cut[component as usize] {
            continue;
        }
        let number = islands.len() as u32;
        let mut is_tied = false;
        of_vertex[first.index()] = number;
        front.push(first);
        while let Some(vertex) = front.pop() {
            is_tied |= is_painted(vertex);
            for &beside in topology.neighbours(vertex) {
                match roles[beside.index()] {
                    Role::Fixed if of_vertex[beside.index()] == NONE => {
                        of_vertex[beside.index()] = number;
                        front.push(beside);
                    }
                    Role::Handle(_) => is_tied = true,
                    _ => {}
                }
            }
        }
        islands.push(Island {
            component,
            area: 0.0,
            is_tied,
        });
    }
    // A single island is the largest, for any area.
    let triangles = if islands.len() > 1 { &surface.triangles[..] } else { &[] };
    for corners in triangles {
        let share = face_area(corners.map(|corner| surface.positions[corner.index()])) / 3.0;
        for corner in corners {
            if let Some(island) = islands.get_mut(of_vertex[corner.index()] as usize) {
                island.area += share;
            }
        }
    }
    (islands, of_vertex)
}
