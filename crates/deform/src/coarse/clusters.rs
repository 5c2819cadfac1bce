//! A coarser surface with one vertex for each cluster of neighbours.
//!
//! Centres are vertices, chosen in the order of their numbers wherever no other centre is near. A cluster consists of
//! the vertices that are nearest to its centre along the surface and have its role, so it is constrained as a whole or
//! not at all. Triangles are the faces whose corners lie in three clusters. The coarse surface may have several parts,
//! borders or non-manifold edges wherever the fine one has them; the method takes such surfaces.

use pliant_mesh::{DistanceSearch, Surface, SurfaceVertex, Topology};

use crate::Role;
use crate::coarse::domain::{ABSENT, Domain};
use crate::handles::Handle;
use crate::region::boundary_problem::BoundaryProblem;

/// The number of centres at a distance of 1 from each other per unit of area: 0.81 was found on scans.
const DENSITY: f64 = 0.81;

/// A coarse surface, and the cluster behind each of its vertices.
pub(crate) struct Clusters {
    pub surface: Surface,
    pub topology: Topology,
    /// The surface vertex at each coarse vertex.
    pub centres: Vec<u32>,
    pub roles: Vec<Role>,
    /// The mean of each cluster's stiffness.
    pub stiffness: Vec<f64>,
    /// The cluster of each surface vertex, [`ABSENT`] outside of the domain.
    pub cluster_of: Vec<u32>,
}

impl Clusters {
    /// Clusters of about `size` vertices of `domain`, and at least one of each handle.
    pub fn of(problem: &BoundaryProblem, domain: &Domain, handles: &[Handle], size: f64) -> Self {
        let BoundaryProblem { surface, roles, .. } = *problem;
        let mut is_wanted: Vec<bool> = domain.local_of.iter().map(|&local| local != ABSENT).collect();
        for first in handles.iter().filter_map(|handle| handle.vertices.first()) {
            is_wanted[*first as usize] = true;
        }
        let corners = domain.faces.iter().map(|&face| surface.corners(face as usize));
        let double_area: f64 = corners.map(|[a, b, c]| (b - a).cross(c - a).length()).sum();
        let reach = (DENSITY * 0.5 * double_area * size / domain.vertices.len() as f64).sqrt();
        let mut cluster_of = vec![ABSENT; roles.len()];
        let mut distance = vec![f64::INFINITY; roles.len()];
        let position = |vertex: SurfaceVertex| surface.positions[vertex.index()];
        let mut search = DistanceSearch::default();
        let mut centres = Vec::new();
        for (vertex, role) in roles.iter().enumerate() {
            if !is_wanted[vertex] || cluster_of[vertex] != ABSENT {
                continue;
            }
            let seed = [(SurfaceVertex(vertex as u32), 0.0)];
            for &(reached, along) in search.within(&surface.triangles, problem.topology, position, &seed, reach) {
                let place = reached.index();
                if is_wanted[place] && roles[place] == *role && along < distance[place] {
                    (distance[place], cluster_of[place]) = (along, centres.len() as u32);
                }
            }
            centres.push(vertex as u32);
        }
        let surface = Surface {
            positions: centres.iter().map(|&v| surface.positions[v as usize]).collect(),
            triangles: triangles(surface, &cluster_of),
        };
        let mut stiffness = vec![(0.0, 0.0); centres.len()];
        for (&cluster, own) in cluster_of.iter().zip(problem.stiffness) {
            if let Some((sum, count)) = stiffness.get_mut(cluster as usize) {
                (*sum, *count) = (*sum + own, *count + 1.0);
            }
        }
        Self {
            topology: Topology::of(&surface),
            surface,
            roles: centres.iter().map(|&v| roles[v as usize]).collect(),
            stiffness: stiffness.iter().map(|(sum, count)| sum / count).collect(),
            centres,
            cluster_of,
        }
    }
}

/// The faces between three clusters, each set of three once.
fn triangles(surface: &Surface, cluster_of: &[u32]) -> Vec<[SurfaceVertex; 3]> {
    let between = |corners: &[SurfaceVertex; 3]| {
        let [a, b, c] = corners.map(|corner| cluster_of[corner.index()]);
        let differ = a != b && b != c && c != a && a.max(b).max(c) != ABSENT;
        // The corners from the lowest one on, turned the same way round.
        let from_lowest = match a.min(b).min(c) {
            lowest if lowest == a => [a, b, c],
            lowest if lowest == b => [b, c, a],
            _ => [c, a, b],
        };
        differ.then_some(from_lowest)
    };
    let mut found: Vec<[u32; 3]> = surface.triangles.iter().filter_map(between).collect();
    found.sort_unstable_by_key(|&[a, b, c]| (a, b.min(c), b.max(c), b));
    found.dedup_by_key(|&mut [a, b, c]| (a, b.min(c), b.max(c)));
    found.into_iter().map(|corners| corners.map(SurfaceVertex)).collect()
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "tests")]
mod tests {
    use pliant_mesh::shapes;

    use super::Clusters;
    use crate::Role;
    use crate::coarse::domain::{ABSENT, Domain};
    use crate::handles::Handle;
    use crate::region::boundary_problem::BoundaryProblem;

    #[test]
    fn clusters_keep_to_one_role_and_have_their_centre() {
        let drawn = [
            shapes::torus(40, 20),
            shapes::non_manifold_fan(9),
            shapes::broken(&shapes::icosphere(2)),
        ];
        for model in drawn.map(shapes::model) {
            let count = model.surface.positions.len() as u32;
            let role = |v: u32| match v % 7 {
                0 => Role::Fixed,
                1 => Role::Handle(0),
                _ => Role::Free,
            };
            let roles: Vec<Role> = (0..count).map(role).collect();
            let order: Vec<u32> = (0..count).filter(|&v| role(v) == Role::Free).collect();
            let handle = Handle::new((0..count).filter(|v| v % 7 == 1).collect(), &model.surface.positions);
            let stiffness = vec![1.0; roles.len()];
            let problem = BoundaryProblem::new((&model.surface, &model.topology), &roles, &stiffness);
            let domain = Domain::of(&model.surface, &model.topology, &order);
            let clusters = Clusters::of(&problem, &domain, &[handle], 6.0);
            assert!(clusters.centres.len() < roles.len());
            assert!(clusters.roles.contains(&Role::Handle(0)));
            for (vertex, &cluster) in clusters.cluster_of.iter().enumerate() {
                if domain.local_of[vertex] != ABSENT {
                    assert_eq!(clusters.roles[cluster as usize], roles[vertex]);
                }
            }
            for (cluster, &centre) in clusters.centres.iter().enumerate() {
                assert_eq!(clusters.cluster_of[centre as usize] as usize, cluster);
            }
            for [a, b, c] in &clusters.surface.triangles {
                assert!(a < b && a < c && b != c);
            }
        }
    }
}
