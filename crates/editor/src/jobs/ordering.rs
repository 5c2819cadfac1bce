//! The ordering of the mesh's equations: of all of it, or, of a very large one, of what the region frees.
//!
//! Ordering all of a mesh takes as long as factoring all of it, and serves every region. On a scan of many millions of
//! vertices, of which a few hundred thousand bend, the first shape would wait for it half a minute. So such a mesh is
//! ordered where it bends, with a margin within which strokes need no other ordering.

use std::sync::Arc;

use pliant_deform::{Ordering, Role};
use pliant_mesh::{Model, SurfaceVertex, Topology};

use super::slot::Work;
use crate::region::Region;

/// The vertices of an ordering by region, in those that the region does not hold.
const MARGIN: f64 = 1.5;

/// Makes the ordering for a power of the Laplacian; by region from `large` vertices on.
pub(super) fn order_work(model: &Arc<Model>, region: &Region, large: usize, power: u32) -> Option<Work<Arc<Ordering>>> {
    let (model, roles) = (Arc::clone(model), Arc::clone(&region.roles));
    Some(Box::new(move |progress, cancel| {
        let topology = &model.topology;
        let part = (roles.len() >= large).then(|| part(topology, &roles)).flatten();
        Ok(Arc::new(match part {
            Some(part) => Ordering::around(topology, &part, power, progress, cancel)?,
            None => Ordering::of(topology, power, progress, cancel)?,
        }))
    }))
}

/// Whether an ordering serves a region.
pub(super) fn serves(ordering: &Ordering, region: &Region) -> bool {
    let is_covered =
        |(vertex, role): (usize, &Role)| *role == Role::Fixed || ordering.covers(SurfaceVertex(vertex as u32));
    ordering.is_whole()
        || (ordering.vertex_count() == region.roles.len() && region.roles.iter().enumerate().all(is_covered))
}

/// The vertices that are not held, and a margin around them; `None` if that is most of the mesh.
fn part(topology: &Topology, roles: &[Role]) -> Option<Vec<bool>> {
    let mut is_near: Vec<bool> = roles.iter().map(|role| *role != Role::Fixed).collect();
    let mut near: Vec<u32> = (0..roles.len() as u32).filter(|&v| is_near[v as usize]).collect();
    let most = (near.len() as f64 * MARGIN) as usize;
    if 2 * most >= roles.len() {
        return None;
    }
    let mut next = 0;
    while near.len() < most
        && let Some(&vertex) = near.get(next)
    {
        next += 1;
        for neighbour in topology.neighbours(SurfaceVertex(vertex)) {
            if !std::mem::replace(&mut is_near[neighbour.index()], true) {
                near.push(neighbour.0);
            }
        }
    }
    Some(is_near)
}
