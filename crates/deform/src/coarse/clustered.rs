//! A coarse level's problem: the same constraints on clusters of vertices, and the shares of its cells at fine
//! vertices.

use pliant_mesh::SurfaceVertex;

use crate::coarse::clusters::Clusters;
use crate::handles::Handle;
use crate::region::boundary_problem::BoundaryProblem;
use crate::region::partition::Partition;
use crate::{Constraints, Examples, Loose, Method};

/// The number of coarse cells with which a fine cell turns.
const NEAREST: usize = 4;

/// A coarse cell, and its share in a fine cell's turn.
pub(crate) type Share = (u32, f32);

/// The shares of one fine cell, the largest first; they sum to 1, or are 0 if no coarse cell is near.
pub(crate) type Shares = [Share; NEAREST];

/// Binds `method` with `bind` to the problem on the clusters. Handles keep the fine ones' frames, so that the same
/// motions apply.
pub(crate) fn on_clusters<T>(
    problem: &BoundaryProblem,
    clusters: &Clusters,
    method: &Method,
    examples: Option<&Examples>,
    handles: &[Handle],
    bind: impl FnOnce(&BoundaryProblem, Partition, &[Handle]) -> Option<T>,
) -> Option<T> {
    let coarse = BoundaryProblem {
        handle_count: problem.handle_count,
        constraints: Constraints {
            soft: problem.constraints.soft,
            ..Constraints::default()
        },
        loose: Loose::Rest,
        examples,
        ..BoundaryProblem::new(
            (&clusters.surface, &clusters.topology),
            &clusters.roles,
            &clusters.stiffness,
        )
    };
    let partition = method.partition(&coarse).ok()?;
    let handles: Vec<Handle> = handles
        .iter()
        .zip(&partition.handles)
        .map(|(handle, vertices)| Handle {
            vertices: vertices.clone(),
            ..*handle
        })
        .collect();
    bind(&coarse, partition, &handles)
}

/// For a surface vertex, the nearest coarse cells of its cluster's ring, with shares that fall to 0 towards the next
/// one; `cell` gives a cluster's cell, if it has one.
pub(crate) fn shares(
    problem: &BoundaryProblem,
    clusters: &Clusters,
    cell: &impl Fn(u32) -> Option<u32>,
    vertex: u32,
) -> Shares {
    let here = problem.surface.positions[vertex as usize];
    let own = clusters.cluster_of[vertex as usize];
    let around = clusters.topology.neighbours(SurfaceVertex(own));
    let mut near: Vec<(f64, u32)> = std::iter::once(own)
        .chain(around.iter().map(|other| other.0))
        .filter_map(|cluster| {
            let place = clusters.surface.positions[cluster as usize];
            Some((place.distance(here), cell(cluster)?))
        })
        .collect();
    near.sort_by(|a, b| a.0.total_cmp(&b.0));
    let farthest = near.last().map_or(0.0, |&(distance, _)| 1.5 * distance);
    let limit = near.get(NEAREST).map_or(farthest, |&(distance, _)| distance);
    let mut shares = [(0, 0.0); NEAREST];
    for (share, &(distance, cell)) in shares.iter_mut().zip(&near) {
        // The nearest one always has a share.
        *share = (cell, (1.0 - distance / limit).max(0.0).powi(2).max(1e-6) as f32);
    }
    let sum: f32 = shares.iter().map(|share| share.1).sum();
    for share in shares.iter_mut().filter(|share| share.1 > 0.0) {
        share.1 /= sum;
    }
    shares
}

/// The shares by coarse vertex, of those below `solved_count`.
pub(crate) fn transposed(shares: &[Shares], solved_count: usize) -> (Vec<u32>, Vec<Share>) {
    let of_vertex = |(vertex, shares): (usize, &Shares)| shares.map(|(cell, share)| (cell, vertex as u32, share));
    let is_solved = |&(cell, _, share): &(u32, u32, f32)| share > 0.0 && (cell as usize) < solved_count;
    let each = || shares.iter().enumerate().flat_map(of_vertex).filter(is_solved);
    let mut offsets = vec![0; solved_count + 1];
    for (cell, ..) in each() {
        offsets[cell as usize + 1] += 1;
    }
    for cell in 0..solved_count {
        offsets[cell + 1] += offsets[cell];
    }
    let mut next = offsets.clone();
    let mut members = vec![(0, 0.0); offsets[solved_count] as usize];
    for (cell, vertex, share) in each() {
        let place = &mut next[cell as usize];
        members[*place as usize] = (vertex, share);
        *place += 1;
    }
    (offsets, members)
}
